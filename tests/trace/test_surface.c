// Surfaces at ray hits: sides, masks, colours, normals, mirrored instances, self-intersection.
#include "trace/trace_fixture.h"

#include <math.h>

static vec3s grey(float v)
{
    return vec3_of(v, v, v);
}

static void add_wall(struct trace_fixture *s, float z, int material)
{
    fixture_quad(s, vec3_of(-1, -1, z), vec3_of(1, -1, z), vec3_of(1, 1, z), vec3_of(-1, 1, z),
                 material);
}

// Seen from behind.
static void add_back(struct trace_fixture *s, float z, int material)
{
    fixture_quad(s, vec3_of(1, -1, z), vec3_of(-1, -1, z), vec3_of(-1, 1, z), vec3_of(1, 1, z),
                 material);
}

static double mean_of(struct trace_fixture *s, enum reference_layer layer, int channel)
{
    return fixture_mean(s, layer).mean[channel];
}

TEST(camera_rays_pass_through_back_faces_of_single_sided_surfaces)
{
    struct trace_fixture s;
    fixture_init(&s);
    s.samples = 1;
    add_wall(&s, -3, fixture_diffuse(&s, vec3_of(0.2f, 0.4f, 0.6f), grey(0)));
    add_back(&s, -1, fixture_diffuse(&s, grey(1), grey(7)));
    add_back(&s, -2, fixture_diffuse(&s, grey(1), grey(7)));
    CHECK_NEAR(mean_of(&s, REFERENCE_DEPTH, 0), 3, 1e-5);
    CHECK_NEAR(mean_of(&s, REFERENCE_ALBEDO, 1), 0.4, 1e-6);
    CHECK_NEAR(mean_of(&s, REFERENCE_NORMAL, 2), 1, 1e-6);
    CHECK_NEAR(mean_of(&s, REFERENCE_POSITION, 2), -3, 1e-5);
    fixture_finish(&s);
}

TEST(double_sided_surfaces_flip_their_normal_and_emit_on_both_sides)
{
    struct trace_fixture s;
    fixture_init(&s);
    s.samples = 1;
    struct material m = material_default();
    m.double_sided = true;
    m.base_color = (vec4s){ { 0, 0, 0, 1 } };
    m.emissive = grey(7);
    add_wall(&s, -3, fixture_diffuse(&s, grey(1), grey(0)));
    add_back(&s, -1, fixture_material(&s, &m));
    CHECK_NEAR(mean_of(&s, REFERENCE_DEPTH, 0), 1, 1e-6);
    CHECK_NEAR(mean_of(&s, REFERENCE_NORMAL, 2), 1, 1e-6);
    CHECK_NEAR(mean_of(&s, REFERENCE_DIRECT, 0), 7, 1e-5);
    fixture_finish(&s);
}

TEST(masked_surfaces_transmit_light_where_they_are_cut_out_alone)
{
    struct trace_fixture s;
    fixture_init(&s);
    s.samples = 1;
    // The left half is opaque, the right half cut out.
    uint8_t texels[4 * 4] = { 255, 255, 255, 255, 255, 255, 255, 0,
                              255, 255, 255, 255, 255, 255, 255, 0 };
    struct scene_image image = { .name = "mask", .width = 2, .height = 2, .rgba = texels };
    struct material m = material_default();
    m.alpha_mode = ALPHA_MASK;
    m.base_color_map = (struct texture_use){ .image = scene_add_image(s.scene, &image),
                                             .uv_scale = { 1, 1 },
                                             .nearest = true };
    add_wall(&s, -1, fixture_material(&s, &m));
    add_wall(&s, -3, fixture_diffuse(&s, grey(1), grey(0)));
    fixture_light(&s, LIGHT_SUN, vec3_of(0, 0, 0), vec3_of(0, 0, -1), grey(3.14159265f));
    fixture_aim_camera(&s, vec3_of(0, 0, 0), vec3_of(0, 0, -1), 0.3f);
    struct image depth = fixture_layer(&s, REFERENCE_DEPTH);
    CHECK_NEAR(image_at(&depth, 2, 8)[0], 1, 1e-5);
    CHECK_NEAR(image_at(&depth, 13, 8)[0], 3, 1e-5);
    image_finish(&depth, test_host());
    // The back wall is lit only through the cut-out half.
    fixture_aim_camera(&s, vec3_of(0, 0, -2), vec3_of(0, 0, -3), 0.5f);
    struct image direct = fixture_layer(&s, REFERENCE_DIRECT);
    CHECK_NEAR(image_at(&direct, 2, 8)[1], 0, 0);
    CHECK_NEAR(image_at(&direct, 13, 8)[1], 1, 1e-5);
    image_finish(&direct, test_host());
    fixture_finish(&s);
}

