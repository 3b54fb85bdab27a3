// Scenes of the physical trials.
#include "techniques/trials/light_trial_scenes.h"

#include <math.h>
#include <stdlib.h>

static const float SLAB = 0.05f;

static vec3s grey(float value)
{
    return vec3_of(value, value, value);
}

// 1000 cd/m².
static int emitter(struct frame_fixture *s, float albedo)
{
    struct material m = material_default();
    m.emissive = grey(1000);
    m.base_color = vec4_of(grey(albedo), 1);
    m.metallic = 0;
    return fixture_material(s, &m);
}

// A camera of the scene, at a position inside a room.
static void add_camera(struct frame_fixture *s, vec3s at)
{
    const struct camera camera = { .name = "camera",
                                   .node = scene_add_node_looking(s->scene, "camera", at,
                                                                  vec3_of(0, 0, -1)),
                                   .vertical_fov_rad = 1,
                                   .near_m = 0.1f };
    assert_true(camera.node >= 0 && scene_add_camera(s->scene, &camera) >= 0);
}

void trial_two_rooms(struct frame_fixture *s, struct gpu *gpu, bool camera_in_dark_room)
{
    const float t = SLAB;
    const struct box3 slabs[] = {
        { vec3_of(-4, -t, -2), vec3_of(4, 0, 2) },                  // floor
        { vec3_of(-t / 2, 3, -2), vec3_of(4, 3 + t, 2) },           // roof of the right room
        { vec3_of(-4 - t, -t, -2 - t), vec3_of(-4, 3 + t, 2 + t) }, // left, right
        { vec3_of(4, -t, -2 - t), vec3_of(4 + t, 3 + t, 2 + t) },
        { vec3_of(-4, -t, -2 - t), vec3_of(4, 3 + t, -2) }, // back, front
        { vec3_of(-4, -t, 2), vec3_of(4, 3 + t, 2 + t) },
        { vec3_of(-t / 2, 0, -2), vec3_of(t / 2, 3, 2) }, // between the rooms
    };
    fixture_init(s, gpu);
    s->options.shadow_size = 1024;
    const int white = fixture_matte(s, grey(0.7f));
    for (size_t i = 0; i < sizeof slabs / sizeof slabs[0]; i++)
        fixture_box(s, slabs[i].min, slabs[i].max, false, white);
    fixture_add_sun(s, vec3_of(0.3f, -1, 0.2f), grey(1000));
    add_camera(s, vec3_of(-2, 1.5f, 0));
    add_camera(s, vec3_of(2, 1.5f, 0));
    if (camera_in_dark_room)
        fixture_look(s, vec3_of(3.8f, 2.5f, 1.8f), vec3_of(0, 0.8f, -1.5f));
    else
        fixture_look(s, vec3_of(-3.8f, 2.5f, 1.8f), vec3_of(0, 0.8f, -1.5f));
}

void trial_door(struct frame_fixture *s, struct gpu *gpu, bool back)
{
    const float t = SLAB, half = SLAB / 2;
    const struct box3 slabs[] = {
        { vec3_of(-4, -t, -2), vec3_of(4, 0, 2) }, // floor, ceiling
        { vec3_of(-4, 3, -2), vec3_of(4, 3 + t, 2) },
        { vec3_of(-4 - t, -t, -2 - t), vec3_of(-4, 3 + t, 2 + t) }, // left, right
        { vec3_of(4, -t, -2 - t), vec3_of(4 + t, 3 + t, 2 + t) },
        { vec3_of(-4, -t, -2 - t), vec3_of(4, 3 + t, -2) }, // back, front
        { vec3_of(-4, -t, 2), vec3_of(4, 3 + t, 2 + t) },
        { vec3_of(-half, 0, -2), vec3_of(half, 3, -0.5f) }, // beside the door, and above it
        { vec3_of(-half, 0, 0.5f), vec3_of(half, 3, 2) },
        { vec3_of(-half, 2.1f, -0.5f), vec3_of(half, 3, 0.5f) },
    };
    fixture_init(s, gpu);
    s->options.shadow_size = 512;
    s->options.rsm_size = 256;
    const int white = fixture_matte(s, grey(0.7f));
    for (size_t i = 0; i < sizeof slabs / sizeof slabs[0]; i++)
        fixture_box(s, slabs[i].min, slabs[i].max, false, white);
    fixture_add_point(s, vec3_of(-2, 2.3f, 1.2f), grey(200));
    add_camera(s, vec3_of(-2, 1.5f, 0));
    add_camera(s, vec3_of(2, 1.5f, 0));
    if (back)
        fixture_look(s, vec3_of(3.8f, 2.5f, -1.8f), vec3_of(0, 2.2f, 1.2f));
    else
        fixture_look(s, vec3_of(0.3f, 1.5f, -1.8f), vec3_of(3, 1.6f, 2));
}

