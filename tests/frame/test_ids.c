// The layer of instances and triangles against rays traced on the CPU, and picked pixels.
#include "frame/frame_fixture.h"

#include "scene/scene_edit.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// ---- Rays

struct id {
    int instance, triangle; // −1: no surface
};

struct ray_of_test {
    const struct frame_fixture *s;
    vec3s direction;
    double nearest;
    struct id id;
};

static const vec3s *world_positions(const struct frame_fixture *s, int instance, vec3s *room)
{
    const struct mesh *mesh = &s->scene->meshes[s->scene->instances[instance].mesh];
    if (s->pose.deformed[instance].positions) return s->pose.deformed[instance].positions;
    const mat4s m = pose_world_from_instance(&s->pose, instance);
    for (uint32_t v = 0; v < mesh->vertex_count; v++)
        room[v] = glms_mat4_mulv3(m, mesh->positions[v], 1.0f);
    return room;
}

// Alpha of a 2×2 nearest-neighbour map at a point of the triangle.
static bool is_solid(const struct scene *scene, const struct mesh *mesh, const uint32_t *corner,
                     double u, double v)
{
    const struct material *m = &scene->materials[mesh->material];
    if (m->alpha_mode == ALPHA_OPAQUE) return true;
    double at[2];
    for (int k = 0; k < 2; k++)
        at[k] = (1 - u - v) * (double)mesh->uv[0][corner[0]].raw[k] +
                u * (double)mesh->uv[0][corner[1]].raw[k] +
                v * (double)mesh->uv[0][corner[2]].raw[k];
    const int x = at[0] < 0.5 ? 0 : 1, y = at[1] < 0.5 ? 0 : 1;
    const uint8_t alpha = scene->images[m->base_color_map.image].rgba[4 * (2 * y + x) + 3];
    return alpha / 255.0 >= (double)m->alpha_cutoff;
}

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void cross(const double a[3], const double b[3], double out[3])
{
    for (int k = 0; k < 3; k++)
        out[k] = a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3];
}

// Möller and Trumbore 1997.
static void meet(struct ray_of_test *ray, int instance, const vec3s *p, uint32_t triangle)
{
    const struct scene *scene = ray->s->scene;
    const struct mesh *mesh = &scene->meshes[scene->instances[instance].mesh];
    const uint32_t *corner = &mesh->indices[(size_t)3 * triangle];
    double e1[3], e2[3], from[3], d[3], h[3], q[3];
    for (int k = 0; k < 3; k++) {
        e1[k] = (double)p[corner[1]].raw[k] - (double)p[corner[0]].raw[k];
        e2[k] = (double)p[corner[2]].raw[k] - (double)p[corner[0]].raw[k];
        from[k] = (double)ray->s->input.camera.eye.raw[k] - (double)p[corner[0]].raw[k];
        d[k] = (double)ray->direction.raw[k];
    }
    cross(d, e2, h);
    const double det = dot(e1, h); // > 0: counter-clockwise from the camera
    const bool front = (det > 0.0) != pose_is_mirrored(&ray->s->pose, instance);
    if (det == 0.0 || (!front && !scene->materials[mesh->material].double_sided)) return;
    cross(from, e1, q);
    const double u = dot(from, h) / det, v = dot(d, q) / det, t = dot(e2, q) / det;
    if (u < 0.0 || v < 0.0 || u + v > 1.0 || t <= 0.0 || t >= ray->nearest) return;
    if (!is_solid(scene, mesh, corner, u, v)) return;
    ray->nearest = t;
    ray->id = (struct id){ instance, (int)triangle };
}

