// G-buffer layers against ray intersections and material values.
#include "frame/frame_fixture.h"

#include <math.h>
#include <stdlib.h>

static const vec3s UP = { { 0, 1, 0 } };

TEST_GPU(depth_and_position_equal_the_ray_intersection)
{
    struct frame_fixture s;
    fixture_init(&s, gpu);
    fixture_floor(&s, 50, fixture_matte(&s, vec3_of(0.5f, 0.5f, 0.5f)));
    fixture_look(&s, vec3_of(1, 2, 3), vec3_of(0.3f, 0, 0));
    s.width = 40, s.height = 24;
    fixture_open(&s);
    fixture_render(&s);
    float *depth = fixture_read(&s, READ_DEPTH), *position = fixture_read(&s, READ_POSITION);
    int seen = 0;
    for (uint32_t y = 0; y < 24; y++) {
        for (uint32_t x = 0; x < 40; x++) {
            vec3s p = fixture_ray_on_plane(&s, x, y, UP, 0);
            vec3s to = glms_vec3_sub(p, s.input.camera.eye);
            float along = glms_vec3_dot(to, s.input.camera.forward);
            bool hit = along > 0 && fabsf(p.x) < 49 && fabsf(p.z) < 49;
            size_t i = (size_t)y * 40 + x;
            if (!hit) continue;
            seen++;
            // Hardware snaps vertices to 1/256 of a pixel.
            CHECK_RELATIVE(depth[i], along, test_gpu_is_software(gpu) ? 1e-4 : 2e-4);
            for (size_t k = 0; k < 3; k++)
                CHECK_NEAR(position[3 * i + k], p.raw[k], 2e-4 * (double)along);
        }
    }
    CHECK(seen > 400);
    free(depth);
    free(position);
    fixture_finish(&s);
}

TEST_GPU(all_layers_of_the_background_are_zero)
{
    struct frame_fixture s;
    fixture_init(&s, gpu);
    fixture_open(&s);
    fixture_render(&s);
    static const enum frame_readback layers[] = { READ_DEPTH, READ_POSITION, READ_NORMAL,
                                                  READ_ALBEDO, READ_EMISSIVE };
    for (size_t i = 0; i < sizeof layers / sizeof *layers; i++) {
        vec3s v = fixture_pixel(&s, layers[i], 3, 4);
        CHECK(v.x == 0 && v.y == 0 && v.z == 0);
    }
    fixture_finish(&s);
}

TEST_GPU(normals_point_out_of_a_rotated_and_scaled_surface)
{
    struct frame_fixture s;
    fixture_init(&s, gpu);
    int instance = fixture_floor(&s, 1, fixture_matte(&s, vec3_of(1, 1, 1)));
    struct node node = node_default();
    node.scale = vec3_of(3, 1, 0.5f);
    node.rotation = glms_quatv(0.4f, vec3_of(0, 0, 1));
    fixture_instance(&s, s.scene->instances[instance].mesh, &node);
    s.scene->instance_count = 2;
    fixture_look(&s, vec3_of(-0.8f, 3, 0.01f), vec3_of(-0.8f, 0, 0));
    fixture_open(&s);
    fixture_render(&s);
    // The rotated floor is below the flat one left of the centre, above it on the right.
    vec3s n = fixture_pixel(&s, READ_NORMAL, 28, 15);
    CHECK_NEAR(n.x, -sin(0.4), 2e-3);
    CHECK_NEAR(n.y, cos(0.4), 2e-3);
    CHECK_NEAR(n.z, 0, 2e-3);
    fixture_finish(&s);
}

static int image_of(struct frame_fixture *s, int width, int height, uint8_t *rgba, bool has_alpha)
{
    int index = scene_add_image(s->scene, &(struct scene_image){ .name = "test",
                                                                 .width = width,
                                                                 .height = height,
                                                                 .rgba = rgba,
                                                                 .has_alpha = has_alpha });
    assert_true(index >= 0);
    return index;
}

static struct texture_use use_of(int image)
{
    struct texture_use use = texture_use_none();
    use.image = image;
    use.wrap_u = use.wrap_v = WRAP_CLAMP;
    use.nearest = true;
    return use;
}

// A wall in the plane z = −1 that fills the view; u to the right, v downwards, seen from the
// origin.
static void wall(struct frame_fixture *s, int material)
{
    fixture_quad(s, vec3_of(-1, -1, -1), vec3_of(1, -1, -1), vec3_of(1, 1, -1), vec3_of(-1, 1, -1),
                 material);
    fixture_look(s, vec3_of(0, 0, 0), vec3_of(0, 0, -1));
}