// Walls 0.2 thick around a room; its wall at high x has a window, unless that is empty.
static void add_house(struct frame_fixture *s, struct box3 room, struct box3 window, int material)
{
    const float t = 0.2f;
    const vec3s low = room.min, high = room.max, a = window.min, b = window.max;
    const struct box3 slabs[] = {
        { vec3_of(low.x - t, low.y - t, low.z - t), vec3_of(high.x + t, low.y, high.z + t) },
        { vec3_of(low.x - t, high.y, low.z - t), vec3_of(high.x + t, high.y + t, high.z + t) },
        { vec3_of(low.x - t, low.y, low.z - t), vec3_of(low.x, high.y, high.z + t) },
        { vec3_of(low.x, low.y, low.z - t), vec3_of(high.x + t, high.y, low.z) },
        { vec3_of(low.x, low.y, high.z), vec3_of(high.x + t, high.y, high.z + t) },
    };
    const struct box3 around[] = {
        { vec3_of(high.x, low.y, low.z), vec3_of(high.x + t, high.y, a.z) },
        { vec3_of(high.x, low.y, b.z), vec3_of(high.x + t, high.y, high.z) },
        { vec3_of(high.x, low.y, a.z), vec3_of(high.x + t, a.y, b.z) },
        { vec3_of(high.x, b.y, a.z), vec3_of(high.x + t, high.y, b.z) },
    };
    for (size_t i = 0; i < sizeof slabs / sizeof slabs[0]; i++)
        fixture_box(s, slabs[i].min, slabs[i].max, false, material);
    if (box3_is_empty(window))
        fixture_box(s, vec3_of(high.x, low.y, low.z), vec3_of(high.x + t, high.y, high.z), false,
                    material);
    for (size_t i = 0; i < sizeof around / sizeof around[0] && !box3_is_empty(window); i++)
        fixture_box(s, around[i].min, around[i].max, false, material);
}

void trial_window(struct frame_fixture *s, struct gpu *gpu, bool towards_window)
{
    const struct box3 room = { vec3_of(-2, 0, -2), vec3_of(2, 2.8f, 2) };
    const struct box3 window = { vec3_of(2, 0.9f, -0.8f), vec3_of(2, 2.1f, 0.8f) };
    fixture_init(s, gpu);
    s->options.shadow_size = 1024;
    const int white = fixture_matte(s, grey(0.7f)), ground = fixture_matte(s, grey(0.4f));
    add_house(s, room, window, white);
    fixture_box(s, vec3_of(-20, -0.4f, -20), vec3_of(20, -0.05f, 20), false, ground);
    fixture_add_sun(s, vec3_of(0, -1, -1), grey(20000));
    add_camera(s, vec3_of(0, 1.5f, 0));
    if (towards_window)
        fixture_look(s, vec3_of(-1.8f, 1.6f, 1.7f), vec3_of(1, 1.2f, -1));
    else
        fixture_look(s, vec3_of(1.6f, 1.6f, -1.7f), vec3_of(-1.5f, 1.2f, 1));
}

static struct box3 window_of(struct box3 room, float low, float high)
{
    const float middle = 0.5f * (room.min.z + room.max.z);
    return (struct box3){ vec3_of(room.max.x, low, middle - 0.8f),
                          vec3_of(room.max.x, high, middle + 0.8f) };
}

const struct box3 trial_street_rooms[TRIAL_STREET_ROOMS] = {
    [TRIAL_STREET_SMALL] = { { { -2, 0, -2 } }, { { 2, 2.8f, 2 } } },
    [TRIAL_STREET_LARGE] = { { { 8, 0, -3 } }, { { 12.5f, 4, 3 } } },
    [TRIAL_STREET_DARK] = { { { -3, 0, -9 } }, { { 0, 2.6f, -5 } } },
    [TRIAL_STREET_BACK] = { { { -5, 0, 6 } }, { { -1.1f, 3, 10 } } },
    [TRIAL_STREET_FRONT] = { { { -0.9f, 0, 6 } }, { { 3, 3, 10 } } },
};

// A wall between two rooms with a door of 1 × 2.1.
static void add_door(struct frame_fixture *s, struct box3 back, struct box3 front, int material)
{
    const float low = back.max.x, high = front.min.x, top = back.max.y;
    const float middle = 0.5f * (back.min.z + back.max.z);
    fixture_box(s, vec3_of(low, 0, back.min.z), vec3_of(high, top, middle - 0.5f), false, material);
    fixture_box(s, vec3_of(low, 0, middle + 0.5f), vec3_of(high, top, back.max.z), false, material);
    fixture_box(s, vec3_of(low, 2.1f, middle - 0.5f), vec3_of(high, top, middle + 0.5f), false,
                material);
}