static struct id traced(const struct frame_fixture *s, float x, float y)
{
    enum { MOST_VERTICES = 4096 };
    static vec3s room[MOST_VERTICES];
    struct ray_of_test ray = { s, fixture_ray(s, x, y), INFINITY, { -1, -1 } };
    for (int i = 0; i < s->scene->instance_count; i++) {
        const struct mesh *mesh = scene_mesh_of(s->scene, i);
        if (!mesh->vertex_count) continue;
        assert_true(mesh->vertex_count <= MOST_VERTICES);
        const vec3s *positions = world_positions(s, i, room);
        for (uint32_t t = 0; t < mesh->index_count / 3; t++) meet(&ray, i, positions, t);
    }
    return ray.id;
}

static bool same(struct id a, struct id b)
{
    return a.instance == b.instance && a.triangle == b.triangle;
}

// Silhouettes and edges of triangles: the surface differs within a tenth of a pixel.
static bool on_edge(const struct frame_fixture *s, float x, float y, struct id centre)
{
    static const float offsets[4][2] = { { -0.1f, 0 }, { 0.1f, 0 }, { 0, -0.1f }, { 0, 0.1f } };
    for (int i = 0; i < 4; i++)
        if (!same(traced(s, x + offsets[i][0], y + offsets[i][1]), centre)) return true;
    return false;
}

// Compares all pixels but those on edges. Returns the number of instances that are seen.
static int check_ids(struct frame_fixture *s)
{
    float *ids = fixture_read(s, READ_ID), *depth = fixture_read(s, READ_DEPTH);
    bool seen[64] = { false };
    uint32_t compared = 0;
    int count = 0;
    for (uint32_t y = 0; y < s->height; y++)
        for (uint32_t x = 0; x < s->width; x++) {
            const size_t i = (size_t)y * s->width + x;
            const struct id got = { (int)ids[2 * i], (int)ids[2 * i + 1] };
            CHECK((got.instance >= 0) == (depth[i] > 0.0f) &&
                  (got.triangle >= 0) == (depth[i] > 0.0f));
            const struct id expected = traced(s, (float)x + 0.5f, (float)y + 0.5f);
            if (on_edge(s, (float)x + 0.5f, (float)y + 0.5f, expected)) continue;
            if (!same(got, expected))
                fail_msg("pixel %u, %u: instance %d, triangle %d; traced: %d, %d", x, y,
                         got.instance, got.triangle, expected.instance, expected.triangle);
            if (got.instance >= 0) seen[got.instance] = true;
            compared++;
        }
    CHECK(compared > s->width * s->height * 3 / 4);
    for (int i = 0; i < 64; i++) count += seen[i];
    free(ids), free(depth);
    return count;
}

// ---- Scenes

static int cube(struct frame_fixture *s, int material)
{
    vec3s positions[8];
    uint32_t indices[36] = { 0, 2, 1, 0, 3, 2, 4, 5, 6, 4, 6, 7, 0, 1, 5, 0, 5, 4,
                             3, 6, 2, 3, 7, 6, 0, 4, 7, 0, 7, 3, 1, 2, 6, 1, 6, 5 };
    for (int i = 0; i < 8; i++)
        positions[i] =
            vec3_of((i + 1) & 2 ? 0.5f : -0.5f, i & 2 ? 0.5f : -0.5f, i & 4 ? 0.5f : -0.5f);
    const int mesh = scene_add_mesh(s->scene, &(struct mesh){ .name = "cube",
                                                              .vertex_count = 8,
                                                              .index_count = 36,
                                                              .positions = positions,
                                                              .indices = indices,
                                                              .material = material });
    assert_true(mesh >= 0);
    return mesh;
}

static int place(struct frame_fixture *s, int mesh, vec3s at, float angle_rad, vec3s scale)
{
    struct node node = node_default();
    node.translation = at;
    node.rotation = glms_quatv(angle_rad, glms_vec3_normalize(vec3_of(1, 2, 0.5f)));
    node.scale = scale;
    return fixture_instance(s, mesh, &node);
}

static mat4s moved(vec3s at, float angle_rad)
{
    return glms_rotate(glms_translate(glms_mat4_identity(), at), angle_rad, vec3_of(0.3f, 1, 0));
}