// A quad with varying colours and normals, on its own node.
static void add_varied(struct trace_fixture *s, const struct node *node, int material)
{
    vec3s positions[4] = { vec3_of(-1, -1, 0), vec3_of(1, -1, 0), vec3_of(1, 1, 0),
                           vec3_of(-1, 1, 0) };
    float c = sqrtf(0.5f);
    vec3s normals[4] = { vec3_of(-c, 0, c), vec3_of(c, 0, c), vec3_of(c, 0, c), vec3_of(-c, 0, c) };
    vec4s colors[4] = {
        { { 1, 0, 0, 1 } }, { { 0, 1, 0, 1 } }, { { 0, 1, 0, 1 } }, { { 1, 0, 0, 1 } }
    };
    vec4s tangents[4];
    vec2s uv[4] = { { { 0, 1 } }, { { 1, 1 } }, { { 1, 0 } }, { { 0, 0 } } };
    for (int i = 0; i < 4; i++) tangents[i] = (vec4s){ { 1, 0, 0, 1 } };
    uint32_t indices[6] = { 0, 1, 2, 0, 2, 3 };
    int mesh = scene_add_mesh(s->scene, &(struct mesh){ .name = "varied",
                                                        .vertex_count = 4,
                                                        .index_count = 6,
                                                        .positions = positions,
                                                        .normals = normals,
                                                        .colors = colors,
                                                        .tangents = tangents,
                                                        .uv = { uv },
                                                        .indices = indices,
                                                        .material = material });
    int n = scene_add_node(s->scene, node);
    struct instance instance = { .node = n, .mesh = mesh, .skin = -1 };
    assert_true(mesh >= 0 && n >= 0 && scene_add_instance(s->scene, &instance) >= 0);
}

static struct node node_in_front(float scale_x)
{
    struct node node = node_default();
    node.translation = vec3_of(0, 0, -1);
    node.scale = vec3_of(scale_x, 1, 1);
    return node;
}

static struct trace_hit shoot(struct trace_fixture *s, float x)
{
    assert_true(pose_init(&s->pose, s->scene, -1, 0));
    struct trace_scene *scene = trace_scene_create(test_host(), &s->pose);
    assert_non_null(scene);
    struct trace_hit hit;
    CHECK(trace_closest(scene, vec3_of(x, 0.1f, 0), vec3_of(0, 0, -2), 10, &hit));
    CHECK(trace_occluded(scene, vec3_of(x, 0.1f, 0), vec3_of(0, 0, -2), 10));
    CHECK(!trace_occluded(scene, vec3_of(x, 0.1f, 0), vec3_of(0, 0, -2), 0.4f));
    trace_scene_destroy(scene);
    return hit;
}

TEST(colours_and_normals_are_interpolated)
{
    struct trace_fixture s;
    fixture_init(&s);
    struct node node = node_in_front(1);
    add_varied(&s, &node, fixture_diffuse(&s, grey(0.5f), grey(0)));
    struct trace_hit hit = shoot(&s, 0.5f);
    CHECK_NEAR(hit.distance, 0.5, 1e-6);
    CHECK(hit.front);
    CHECK_NEAR(hit.albedo.x, 0.5 * 0.25, 1e-5);
    CHECK_NEAR(hit.albedo.y, 0.5 * 0.75, 1e-5);
    // Between (−1, 0, 1) and (1, 0, 1), three quarters of the way: (½, 0, 1).
    CHECK_NEAR(hit.normal.x, 0.5 / sqrt(1.25), 1e-5);
    CHECK_NEAR(hit.normal.z, 1 / sqrt(1.25), 1e-5);
    fixture_finish(&s);
}