void trial_street(struct frame_fixture *s, struct gpu *gpu, enum trial_street_room room)
{
    const struct box3 *rooms = trial_street_rooms, at = rooms[room];
    const struct box3 pair = box3_union(rooms[TRIAL_STREET_BACK], rooms[TRIAL_STREET_FRONT]);
    fixture_init(s, gpu);
    s->options.shadow_size = 2048;
    const int white = fixture_matte(s, grey(0.7f)), ground = fixture_matte(s, grey(0.4f));
    add_house(s, rooms[TRIAL_STREET_SMALL], window_of(rooms[TRIAL_STREET_SMALL], 0.9f, 2.1f),
              white);
    add_house(s, rooms[TRIAL_STREET_LARGE], window_of(rooms[TRIAL_STREET_LARGE], 1, 3), white);
    add_house(s, rooms[TRIAL_STREET_DARK], box3_empty(), white);
    add_house(s, pair, window_of(pair, 0.9f, 2.1f), white);
    add_door(s, rooms[TRIAL_STREET_BACK], rooms[TRIAL_STREET_FRONT], white);
    fixture_box(s, vec3_of(-20, -0.6f, -20), vec3_of(20, -0.2f, 20), false, ground);
    fixture_box(s, vec3_of(14, -0.2f, -18), vec3_of(18, 12, -14), false, ground); // a tower
    fixture_add_sun(s, vec3_of(0, -1, -1), grey(20000));
    add_camera(s, vec3_of(-16, 2, 0)); // outdoors
    fixture_look(s, vec3_of(at.max.x - 0.2f, 1.6f, at.max.z - 0.3f),
                 vec3_of(at.min.x, 1.2f, at.min.z + 0.5f));
}

void trial_outdoors(struct frame_fixture *s, struct gpu *gpu, bool two_boxes)
{
    fixture_init(s, gpu);
    s->options.shadow_size = 2048;
    const int white = fixture_matte(s, grey(0.7f)), ground = fixture_matte(s, grey(0.4f));
    fixture_box(s, vec3_of(-1, 0, -1), vec3_of(1, 2, 1), false, white);
    if (two_boxes)
        fixture_box(s, vec3_of(1.5f, 1, -1), vec3_of(3.5f, 3, 1), false, white);
    else
        fixture_box(s, vec3_of(-10, -0.5f, -10), vec3_of(10, 0, 10), false, ground);
    fixture_add_sun(s, vec3_of(0, -1, -1), grey(1000));
    s->input.environment.sky = grey(100);
    fixture_look(s, vec3_of(5, 3, -6), vec3_of(0.5f, 1, 0));
}

void trial_open_plane(struct frame_fixture *s, struct gpu *gpu, const struct trial_plane *plane)
{
    const float half = 3, c = cosf(plane->tilt_rad), d = sinf(plane->tilt_rad);
    const vec3s across = vec3_of(half * c, half * d, 0), down = vec3_of(0, 0, half);
    const vec3s normal = vec3_of(-d, c, 0);
    struct material m = material_default();
    m.base_color = vec4_of(grey(0.7f), 1);
    m.metallic = 0;
    m.roughness = 1;
    m.specular = 0;
    m.double_sided = plane->double_sided;
    fixture_init(s, gpu);
    s->options.shadow_size = 1024;
    fixture_quad(s, glms_vec3_sub(down, across), glms_vec3_add(down, across),
                 glms_vec3_sub(across, down), glms_vec3_negate(glms_vec3_add(across, down)),
                 fixture_material(s, &m));
    if (plane->sun)
        fixture_add_sun(s, vec3_of(0.2f, -1, 0.3f), grey(1000));
    else
        s->input.environment.sky = grey(1);
    const vec3s beside = vec3_of(0, 0, 0.1f);
    fixture_look(s, glms_vec3_muladds(normal, 4, beside), vec3_of(0, 0, 0));
}

// The six walls of a room, faces inwards: −x +x −y +y −z +z.
static void add_walls(struct frame_fixture *s, vec3s min, vec3s max, const int materials[6])
{
    for (int face = 0; face < 6; face++) {
        const int axis = face / 2, u = (axis + 1) % 3, v = (axis + 2) % 3;
        vec3s corners[4];
        for (int i = 0; i < 4; i++) {
            corners[i].raw[axis] = face % 2 ? max.raw[axis] : min.raw[axis];
            corners[i].raw[u] = i == 1 || i == 2 ? max.raw[u] : min.raw[u];
            corners[i].raw[v] = i >= 2 ? max.raw[v] : min.raw[v];
        }
        fixture_quad(s, corners[0], corners[face % 2 ? 3 : 1], corners[2],
                     corners[face % 2 ? 1 : 3], materials[face]);
    }
}