TEST_GPU(normal_map_red_is_along_u_and_green_against_v)
{
    // glTF: red is the tangent, +u; green is the bitangent, −v (up in the image).
    for (int axis = 0; axis < 2; axis++) {
        struct frame_fixture s;
        fixture_init(&s, gpu);
        uint8_t texel[4] = { axis == 0 ? 218 : 128, axis == 1 ? 218 : 128, 218, 255 };
        struct material m = material_default();
        m.normal_map = use_of(image_of(&s, 1, 1, texel, false));
        wall(&s, fixture_material(&s, &m));
        fixture_open(&s);
        fixture_render(&s);
        vec3s n = fixture_pixel(&s, READ_NORMAL, 16, 16);
        CHECK_NEAR(n.x, axis == 0 ? sqrt(0.5) : 0, 0.01);
        CHECK_NEAR(n.y, axis == 1 ? sqrt(0.5) : 0, 0.01);
        CHECK_NEAR(n.z, sqrt(0.5), 0.01);
        fixture_finish(&s);
    }
}

TEST_GPU(normal_map_of_a_mirrored_instance_is_mirrored_with_it)
{
    struct frame_fixture s;
    fixture_init(&s, gpu);
    uint8_t texel[4] = { 218, 218, 218, 255 };
    struct material m = material_default();
    m.normal_map = use_of(image_of(&s, 1, 1, texel, false));
    wall(&s, fixture_material(&s, &m));
    struct node mirror = node_default();
    mirror.scale = vec3_of(-1, 1, 1);
    mirror.translation = vec3_of(0, 0, 0.1f); // in front of the original
    fixture_instance(&s, 0, &mirror);
    fixture_open(&s);
    fixture_render(&s);
    vec3s n = fixture_pixel(&s, READ_NORMAL, 16, 16);
    CHECK_NEAR(fixture_pixel(&s, READ_DEPTH, 16, 16).x, 0.9, 1e-4);
    CHECK_NEAR(n.x, -sqrt(1.0 / 3), 0.01);
    CHECK_NEAR(n.y, sqrt(1.0 / 3), 0.01);
    CHECK_NEAR(n.z, sqrt(1.0 / 3), 0.01);
    fixture_finish(&s);
}

TEST_GPU(mirrored_instance_is_lit_on_its_front_side)
{
    struct frame_fixture s;
    fixture_init(&s, gpu);
    fixture_floor(&s, 2, fixture_matte(&s, vec3_of(0.5f, 0.5f, 0.5f)));
    struct node mirror = node_default();
    mirror.scale = vec3_of(-1, 1, 1);
    mirror.translation = vec3_of(0, 0.1f, 0);
    fixture_instance(&s, 0, &mirror);
    fixture_add_sun(&s, vec3_of(0, -1, 0), vec3_of(100, 100, 100));
    fixture_look(&s, vec3_of(0, 2, 0.01f), vec3_of(0, 0, 0));
    fixture_open(&s);
    fixture_render(&s);
    CHECK_NEAR(fixture_pixel(&s, READ_DEPTH, 16, 16).x, 1.9, 1e-3);
    CHECK(fixture_pixel(&s, READ_DIRECT, 16, 16).x > 10);
    fixture_finish(&s);
}

TEST_GPU(back_faces_are_visible_if_double_sided_and_face_the_camera)
{
    for (int double_sided = 0; double_sided < 2; double_sided++) {
        struct frame_fixture s;
        fixture_init(&s, gpu);
        struct material m = material_default();
        m.double_sided = double_sided == 1;
        fixture_floor(&s, 2, fixture_material(&s, &m));
        fixture_look(&s, vec3_of(0, -1, 0.01f), vec3_of(0, 0, 0)); // from below
        fixture_open(&s);
        fixture_render(&s);
        CHECK_NEAR(fixture_pixel(&s, READ_DEPTH, 16, 16).x, double_sided ? 1 : 0, 1e-3);
        CHECK_NEAR(fixture_pixel(&s, READ_NORMAL, 16, 16).y, double_sided ? -1 : 0, 1e-3);
        fixture_finish(&s);
    }
}