// A floor and cubes of one mesh, one of them mirrored, before an empty background.
static int open_cubes(struct frame_fixture *s, struct gpu *gpu)
{
    fixture_init(s, gpu);
    s->input.want_id_layer = true;
    s->width = 60, s->height = 44;
    const int white = fixture_matte(s, vec3_of(1, 1, 1));
    fixture_floor(s, 4, white);
    const int mesh = cube(s, white);
    place(s, mesh, vec3_of(-1.2f, 0.8f, 0), 0.5f, vec3_of(1, 1.5f, 1));
    place(s, mesh, vec3_of(0.6f, 0.7f, 0.5f), 1.1f, vec3_of(-1, 1, 1));
    place(s, mesh, vec3_of(0.9f, 1.1f, -1.5f), 2.0f, vec3_of(1.5f, 2, 1));
    fixture_look(s, vec3_of(0.5f, 2.5f, 4.5f), vec3_of(0, 0.6f, 0));
    return mesh;
}

TEST_GPU(ids_are_those_of_the_traced_rays)
{
    struct frame_fixture s;
    open_cubes(&s, gpu);
    fixture_open(&s);
    fixture_render(&s);
    assert_int_equal(check_ids(&s), 4);
    fixture_resize(&s, 31, 47);
    fixture_render(&s);
    assert_int_equal(check_ids(&s), 4);
    fixture_finish(&s);
}

static void follow(struct frame_fixture *s)
{
    assert_true(pose_follow(&s->pose));
    pose_update(&s->pose, -1, 0);
    fixture_render(s);
}

TEST_GPU(ids_follow_instances_that_move_come_and_go)
{
    struct frame_fixture s;
    const int mesh = open_cubes(&s, gpu);
    fixture_open(&s);
    fixture_render(&s);
    assert_true(scene_set_instance_transform(s.scene, 1, moved(vec3_of(-0.4f, 1.4f, 1), 0.9f)));
    follow(&s);
    assert_int_equal(check_ids(&s), 4);
    // The second cube is gone; its index is that of the next instance.
    scene_remove_instance(s.scene, 2);
    follow(&s);
    assert_int_equal(check_ids(&s), 3);
    const mat4s here = moved(vec3_of(1.8f, 0.6f, 1), 0.2f), there = moved(vec3_of(-2, 0.5f, -1), 0);
    assert_int_equal(scene_add_placed_instance(s.scene, mesh, here, false), 2);
    assert_int_equal(scene_add_placed_instance(s.scene, mesh, there, true), 4);
    follow(&s);
    assert_int_equal(check_ids(&s), 5);
    fixture_finish(&s);
}

TEST_GPU(ids_are_of_what_the_alpha_test_keeps)
{
    for (int mode = 0; mode < 3; mode++) { // opaque, masked, masked and seen from behind
        struct frame_fixture s;
        open_cubes(&s, gpu);
        uint8_t rgba[16] = { 255, 0, 0, 255, 0, 255, 0, 0, 0, 0, 255, 0, 255, 255, 255, 255 };
        struct material m = material_default();
        m.base_color_map = texture_use_none();
        m.base_color_map.image = scene_add_image(
            s.scene,
            &(struct scene_image){
                .name = "holes", .width = 2, .height = 2, .rgba = rgba, .has_alpha = true });
        m.base_color_map.wrap_u = m.base_color_map.wrap_v = WRAP_CLAMP;
        m.base_color_map.nearest = true;
        m.alpha_mode = mode ? ALPHA_MASK : ALPHA_OPAQUE;
        m.alpha_cutoff = 0.5f;
        m.double_sided = mode == 2;
        const float left = mode == 2 ? 1 : -1;
        fixture_quad(&s, vec3_of(left, 0.5f, 2), vec3_of(-left, 0.5f, 2), vec3_of(-left, 2, 2),
                     vec3_of(left, 2, 2), fixture_material(&s, &m));
        fixture_open(&s);
        fixture_render(&s);
        CHECK(check_ids(&s) >= 3);
        fixture_finish(&s);
    }
}