void trial_empty_room(struct frame_fixture *s, struct gpu *gpu)
{
    fixture_init(s, gpu);
    s->options.shadow_size = 1024;
    const int black = fixture_matte(s, grey(0)), white = fixture_matte(s, grey(0.8f));
    const int materials[6] = { white, black, black, black, black, black };
    add_walls(s, vec3_of(-3, 0, -1.5f), vec3_of(3, 3, 1.5f), materials);
    fixture_add_spot(s, vec3_of(2.9f, 1.5f, 0), vec3_of(-1, 0, 0), 0.1f, 0.22f, grey(1000));
    fixture_look(s, vec3_of(-2.8f, 1.5f, 0), vec3_of(3, 1.5f, 0));
    s->input.camera.vertical_fov_rad = 0.5f; // sees the other end wall alone
}

void trial_small_patch(struct frame_fixture *s, struct gpu *gpu)
{
    fixture_init(s, gpu);
    s->options.shadow_size = 1024;
    s->options.rsm_size = 256;
    const int white = fixture_matte(s, grey(0.7f));
    const int materials[6] = { white, white, white, white, white, white };
    add_walls(s, vec3_of(-3, 0, -2), vec3_of(3, 3, 2), materials);
    fixture_add_spot(s, vec3_of(1, 2.95f, 0.5f), vec3_of(0, -1, 0), 0.06f, 0.085f, grey(1000));
    fixture_look(s, vec3_of(-2.8f, 2.6f, 1.8f), vec3_of(1, 0.8f, -1));
}

void trial_patch_beside_corner(struct frame_fixture *s, struct gpu *gpu)
{
    fixture_init(s, gpu);
    s->options.shadow_size = 1024;
    const int white = fixture_matte(s, grey(0.7f)), brown = fixture_matte(s, grey(0.35f));
    const int materials[6] = { white, white, brown, white, white, white };
    add_walls(s, vec3_of(-3, 0, -2.5f), vec3_of(0, 2.8f, 2.5f), materials);
    fixture_add_spot(s, vec3_of(-1.2f, 2.7f, 0.2f), vec3_of(0, -1, 0), 0.05f, 0.3f, grey(1000));
    fixture_look(s, vec3_of(-1, 1.6f, 0.5f), vec3_of(-3, 0.2f, -2.5f));
}

// Rings of quads between the poles.
static void add_sphere(struct frame_fixture *s, vec3s center, float radius, int material)
{
    enum { ROUND = 48, DOWN = 24, VERTICES = (ROUND + 1) * (DOWN + 1) };
    static vec3s positions[VERTICES], normals[VERTICES];
    static uint32_t indices[6 * ROUND * DOWN];
    for (uint32_t i = 0; i < VERTICES; i++) {
        const float polar = GLM_PIf * (float)(i / (ROUND + 1)) / DOWN;
        const float azimuth = 2.0f * GLM_PIf * (float)(i % (ROUND + 1)) / ROUND;
        normals[i] = vec3_of(sinf(polar) * cosf(azimuth), cosf(polar), sinf(polar) * sinf(azimuth));
        positions[i] = glms_vec3_muladds(normals[i], radius, center);
    }
    for (uint32_t q = 0; q < ROUND * DOWN; q++) {
        const uint32_t a = q / ROUND * (ROUND + 1) + q % ROUND, b = a + ROUND + 1;
        const uint32_t quad[6] = { a, a + 1, b + 1, a, b + 1, b };
        for (uint32_t k = 0; k < 6; k++) indices[6 * q + k] = quad[k];
    }
    const int mesh = scene_add_mesh(s->scene, &(struct mesh){ .name = "sphere",
                                                              .vertex_count = VERTICES,
                                                              .index_count = 6 * ROUND * DOWN,
                                                              .positions = positions,
                                                              .normals = normals,
                                                              .indices = indices,
                                                              .material = material });
    assert_true(mesh >= 0);
    fixture_instance(s, mesh, NULL);
}