TEST(mirrored_instances_keep_their_front)
{
    struct trace_fixture s;
    fixture_init(&s);
    struct node node = node_in_front(-1);
    add_varied(&s, &node, fixture_diffuse(&s, grey(1), grey(0)));
    struct trace_hit hit = shoot(&s, 0.5f);
    CHECK(hit.front);
    CHECK_NEAR(hit.geometric.z, 1, 1e-6);
    CHECK_NEAR(hit.normal.x, 0.5 / sqrt(1.25), 1e-5);
    CHECK_NEAR(hit.albedo.x, 0.75, 1e-5);
    fixture_finish(&s);
}

TEST(normal_maps_tilt_along_the_tangent)
{
    struct trace_fixture s;
    fixture_init(&s);
    // Halfway between +x and +z in tangent space, constant.
    uint8_t texels[4] = { 218, 128, 218, 255 };
    struct scene_image image = { .name = "tilted", .width = 1, .height = 1, .rgba = texels };
    struct material m = material_default();
    m.normal_map =
        (struct texture_use){ .image = scene_add_image(s.scene, &image), .uv_scale = { 1, 1 } };
    int material = fixture_material(&s, &m);
    for (int mirrored = 0; mirrored < 2; mirrored++) {
        struct node node = node_in_front(mirrored ? -1 : 1);
        node.translation.x = mirrored ? 5 : 0;
        add_varied(&s, &node, material);
    }
    // In the middle the interpolated normal is +z.
    struct trace_hit plain = shoot(&s, 0.0f);
    CHECK_NEAR(plain.normal.x, sqrt(0.5), 0.15);
    CHECK(plain.normal.x > 0.5f);
    pose_finish(&s.pose);
    struct trace_hit turned = shoot(&s, 5.0f);
    CHECK_NEAR(turned.normal.x, -plain.normal.x, 1e-5);
    CHECK_NEAR(turned.normal.z, plain.normal.z, 1e-5);
    fixture_finish(&s);
}

TEST(unlit_materials_are_matte)
{
    struct trace_fixture s;
    fixture_init(&s);
    struct material m = material_default();
    m.unlit = true;
    m.metallic = 1;
    m.roughness = 0.1f;
    add_wall(&s, -1, fixture_material(&s, &m));
    struct trace_hit hit = shoot(&s, 0.3f);
    CHECK_NEAR(hit.metallic, 0, 0);
    CHECK_NEAR(hit.roughness, 1, 0);
    fixture_finish(&s);
}

// Far from the origin, self-intersection would darken the floor.
TEST(surfaces_far_from_the_origin_do_not_shadow_themselves)
{
    for (int i = 0; i < 2; i++) {
        struct trace_fixture s;
        fixture_init(&s);
        float at = i ? 1000.0f : 0.0f;
        s.samples = 4;
        fixture_quad(&s, vec3_of(at - 9, at, at + 9), vec3_of(at + 9, at, at + 9),
                     vec3_of(at + 9, at, at - 9), vec3_of(at - 9, at, at - 9),
                     fixture_diffuse(&s, grey(1), grey(0)));
        s.scene->environment.sky = grey(1);
        fixture_aim_camera(&s, vec3_of(at + 1, at + 0.3f, at), vec3_of(at, at, at), 1);
        struct image direct = fixture_layer(&s, REFERENCE_DIRECT);
        for (int p = 0; p < 16 * 16; p++) CHECK_NEAR(direct.pixels[3 * p], 1, 1e-4);
        image_finish(&direct, test_host());
        fixture_finish(&s);
    }
}