TEST_GPU(ids_of_deformed_meshes_are_at_their_deformed_places)
{
    struct frame_fixture s;
    open_cubes(&s, gpu);
    vec3s positions[6], up[6];
    for (int i = 0; i < 6; i++) {
        positions[i] = vec3_of(0.5f * (float)(i / 2) - 2, 0.2f + 0.8f * (float)(i % 2), 1.5f);
        up[i] = vec3_of(1.5f, 0.5f * (float)(i / 2), 0);
    }
    uint32_t indices[12] = { 0, 2, 1, 1, 2, 3, 2, 4, 3, 3, 4, 5 };
    struct morph_target morph = { .positions = up };
    float weight = 1.0f;
    struct node node = node_default();
    const struct instance instance = { .node = scene_add_node(s.scene, &node),
                                       .mesh = scene_add_mesh(
                                           s.scene, &(struct mesh){ .name = "ribbon",
                                                                    .vertex_count = 6,
                                                                    .index_count = 12,
                                                                    .positions = positions,
                                                                    .indices = indices,
                                                                    .morphs = &morph,
                                                                    .morph_count = 1 }),
                                       .skin = -1,
                                       .morph_weights = &weight };
    assert_int_equal(scene_add_instance(s.scene, &instance), 4);
    fixture_open(&s);
    fixture_render(&s);
    assert_int_equal(check_ids(&s), 5);
    for (int v = 0; v < 6; v++) s.pose.deformed[4].positions[v].x -= 0.7f;
    fixture_render(&s);
    assert_int_equal(check_ids(&s), 5);
    fixture_finish(&s);
}

// A skinned figure of a file, in two poses.
TEST_GPU(ids_of_skinned_meshes_are_at_their_deformed_places)
{
    const char *path = test_scene_path("fox.glb");
    struct frame_fixture s;
    fixture_init(&s, gpu);
    scene_destroy(s.scene);
    s.scene = scene_load(test_host(), path);
    assert_non_null(s.scene);
    s.input.want_id_layer = true;
    fixture_open(&s);
    for (int i = 0; i < 2; i++) {
        pose_update(&s.pose, 0, 0.3f * (float)i);
        const vec3s centre = glms_vec3_center(s.pose.bounds.min, s.pose.bounds.max);
        const float size = glms_vec3_distance(s.pose.bounds.min, s.pose.bounds.max);
        fixture_look(&s, glms_vec3_muladds(vec3_of(0.6f, 0.3f, 0.5f), size, centre), centre);
        fixture_render(&s);
        float *ids = fixture_read(&s, READ_ID);
        int compared = 0;
        for (uint32_t k = 0; k < s.width * s.height; k += 3) { // the mesh has many triangles
            const float x = (float)(k % s.width) + 0.5f, y = (float)(k / s.width) + 0.5f;
            const struct id expected = traced(&s, x, y),
                            got = { (int)ids[2 * k], (int)ids[2 * k + 1] };
            if (on_edge(&s, x, y, expected)) continue;
            assert_true(same(got, expected));
            compared += got.instance >= 0;
        }
        CHECK(compared > 10);
        free(ids);
    }
    fixture_finish(&s);
}