void trial_bright_spot(struct frame_fixture *s, struct gpu *gpu)
{
    fixture_init(s, gpu);
    s->options.shadow_size = 1024;
    s->width = 96;
    s->height = 54;
    const int white = fixture_matte(s, grey(0.7f));
    const int materials[6] = { white, white, white, white, white, white };
    add_walls(s, vec3_of(-3, 0, -2), vec3_of(3, 3, 2), materials);
    add_sphere(s, vec3_of(-1.2f, 0.6f, -0.5f), 0.6f, fixture_matte(s, vec3_of(0.6f, 0.15f, 0.1f)));
    add_sphere(s, vec3_of(0.4f, 0.45f, 0.3f), 0.45f, fixture_matte(s, vec3_of(0.15f, 0.5f, 0.2f)));
    add_sphere(s, vec3_of(1.6f, 0.7f, -0.9f), 0.7f, fixture_matte(s, vec3_of(0.5f, 0.5f, 0.8f)));
    fixture_add_point(s, vec3_of(2.2f, 2.88f, -1.2f), grey(40));
    fixture_look(s, vec3_of(-2.6f, 1.7f, 1.8f), vec3_of(0.6f, 0.9f, -0.8f));
}

static int add_strips(struct frame_fixture *s, int count, vec2s size, float spacing, float height,
                      int material)
{
    const uint32_t strips = (uint32_t)(count * count);
    vec3s *positions = calloc(4 * strips, sizeof *positions);
    uint32_t *indices = calloc(6 * strips, sizeof *indices);
    assert_non_null(positions);
    assert_non_null(indices);
    for (uint32_t i = 0; i < strips; i++) {
        const float x = spacing * ((float)(i % (uint32_t)count) - 0.5f * (float)(count - 1)),
                    z = spacing * ((float)(i / (uint32_t)count) - 0.5f * (float)(count - 1));
        for (uint32_t k = 0; k < 4; k++)
            positions[4 * i + k] = vec3_of(x + size.x * (k == 1 || k == 2 ? 0.5f : -0.5f), height,
                                           z + size.y * (k >= 2 ? 0.5f : -0.5f));
        const uint32_t quad[6] = { 0, 1, 2, 0, 2, 3 }; // faces down
        for (uint32_t k = 0; k < 6; k++) indices[6 * i + k] = 4 * i + quad[k];
    }
    const int mesh = scene_add_mesh(s->scene, &(struct mesh){ .name = "strips",
                                                              .vertex_count = 4 * strips,
                                                              .index_count = 6 * strips,
                                                              .positions = positions,
                                                              .indices = indices,
                                                              .material = material });
    assert_true(mesh >= 0);
    free(positions);
    free(indices);
    return fixture_instance(s, mesh, NULL);
}

void trial_strips(struct frame_fixture *s, struct gpu *gpu)
{
    fixture_init(s, gpu);
    fixture_floor(s, 3, fixture_matte(s, grey(0.5f)));
    add_strips(s, 12, (vec2s){ { 0.4f, 0.02f } }, 0.5f, 2.5f, emitter(s, 0));
    fixture_look(s, vec3_of(0, 2.2f, 2.8f), vec3_of(0, 0, 0));
}

void trial_panel(struct frame_fixture *s, struct gpu *gpu)
{
    fixture_init(s, gpu);
    const int white = fixture_matte(s, grey(0.7f));
    const int materials[6] = { white, white, white, white, white, white };
    add_walls(s, vec3_of(-2, 0, -2), vec3_of(2, 3, 2), materials);
    fixture_quad(s, vec3_of(-0.5f, 2.98f, -0.4f), vec3_of(0.5f, 2.98f, -0.4f),
                 vec3_of(0.5f, 2.98f, 0.4f), vec3_of(-0.5f, 2.98f, 0.4f), emitter(s, 0.7f));
    fixture_look(s, vec3_of(0, 0.3f, 1.9f), vec3_of(0, 3, -0.5f));
}

void trial_sheet_below_ceiling(struct frame_fixture *s, struct gpu *gpu)
{
    fixture_init(s, gpu);
    struct material m = material_default();
    m.emissive = grey(1000);
    m.base_color = vec4_of(grey(0.7f), 1);
    m.metallic = 0;
    m.double_sided = true;
    const int white = fixture_matte(s, grey(0.5f)), sheet = fixture_material(s, &m);
    const int materials[6] = { white, white, white, white, white, white };
    add_walls(s, vec3_of(-2, 0, -2), vec3_of(2, 3, 2), materials);
    fixture_quad(s, vec3_of(-0.5f, 2.98f, -0.4f), vec3_of(0.5f, 2.98f, -0.4f),
                 vec3_of(0.5f, 2.98f, 0.4f), vec3_of(-0.5f, 2.98f, 0.4f), sheet);
    fixture_look(s, vec3_of(1.7f, 2, 1.7f), vec3_of(-1.3f, 0.5f, -1.3f));
}

void trial_ceiling_light(struct frame_fixture *s, struct gpu *gpu, float gap)
{
    fixture_init(s, gpu);
    const int white = fixture_matte(s, grey(0.7f));
    const int materials[6] = { white, white, white, white, white, white };
    add_walls(s, vec3_of(-3, 0, -3), vec3_of(3, 5, 3), materials);
    fixture_box(s, vec3_of(-1, 4.9f - gap, -1), vec3_of(1, 5 - gap, 1), false, emitter(s, 0));
    fixture_look(s, vec3_of(2.7f, 3, 2.7f), vec3_of(-2, 0.5f, -2));
}