TEST_GPU(alpha_mask_cuts_a_hole)
{
    for (int mode = 0; mode < 3; mode++) { // opaque, mask at 0.8, blend
        struct frame_fixture s;
        fixture_init(&s, gpu);
        uint8_t rgba[16] = { 255, 0, 0, 255, 0, 255, 0, 180, 0, 0, 255, 100, 255, 255, 255, 255 };
        struct material m = material_default();
        m.base_color_map = use_of(image_of(&s, 2, 2, rgba, true));
        m.alpha_mode = (enum alpha_mode[]){ ALPHA_OPAQUE, ALPHA_MASK, ALPHA_BLEND }[mode];
        m.alpha_cutoff = 0.8f;
        wall(&s, fixture_material(&s, &m));
        fixture_open(&s);
        fixture_render(&s);
        // Alpha 255/255 is kept in all modes, 180/255 = 0.71 except with cutoff 0.8, 100/255 only
        // if opaque.
        CHECK_NEAR(fixture_pixel(&s, READ_ALBEDO, 8, 8).x, 1, 1e-3);
        CHECK_NEAR(fixture_pixel(&s, READ_ALBEDO, 24, 8).y, mode == 1 ? 0 : 1, 1e-3);
        CHECK_NEAR(fixture_pixel(&s, READ_ALBEDO, 8, 24).z, mode == 0 ? 1 : 0, 1e-3);
        CHECK(fixture_pixel(&s, READ_DEPTH, 8, 8).x > 0);
        CHECK((fixture_pixel(&s, READ_DEPTH, 8, 24).x > 0) == (mode == 0));
        fixture_finish(&s);
    }
}

TEST_GPU(texture_transform_and_wrap_choose_the_texel)
{
    struct frame_fixture s;
    fixture_init(&s, gpu);
    uint8_t rgba[16] = { 255, 0, 0, 255, 0, 255, 0, 255, 0, 0, 255, 255, 255, 255, 255, 255 };
    struct material m = material_default();
    m.base_color_map = use_of(image_of(&s, 2, 2, rgba, false));
    m.base_color_map.wrap_u = WRAP_REPEAT;
    m.base_color_map.uv_offset[0] = 1.5f; // shifts left by half the image, wraps once
    wall(&s, fixture_material(&s, &m));
    fixture_open(&s);
    fixture_render(&s);
    CHECK_NEAR(fixture_pixel(&s, READ_ALBEDO, 8, 8).y, 1, 1e-3); // green is now on the left
    CHECK_NEAR(fixture_pixel(&s, READ_ALBEDO, 8, 8).x, 0, 1e-3);
    CHECK_NEAR(fixture_pixel(&s, READ_ALBEDO, 24, 8).x, 1, 1e-3);
    fixture_finish(&s);
}

TEST_GPU(texture_rotation_is_counter_clockwise_in_the_image)
{
    struct frame_fixture s;
    fixture_init(&s, gpu);
    uint8_t rgba[16] = { 255, 0, 0, 255, 0, 255, 0, 255, 0, 0, 255, 255, 255, 255, 255, 255 };
    struct material m = material_default();
    m.base_color_map = use_of(image_of(&s, 2, 2, rgba, false));
    m.base_color_map.wrap_u = m.base_color_map.wrap_v = WRAP_REPEAT;
    m.base_color_map.uv_rotation_rad = 1.57079633f; // (u, v) → (v, −u)
    wall(&s, fixture_material(&s, &m));
    fixture_open(&s);
    fixture_render(&s);
    // Top left, uv = (¼, ¼) → (¼, −¼) = (¼, ¾): the blue texel.
    CHECK_NEAR(fixture_pixel(&s, READ_ALBEDO, 8, 8).z, 1, 1e-3);
    CHECK_NEAR(fixture_pixel(&s, READ_ALBEDO, 8, 8).x, 0, 1e-3);
    fixture_finish(&s);
}

// A wall like `wall`, of n × n quads.
static void tessellated_wall(struct frame_fixture *s, int n, int material)
{
    vec3s positions[17 * 17];
    vec2s uv[17 * 17];
    uint32_t indices[16 * 16 * 6], count = 0;
    for (int y = 0; y <= n; y++) {
        for (int x = 0; x <= n; x++) {
            float u = (float)x / (float)n, v = (float)y / (float)n;
            positions[y * (n + 1) + x] = vec3_of(2 * u - 1, 1 - 2 * v, -1);
            uv[y * (n + 1) + x] = (vec2s){ { u, v } };
            uint32_t a = (uint32_t)(y * (n + 1) + x), below = a + (uint32_t)n + 1;
            uint32_t quad[6] = { below, below + 1, a + 1, below, a + 1, a };
            for (int i = 0; i < 6 && x < n && y < n; i++) indices[count++] = quad[i];
        }
    }
    int mesh =
        scene_add_mesh(s->scene, &(struct mesh){ .name = "tiles",
                                                 .vertex_count = (uint32_t)((n + 1) * (n + 1)),
                                                 .index_count = count,
                                                 .positions = positions,
                                                 .uv = { uv },
                                                 .indices = indices,
                                                 .material = material });
    assert_true(mesh >= 0);
    fixture_instance(s, mesh, NULL);
}