// The triangles of a long list are drawn in parts.
TEST_GPU(triangles_at_the_end_of_a_long_list_have_their_numbers)
{
    enum { COUNT = (2 << 20) + 7 };
    struct frame_fixture s;
    fixture_init(&s, gpu);
    s.input.want_id_layer = true;
    uint32_t *indices = calloc(COUNT, 3 * sizeof *indices); // degenerate, but for the last two
    assert_non_null(indices);
    static const uint32_t last[6] = { 0, 1, 2, 0, 2, 3 };
    memcpy(&indices[3 * (COUNT - 2)], last, sizeof last);
    vec3s positions[4] = { vec3_of(-1, -1, -1), vec3_of(1, -1, -1), vec3_of(1, 1, -1),
                           vec3_of(-1, 1, -1) };
    vec3s normals[4] = { vec3_of(0, 0, 1), vec3_of(0, 0, 1), vec3_of(0, 0, 1), vec3_of(0, 0, 1) };
    const int mesh =
        scene_add_mesh(s.scene, &(struct mesh){ .name = "long",
                                                .vertex_count = 4,
                                                .index_count = 3 * COUNT,
                                                .positions = positions,
                                                .normals = normals,
                                                .indices = indices,
                                                .material = fixture_matte(&s, vec3_of(1, 1, 1)) });
    free(indices);
    assert_true(mesh >= 0);
    fixture_instance(&s, mesh, NULL);
    fixture_open(&s);
    fixture_render(&s);
    const vec3s below = fixture_pixel(&s, READ_ID, 24, 28),
                above = fixture_pixel(&s, READ_ID, 4, 8);
    CHECK(below.x == 0.0f && below.y == (float)(COUNT - 2));
    CHECK(above.x == 0.0f && above.y == (float)(COUNT - 1));
    fixture_finish(&s);
}

// ---- Other layers

TEST_GPU(other_layers_are_the_same_to_the_bit_with_ids)
{
    static const enum frame_readback layers[] = { READ_DEPTH,    READ_NORMAL, READ_ALBEDO,
                                                  READ_EMISSIVE, READ_COLOR,  READ_MOTION };
    float *with[6], *without[6];
    for (int ids = 0; ids < 2; ids++) {
        struct frame_fixture s;
        open_cubes(&s, gpu);
        struct material glossy = material_default();
        glossy.ior = 2.0f; // FRAME_DIELECTRIC
        place(&s, cube(&s, fixture_material(&s, &glossy)), vec3_of(2, 1, 1), 0.3f,
              vec3_of(1, 1, 1));
        fixture_add_sun(&s, vec3_of(-1, -2, -1), vec3_of(100, 90, 80));
        s.input.want_id_layer = ids == 1;
        s.input.want_motion_layer = true;
        fixture_open(&s);
        fixture_render(&s);
        fixture_look(&s, vec3_of(0.6f, 2.5f, 4.5f), vec3_of(0, 0.6f, 0));
        fixture_render(&s);
        CHECK((frame_layer_image(s.frame, FRAME_ID).id != 0) == (ids == 1));
        if (ids) assert_int_equal(check_ids(&s), 5);
        for (int l = 0; l < 6; l++) (ids ? with : without)[l] = fixture_read(&s, layers[l]);
        fixture_finish(&s);
    }
    for (int l = 0; l < 6; l++) {
        const size_t channels = layers[l] == READ_DEPTH ? 1 : 3;
        CHECK(memcmp(with[l], without[l], sizeof(float) * 60 * 44 * channels) == 0);
        free(with[l]), free(without[l]);
    }
}

TEST_GPU(a_picked_pixel_has_the_id_of_the_layer)
{
    struct frame_fixture s;
    struct frame_pick pick;
    open_cubes(&s, gpu);
    fixture_open(&s);
    fixture_render(&s);
    assert_false(frame_newest_pick(s.frame, &pick));
    s.input.pick = true;
    for (uint32_t k = 0; k < 40; k++) {
        s.input.pick_x = 13 * k % s.width;
        s.input.pick_y = 7 * k % s.height;
        fixture_render(&s);
        assert_true(frame_newest_pick(s.frame, &pick));
        const vec3s id = fixture_pixel(&s, READ_ID, s.input.pick_x, s.input.pick_y);
        assert_true(pick.number == k + 2 && pick.x == s.input.pick_x && pick.y == s.input.pick_y);
        CHECK((float)pick.instance - 1.0f == id.x && (float)pick.triangle - 1.0f == id.y);
    }
    s.input.pick = false;
    fixture_render(&s);
    assert_true(frame_newest_pick(s.frame, &pick) && pick.number == 41);
    fixture_finish(&s);
}