enum { BOX_VERTICES = 24, BOX_INDICES = 36 };

// A box that is one connected mesh, as furniture of files is.
static void add_solid(struct frame_fixture *s, vec3s min, vec3s max, int material)
{
    vec3s positions[BOX_VERTICES], normals[BOX_VERTICES] = { 0 };
    uint32_t indices[BOX_INDICES];
    for (uint32_t face = 0; face < 6; face++) {
        const uint32_t axis = face / 2, u = (axis + 1) % 3, v = (axis + 2) % 3, first = 4 * face;
        const bool high = face % 2;
        for (uint32_t i = 0; i < 4; i++) {
            positions[first + i].raw[axis] = high ? max.raw[axis] : min.raw[axis];
            positions[first + i].raw[u] = i == 1 || i == 2 ? max.raw[u] : min.raw[u];
            positions[first + i].raw[v] = i >= 2 ? max.raw[v] : min.raw[v];
            normals[first + i].raw[axis] = high ? 1.0f : -1.0f;
        }
        const uint32_t corners[6] = { 0, 1, 2, 0, 2, 3 };
        for (uint32_t i = 0; i < 6; i++) indices[6 * face + i] = first + corners[high ? i : 5 - i];
    }
    const int mesh = scene_add_mesh(s->scene, &(struct mesh){ .name = "solid",
                                                              .vertex_count = BOX_VERTICES,
                                                              .index_count = BOX_INDICES,
                                                              .positions = positions,
                                                              .normals = normals,
                                                              .indices = indices,
                                                              .material = material });
    assert_true(mesh >= 0 && fixture_instance(s, mesh, NULL) >= 0);
}

void trial_small_ceiling_light(struct frame_fixture *s, struct gpu *gpu, float gap)
{
    fixture_init(s, gpu);
    const int white = fixture_matte(s, grey(0.7f));
    const int materials[6] = { white, white, white, white, white, white };
    add_walls(s, vec3_of(-3, 0, -3), vec3_of(3, 3, 3), materials);
    add_solid(s, vec3_of(-0.6f, 2.9f - gap, -0.6f), vec3_of(0.6f, 3 - gap, 0.6f), emitter(s, 0));
    fixture_look(s, vec3_of(2.7f, 1.5f, 2.7f), vec3_of(-2, 0.5f, -2));
}

static void begin_furnished_room(struct frame_fixture *s, struct gpu *gpu, bool second_view)
{
    fixture_init(s, gpu);
    s->options.shadow_size = 1024;
    const int white = fixture_matte(s, grey(0.7f));
    const int materials[6] = { white, white, white, white, white, white };
    add_walls(s, vec3_of(-3, 0, -3), vec3_of(3, 2.8f, 3), materials);
    if (second_view)
        fixture_look(s, vec3_of(-2.5f, 1.7f, -1.3f), vec3_of(1.5f, 0.7f, 2));
    else
        fixture_look(s, vec3_of(2.7f, 1.7f, 2.7f), vec3_of(-1.5f, 1, -2));
}

static void add_table(struct frame_fixture *s, int wood)
{
    add_solid(s, vec3_of(0, 0.7f, -0.4f), vec3_of(1.6f, 0.75f, 0.4f), wood);
    for (int leg = 0; leg < 4; leg++) {
        const vec3s at = vec3_of(leg % 2 ? 1.49f : 0.05f, 0, leg / 2 ? 0.29f : -0.35f);
        add_solid(s, at, glms_vec3_add(at, vec3_of(0.06f, 0.7f, 0.06f)), wood);
    }
}

void trial_wardrobe(struct frame_fixture *s, struct gpu *gpu, bool second_view)
{
    begin_furnished_room(s, gpu, second_view);
    const int wood = fixture_matte(s, grey(0.4f));
    add_solid(s, vec3_of(-2.95f, 0, -1), vec3_of(-2.35f, 2.1f, 1), wood);
    add_table(s, wood);
    fixture_add_point(s, vec3_of(1, 2.4f, 1.2f), grey(200));
}