TEST_GPU(textures_do_not_depend_on_the_tessellation)
{
    float *albedo[2];
    uint8_t rgba[64 * 64 * 4];
    for (int i = 0; i < 64 * 64; i++) {
        bool white = ((i ^ i >> 6) & 1) != 0;
        for (int k = 0; k < 4; k++) rgba[4 * i + k] = k == 3 || white ? 255 : 0;
    }
    for (int i = 0; i < 2; i++) {
        struct frame_fixture s;
        fixture_init(&s, gpu);
        s.width = s.height = 64;
        struct material m = material_default();
        m.base_color_map.image = image_of(&s, 64, 64, rgba, false);
        tessellated_wall(&s, i == 0 ? 1 : 16, fixture_material(&s, &m));
        fixture_open(&s);
        fixture_render(&s);
        albedo[i] = fixture_read(&s, READ_ALBEDO);
        fixture_finish(&s);
    }
    float most = 0;
    for (size_t i = 0; i < 64 * 64 * 3; i++) {
        CHECK_NEAR(albedo[0][i], albedo[1][i], 0.03);
        most = fmaxf(most, albedo[0][i]);
    }
    CHECK(most > 0.7f); // magnified: single texels are visible
    free(albedo[0]), free(albedo[1]);
}

TEST_GPU(morphed_vertices_and_their_motion_follow_the_pose)
{
    struct frame_fixture s;
    fixture_init(&s, gpu);
    s.indirect.needs = FRAME_NEEDS_MOTION;
    vec3s positions[3] = { vec3_of(-9, -9, -1), vec3_of(9, -9, -1), vec3_of(0, 9, -1) };
    vec3s back[3] = { vec3_of(0, 0, -2), vec3_of(0, 0, -2), vec3_of(0, 0, -2) };
    uint32_t indices[3] = { 0, 1, 2 };
    struct morph_target morph = { .positions = back };
    int mesh =
        scene_add_mesh(s.scene, &(struct mesh){ .name = "morphing",
                                                .vertex_count = 3,
                                                .index_count = 3,
                                                .positions = positions,
                                                .indices = indices,
                                                .morphs = &morph,
                                                .morph_count = 1,
                                                .material = fixture_matte(&s, vec3_of(1, 1, 1)) });
    float weight = 0.5f;
    struct node node = node_default();
    node.translation = vec3_of(0, 0, -1);
    struct instance instance = {
        .node = scene_add_node(s.scene, &node), .mesh = mesh, .skin = -1, .morph_weights = &weight
    };
    assert_true(scene_add_instance(s.scene, &instance) >= 0);
    fixture_open(&s);
    fixture_render(&s);
    CHECK_NEAR(fixture_pixel(&s, READ_DEPTH, 16, 16).x, 1 + 1 + 1, 1e-5);
    CHECK_NEAR(fixture_pixel(&s, READ_NORMAL, 16, 16).z, 1, 1e-3);
    // Motion includes deformation between two poses: 0.1 m to the right.
    for (int v = 0; v < 3; v++) s.pose.deformed[0].positions[v].x += 0.1f;
    fixture_render(&s);
    CHECK_NEAR(fixture_pixel(&s, READ_MOTION, 16, 16).x, 0.1 / (2 * tan(0.5) * 3), 1e-4);
    CHECK_NEAR(fixture_pixel(&s, READ_MOTION, 16, 16).y, 0, 1e-6);
    fixture_finish(&s);
}