void trial_patch_between_blocks(struct frame_fixture *s, struct gpu *gpu, bool second_view)
{
    fixture_init(s, gpu);
    s->options.shadow_size = 1024;
    const int wood = fixture_matte(s, grey(0.4f));
    add_house(s, (struct box3){ vec3_of(-2.5f, 0, -2), vec3_of(2.5f, 2.6f, 2) }, box3_empty(),
              fixture_matte(s, grey(0.7f)));
    add_camera(s, vec3_of(0, 1.5f, 1));
    add_solid(s, vec3_of(-2.2f, 0, -1.7f), vec3_of(-1.9f, 0.3f, -1.4f), wood);
    add_solid(s, vec3_of(1.9f, 0, -1.7f), vec3_of(2.2f, 0.3f, -1.4f), wood);
    fixture_add_spot(s, vec3_of(0.2f, 2.5f, 0.3f), vec3_of(0, -1, 0), 0.2f, 0.4f, grey(800));
    if (second_view)
        fixture_look(s, vec3_of(-2.2f, 1, 1.7f), vec3_of(1.2f, 2, -0.6f));
    else
        fixture_look(s, vec3_of(2.2f, 1.6f, 1.7f), vec3_of(-1.2f, 1.1f, -0.6f));
}

void trial_long_room(struct frame_fixture *s, struct gpu *gpu, bool second_view)
{
    fixture_init(s, gpu);
    s->options.shadow_size = 1024;
    add_house(s, (struct box3){ vec3_of(-2.5f, 0, -2), vec3_of(2.5f, 2.6f, 2) }, box3_empty(),
              fixture_matte(s, grey(0.7f)));
    fixture_add_point(s, vec3_of(1, 2.2f, 1.2f), grey(200));
    add_camera(s, vec3_of(0, 1.5f, 1));
    if (second_view)
        fixture_look(s, vec3_of(-2.2f, 1.7f, 0.3f), vec3_of(1.5f, 0.7f, 1.5f));
    else
        fixture_look(s, vec3_of(2.2f, 1.7f, 1.7f), vec3_of(-1.5f, 1, -1.5f));
}

void trial_thick_walls(struct frame_fixture *s, struct gpu *gpu, bool second_view)
{
    trial_long_room(s, gpu, second_view);
    const int wood = fixture_matte(s, grey(0.4f));
    add_solid(s, vec3_of(-2.45f, 0, -1.6f), vec3_of(-1.85f, 2.1f, -0.2f), wood);
    add_solid(s, vec3_of(1.5f, 0.1f, -1), vec3_of(2.4f, 0.45f, 1), wood);
    add_solid(s, vec3_of(2.2f, 0.45f, -1), vec3_of(2.4f, 0.9f, 1), wood);
    add_table(s, wood);
}

void trial_shade(struct frame_fixture *s, struct gpu *gpu, bool second_view)
{
    begin_furnished_room(s, gpu, second_view);
    const int cloth = fixture_matte(s, grey(0.4f));
    const float in = 0.28f, out = 0.3f;
    add_solid(s, vec3_of(-out, 1.6f, -out), vec3_of(out, 1.9f, -in), cloth);
    add_solid(s, vec3_of(-out, 1.6f, in), vec3_of(out, 1.9f, out), cloth);
    add_solid(s, vec3_of(-out, 1.6f, -in), vec3_of(-in, 1.9f, in), cloth);
    add_solid(s, vec3_of(in, 1.6f, -in), vec3_of(out, 1.9f, in), cloth);
    fixture_add_point(s, vec3_of(0, 1.75f, 0), grey(200));
}

static int add_double_sided(struct frame_fixture *s, float albedo)
{
    struct material cloth = material_default();
    cloth.base_color = vec4_of(grey(albedo), 1);
    cloth.metallic = 0;
    cloth.double_sided = true;
    return fixture_material(s, &cloth);
}

void trial_sheet_shade(struct frame_fixture *s, struct gpu *gpu, bool second_view)
{
    begin_furnished_room(s, gpu, second_view);
    const int cloth = add_double_sided(s, 0.4f);
    const float out = 0.3f, low = 1.6f, high = 1.9f;
    const vec3s corner[4] = { vec3_of(-out, 0, -out), vec3_of(out, 0, -out), vec3_of(out, 0, out),
                              vec3_of(-out, 0, out) };
    for (int i = 0; i < 4; i++) { // fronts outwards and inwards in turns
        const vec3s a = corner[(i + i % 2) % 4], b = corner[(i + 1 - i % 2) % 4];
        fixture_quad(s, vec3_of(a.x, low, a.z), vec3_of(b.x, low, b.z), vec3_of(b.x, high, b.z),
                     vec3_of(a.x, high, a.z), cloth);
    }
    fixture_add_point(s, vec3_of(0, 1.75f, 0), grey(200));
}

// Before the wall at x = −3.
static void add_curtain(struct frame_fixture *s, float gap, int material)
{
    const float x = -3 + gap;
    fixture_quad(s, vec3_of(x, 0.1f, 1), vec3_of(x, 0.1f, -1), vec3_of(x, 2.3f, -1),
                 vec3_of(x, 2.3f, 1), material);
}

void trial_curtain(struct frame_fixture *s, struct gpu *gpu, bool second_view)
{
    begin_furnished_room(s, gpu, second_view);
    add_curtain(s, 0.1f, add_double_sided(s, 0.6f));
    fixture_add_point(s, vec3_of(1, 2.4f, 1.2f), grey(200));
}

static void add_horizontal(struct frame_fixture *s, vec2s min, vec2s max, float y, int material)
{
    fixture_quad(s, vec3_of(min.x, y, max.y), vec3_of(max.x, y, max.y), vec3_of(max.x, y, min.y),
                 vec3_of(min.x, y, min.y), material);
}

void trial_sheets(struct frame_fixture *s, struct gpu *gpu, bool second_view)
{
    begin_furnished_room(s, gpu, second_view);
    const int cloth = add_double_sided(s, 0.6f), wood = add_double_sided(s, 0.4f);
    add_curtain(s, 0.08f, cloth);
    add_horizontal(s, (vec2s){ { -1, -0.9f } }, (vec2s){ { 2.2f, 0.9f } }, 0.03f, cloth); // rug
    add_horizontal(s, (vec2s){ { 0, -0.4f } }, (vec2s){ { 1.6f, 0.4f } }, 0.7f, wood);
    add_horizontal(s, (vec2s){ { 0.4f, -0.3f } }, (vec2s){ { 1.2f, 0.3f } }, 0.76f, cloth);
    // Seat, cushion, back and arms of a sofa.
    fixture_box(s, vec3_of(-1.2f, 0.1f, -2.9f), vec3_of(1.2f, 0.4f, -2), false, cloth);
    add_horizontal(s, (vec2s){ { -1, -2.6f } }, (vec2s){ { 1, -2 } }, 0.47f, cloth);
    fixture_box(s, vec3_of(-1.2f, 0.4f, -2.9f), vec3_of(1.2f, 0.9f, -2.7f), false, cloth);
    fixture_box(s, vec3_of(-1.25f, 0.1f, -2.9f), vec3_of(-1.15f, 0.6f, -2), false, cloth);
    fixture_box(s, vec3_of(1.15f, 0.1f, -2.9f), vec3_of(1.25f, 0.6f, -2), false, cloth);
    fixture_add_point(s, vec3_of(1, 2.4f, 1.2f), grey(200));
}

void trial_lined_room(struct frame_fixture *s, struct gpu *gpu, float gap)
{
    fixture_init(s, gpu);
    s->options.shadow_size = 1024;
    const int wall = add_double_sided(s, 0.5f);
    const int walls[6] = { wall, wall, wall, wall, wall, wall };
    const vec3s min = vec3_of(-3, 0, -3), max = vec3_of(3, 3, 3), gaps = vec3_of(gap, gap, gap);
    add_walls(s, min, max, walls);
    if (gap > 0) add_walls(s, glms_vec3_sub(min, gaps), glms_vec3_add(max, gaps), walls);
    fixture_add_point(s, vec3_of(1, 2.4f, 1.2f), grey(200));
    fixture_look(s, vec3_of(2.7f, 1.7f, 2.7f), vec3_of(-1.5f, 1, -2));
}

void trial_wall_before_slab(struct frame_fixture *s, struct gpu *gpu, float gap)
{
    fixture_init(s, gpu);
    s->options.shadow_size = 1024;
    s->options.rsm_size = 256;
    const int white = fixture_matte(s, grey(0.7f)),
              green = fixture_matte(s, vec3_of(0.05f, 0.6f, 0.05f));
    const int materials[6] = { gap > 0 ? white : green, white, white, white, white, white };
    add_walls(s, vec3_of(-2, 0, -2), vec3_of(2, 3, 2), materials);
    if (gap > 0)
        fixture_quad(s, vec3_of(-2 + gap, 0, 2), vec3_of(-2 + gap, 0, -2), vec3_of(-2 + gap, 3, -2),
                     vec3_of(-2 + gap, 3, 2), green);
    fixture_add_point(s, vec3_of(1, 1.5f, 0), grey(100));
    fixture_look(s, vec3_of(-1.4f, 2, 0), vec3_of(-1.4f, 0, -0.1f));
}

int trial_add_movable_box(struct frame_fixture *s, vec3s center, float size, int material)
{
    const vec3s half = vec3_of(0.5f * size, 0.5f * size, 0.5f * size);
    fixture_box(s, glms_vec3_sub(center, half), glms_vec3_add(center, half), false, material);
    const int first = s->scene->instance_count - 6;
    for (int i = first; i < s->scene->instance_count; i++) s->scene->instances[i].movable = true;
    return first;
}