TEST_GPU(factors_and_vertex_colors_multiply)
{
    struct frame_fixture s;
    fixture_init(&s, gpu);
    struct material m = material_default();
    m.base_color = (vec4s){ { 0.5f, 1, 1, 1 } };
    m.metallic = 0.6f;
    m.roughness = 0.4f;
    uint8_t data[4] = { 0, 128, 51, 255 }; // roughness ½, metallic 1/5
    m.metallic_roughness_map = use_of(image_of(&s, 1, 1, data, false));
    int material = fixture_material(&s, &m);
    vec3s positions[3] = { vec3_of(-4, -4, -1), vec3_of(4, -4, -1), vec3_of(0, 4, -1) };
    vec4s colors[3];
    for (int i = 0; i < 3; i++) colors[i] = (vec4s){ { 1, 0.5f, 0.25f, 1 } };
    uint32_t indices[3] = { 0, 1, 2 };
    vec2s uv[3] = { 0 };
    int mesh = scene_add_mesh(s.scene, &(struct mesh){ .name = "triangle",
                                                       .vertex_count = 3,
                                                       .index_count = 3,
                                                       .positions = positions,
                                                       .uv = { uv },
                                                       .colors = colors,
                                                       .indices = indices,
                                                       .material = material });
    fixture_instance(&s, mesh, NULL);
    fixture_open(&s);
    fixture_render(&s);
    vec3s albedo = fixture_pixel(&s, READ_ALBEDO, 16, 16);
    CHECK_NEAR(albedo.x, 0.5, 0.005);
    CHECK_NEAR(albedo.y, 0.5, 0.005);
    CHECK_NEAR(albedo.z, 0.25, 0.005);
    vec3s rm = fixture_pixel(&s, READ_ROUGHNESS_METALLIC, 16, 16);
    CHECK_NEAR(rm.x, 0.4 * 128 / 255, 0.005);
    CHECK_NEAR(rm.y, 0.6 * 51 / 255, 0.005);
    fixture_finish(&s);
}

TEST_GPU(unlit_materials_show_their_base_color_and_nothing_else)
{
    struct frame_fixture s;
    fixture_init(&s, gpu);
    struct material m = material_default();
    m.unlit = true;
    wall(&s, fixture_material(&s, &m));
    fixture_open(&s);
    fixture_render(&s);
    vec3s rm = fixture_pixel(&s, READ_ROUGHNESS_METALLIC, 16, 16);
    CHECK(rm.x == 1 && rm.y == 0);
    // Without light white is 1.2 cd/m².
    vec3s emitted = fixture_pixel(&s, READ_EMISSIVE, 16, 16);
    CHECK_RELATIVE(emitted.x, 1.2 * (double)m.base_color.x, 3e-3);
    CHECK_RELATIVE(fixture_pixel(&s, READ_COLOR, 16, 16).x, (double)emitted.x, 2e-3);
    fixture_finish(&s);
}

// Screen position (0…1) of a world point, and its distance along the view axis.
static vec3s screen_of(const struct world_camera *c, uint32_t width, uint32_t height, vec3s p)
{
    float tan_y = tanf(0.5f * c->vertical_fov_rad), tan_x = tan_y * (float)width / (float)height;
    vec3s to = glms_vec3_sub(p, c->eye), right = glms_vec3_cross(c->forward, c->up);
    float along = glms_vec3_dot(to, c->forward);
    return vec3_of(0.5f + 0.5f * glms_vec3_dot(to, right) / (along * tan_x),
                   0.5f - 0.5f * glms_vec3_dot(to, c->up) / (along * tan_y), along);
}

// Half floats have 11 bits: motion up to 0.4 is exact to 2e-4.
static void check_motion(struct frame_fixture *s, const struct world_camera *before, uint32_t x,
                         uint32_t y, vec3s now, vec3s then)
{
    vec3s from = screen_of(before, s->width, s->height, then);
    vec3s to = screen_of(&s->input.camera, s->width, s->height, now);
    vec3s motion = fixture_pixel(s, READ_MOTION, x, y);
    CHECK_NEAR(motion.x, ((float)x + 0.5f) / (float)s->width - from.x, 2e-4);
    CHECK_NEAR(motion.y, ((float)y + 0.5f) / (float)s->height - from.y, 2e-4);
    CHECK_NEAR(motion.z, from.z / to.z - 1, 2e-4);
}

TEST_GPU(motion_is_the_offset_from_the_previous_position)
{
    struct frame_fixture s;
    fixture_init(&s, gpu);
    fixture_floor(&s, 20, fixture_matte(&s, vec3_of(0.5f, 0.5f, 0.5f)));
    s.indirect.needs = FRAME_NEEDS_MOTION;
    s.width = 40, s.height = 24;
    fixture_look(&s, vec3_of(0, 2, 4), vec3_of(0, 0, 0));
    fixture_open(&s);
    fixture_render(&s);
    vec3s still = fixture_pixel(&s, READ_MOTION, 20, 15);
    CHECK(still.x == 0 && still.y == 0); // the first frame has no history
    struct world_camera before = s.input.camera;
    // The camera moves, and the floor shifts by half a metre at the same time.
    fixture_look(&s, vec3_of(0.2f, 2.1f, 3.9f), vec3_of(0.1f, 0, 0.1f));
    s.pose.world_from_node[s.scene->instances[0].node].raw[3][0] += 0.5f;
    fixture_render(&s);
    for (uint32_t y = 10; y < 24; y += 4) {
        vec3s now = fixture_ray_on_plane(&s, 7, y, UP, 0);
        check_motion(&s, &before, 7, y, now, glms_vec3_sub(now, vec3_of(0.5f, 0, 0)));
    }
    fixture_render(&s);
    vec3s after = fixture_pixel(&s, READ_MOTION, 20, 15);
    CHECK(after.x == 0 && after.y == 0 && after.z == 0);
    fixture_finish(&s);
}

// While the camera rotates, motion depends on the pixel's direction only, not on depth.
TEST_GPU(motion_of_a_rotating_camera_does_not_depend_on_depth)
{
    struct frame_fixture s;
    fixture_init(&s, gpu);
    const int white = fixture_matte(&s, vec3_of(1, 1, 1));
    fixture_box(&s, vec3_of(-3, -2, -5), vec3_of(4, 3, 6), true, white);
    fixture_box(&s, vec3_of(0, -2, -3), vec3_of(1, 0, -2), false, white);
    s.input.want_motion_layer = true; // no technique needs it here
    s.width = 48, s.height = 32;
    fixture_look(&s, vec3_of(0, 0, 0), vec3_of(0, 0, -1));
    fixture_open(&s);
    fixture_render(&s);
    for (int step = 1; step <= 3; step++) {
        struct world_camera before = s.input.camera;
        const float angle = 0.1f * (float)step;
        fixture_look(&s, vec3_of(0, 0, 0), vec3_of(sinf(angle), -0.05f, -cosf(angle)));
        fixture_render(&s);
        float *depth = fixture_read(&s, READ_DEPTH);
        for (uint32_t y = 0; y < 32; y += 5)
            for (uint32_t x = 0; x < 48; x += 5) {
                vec3s ray = fixture_ray_on_plane(&s, x, y, s.input.camera.forward, 1);
                check_motion(&s, &before, x, y, ray, ray);
                CHECK(depth[y * 48 + x] > 0.0f); // a surface at any distance
            }
        free(depth);
    }
    fixture_finish(&s);
}

// A plate moves 0.3 m nearer, 0.2 m right and 0.1 m up; the wall behind it is static.
TEST_GPU(motion_of_an_object_includes_depth)
{
    struct frame_fixture s;
    fixture_init(&s, gpu);
    const int white = fixture_matte(&s, vec3_of(1, 1, 1));
    fixture_quad(&s, vec3_of(-9, -9, -6), vec3_of(9, -9, -6), vec3_of(9, 9, -6), vec3_of(-9, 9, -6),
                 white);
    const int plate = fixture_quad(&s, vec3_of(-1, -1, -4), vec3_of(1, -1, -4), vec3_of(1, 1, -4),
                                   vec3_of(-1, 1, -4), white);
    const vec3s by = vec3_of(0.2f, 0.1f, 0.3f);
    s.input.want_motion_layer = true;
    fixture_open(&s);
    fixture_render(&s);
    mat4s *transform = &s.pose.world_from_node[s.scene->instances[plate].node];
    for (int k = 0; k < 3; k++) transform->raw[3][k] += by.raw[k];
    fixture_render(&s);
    const vec3s back = vec3_of(0, 0, 1);
    for (uint32_t i = 12; i < 20; i += 3) {
        vec3s now = fixture_ray_on_plane(&s, i, 31 - i, back, -3.7f);
        check_motion(&s, &s.input.camera, i, 31 - i, now, glms_vec3_sub(now, by));
    }
    vec3s behind = fixture_pixel(&s, READ_MOTION, 1, 1);
    CHECK(behind.x == 0 && behind.y == 0 && behind.z == 0);
    // A camera cut resets motion.
    for (int k = 0; k < 3; k++) transform->raw[3][k] += by.raw[k];
    s.input.camera_cut = true;
    fixture_look(&s, vec3_of(1, 0, 0), vec3_of(0, 0, -4));
    fixture_render(&s);
    vec3s cut = fixture_pixel(&s, READ_MOTION, 16, 16);
    CHECK(cut.x == 0 && cut.y == 0 && cut.z == 0);
    fixture_finish(&s);
}
