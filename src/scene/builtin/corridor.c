// @corridor: two crossing corridors with a bright sphere light at the crossing, similar to the
// corridor scene of Giuffrida 2016, section 6.2. Each of the four arms ends in a niche around a
// corner, which light reaches only after several bounces. The end wall of each arm has a colour of
// its own.
#include "scene/builtin/movable_objects.h"
#include "scene/builtin/parts.h"

#include <math.h>

struct corridor_options {
#define OPTION OPTION_FIELD
#include "corridor_options.def"
#undef OPTION
};

#define OPTION(...) OPTION_ROW(struct corridor_options, __VA_ARGS__)
static const struct option_row rows[] = {
#include "corridor_options.def"
};
#undef OPTION

static const float WALL = 0.3f;

// Planes along x and z, symmetric: outer face, end of an arm, start of its niche, end of the niche
// of the other corridor, side of the corridor.
enum { PLANES = 10, CELLS = PLANES - 1 };
enum part { FLOOR = 1, CEILING, WALLS, RED, GREEN, BLUE, YELLOW, PART_COUNT };

static void lay_planes(const struct corridor_options *o, float plane[PLANES])
{
    float half = 0.5f * o->length, side = 0.5f * o->width;
    const float positive[PLANES / 2] = { side, side + 1.2f * o->width, half - o->width, half,
                                         half + WALL };
    for (int i = 0; i < PLANES / 2; i++) {
        plane[PLANES / 2 + i] = positive[i];
        plane[PLANES / 2 - 1 - i] = -positive[i];
    }
}

// Whether a cell of the plan is in the arm along +x or in its niche towards +z.
static bool in_arm(int i, int k)
{
    bool along = i >= 4 && i <= 7 && k == 4;
    return along || (i == 7 && k == 5);
}

// The other arms are the first one rotated by right angles.
static bool is_empty(int i, int k)
{
    for (int quarter = 0; quarter < 4; quarter++) {
        if (in_arm(i, k)) return true;
        int rotated = CELLS - 1 - k;
        k = i;
        i = rotated;
    }
    return false;
}

static int corridor_part(const void *user, int i, int j, int k)
{
    (void)user;
    if (j == 0) return FLOOR;
    if (j == 2) return CEILING;
    if (is_empty(i, k)) return 0;
    if (i == CELLS - 1) return RED;
    if (k == CELLS - 1) return GREEN;
    if (i == 0) return BLUE;
    if (k == 0) return YELLOW;
    return WALLS;
}

static bool build_rooms(struct scene *scene, const struct corridor_options *o)
{
    static const struct {
        const char *name;
        vec3s colour;
    } parts[PART_COUNT] = {
        [FLOOR] = { "floor", { { 0.38f, 0.33f, 0.28f } } },
        [CEILING] = { "ceiling", { { 0.78f, 0.78f, 0.76f } } },
        [WALLS] = { "walls", { { 0.72f, 0.70f, 0.66f } } },
        [RED] = { "red end", { { 0.75f, 0.12f, 0.10f } } },
        [GREEN] = { "green end", { { 0.15f, 0.55f, 0.14f } } },
        [BLUE] = { "blue end", { { 0.12f, 0.22f, 0.70f } } },
        [YELLOW] = { "yellow end", { { 0.75f, 0.60f, 0.12f } } },
    };
    float plane[PLANES];
    lay_planes(o, plane);
    const float up[4] = { -WALL, 0, o->height, o->height + WALL };
    struct shape_grid grid = { plane, up, plane, CELLS, 3, CELLS, corridor_part, NULL };
    struct shape_builder builder;
    shape_begin(&builder, scene);
    for (int part = FLOOR; part < PART_COUNT; part++) {
        int material = builtin_diffuse(scene, parts[part].name, parts[part].colour);
        if (material < 0) return false;
        shape_blocks(&builder, &grid, part);
        if (shape_emit(&builder, parts[part].name, material) < 0) return false;
    }
    return true;
}

// Pillars along the walls and a beam over each pair: shadow edges along the arms.
static bool build_ribs(struct scene *scene, const struct corridor_options *o)
{
    int material = builtin_diffuse(scene, "ribs", vec3_of(0.55f, 0.50f, 0.44f));
    if (material < 0) return false;
    struct shape_builder builder;
    shape_begin(&builder, scene);
    float side = 0.5f * o->width, from = side + 0.9f, to = 0.5f * o->length - o->width - 0.3f;
    float depth = 0.14f, width = 0.35f, beam = o->height - 0.25f;
    int count = (int)((to - from) / 2.2f) + 1;
    for (int quarter = 0; quarter < 4; quarter++) {
        builder.scene_from_shape = glms_rotate_y(glms_mat4_identity(), GLM_PI_2f * (float)quarter);
        for (int r = 0; r < count; r++) {
            float x = from + 2.2f * (float)r;
            shape_box(&builder, vec3_of(x, 0, -side), vec3_of(x + width, beam, -side + depth));
            shape_box(&builder, vec3_of(x, 0, side - depth), vec3_of(x + width, beam, side));
            shape_box(&builder, vec3_of(x, beam, -side), vec3_of(x + width, o->height, side));
        }
    }
    return shape_emit(&builder, "ribs", material) >= 0;
}

// Crates in the arms, away from the walls so that light passes on both sides.
static bool build_crates(struct scene *scene, const struct corridor_options *o)
{
    static const vec3s colours[4] = { { { 0.55f, 0.38f, 0.20f } },
                                      { { 0.60f, 0.60f, 0.62f } },
                                      { { 0.70f, 0.30f, 0.45f } },
                                      { { 0.25f, 0.50f, 0.50f } } };
    static const char *const names[4] = { "wooden crate", "grey crate", "pink crate",
                                          "teal crate" };
    struct shape_builder builder;
    shape_begin(&builder, scene);
    for (int quarter = 0; quarter < 4; quarter++) {
        int material = builtin_diffuse(scene, names[quarter], colours[quarter]);
        if (material < 0) return false;
        float along = 0.5f * o->length - 1.35f * o->width, edge = 0.5f + 0.1f * (float)quarter;
        mat4s turn = glms_rotate_y(glms_mat4_identity(), GLM_PI_2f * (float)quarter + 0.35f);
        vec3s place = mat4_point(glms_rotate_y(glms_mat4_identity(), GLM_PI_2f * (float)quarter),
                                 vec3_of(along, 0, -0.15f * o->width));
        builder.scene_from_shape = glms_mat4_mul(glms_translate_make(place), turn);
        float half = 0.5f * edge;
        shape_box(&builder, vec3_of(-half, 0, -half), vec3_of(half, edge, half));
        if (shape_emit(&builder, names[quarter], material) < 0) return false;
    }
    return true;
}

// Between the crossing and the niche of the arm along +x. The camera sees the floor and a wall on
// both sides of it.
static bool build_object(struct scene *scene, const struct corridor_options *o)
{
    const float along = 0.25f * (o->length - o->width);
    const struct movable_object object = { .centre = { { along, 0.75f, 0 } },
                                           .radius = 0.5f,
                                           .height = 1.5f,
                                           .wave = 0.3f,
                                           .cycles = 2,
                                           .reflectance = { { 0.15f, 0.35f, 0.85f } } };
    return movable_object_add(scene, &object) &&
           builtin_camera(scene, "object",
                          vec3_of(along + 1.1f, o->height - 0.2f, 0.5f * o->width - 0.2f),
                          vec3_of(along - 0.15f, 0.2f, -0.2f * o->width), glm_rad(75.0f));
}

static bool build_corridor(struct scene *scene, const void *options)
{
    const struct corridor_options *o = options;
    vec3s middle = vec3_of(0, 0.55f * o->height, 0);
    vec3s camera = vec3_of(0.36f * o->length, 1.6f, 0.25f * o->width);
    return build_rooms(scene, o) && build_ribs(scene, o) && build_crates(scene, o) &&
           builtin_sphere_light(scene, middle, o->light == 1, o->lumens) &&
           builtin_camera(scene, "main", camera, vec3_of(0, 1.4f, -0.1f * o->width),
                          glm_rad(60.0f)) &&
           (!o->object || build_object(scene, o));
}

const struct builtin_scene builtin_corridor = {
    .name = "corridor",
    .title = "two crossing corridors with one bright sphere light in the middle",
    .options = OPTION_TABLE(struct corridor_options, rows, NULL),
    .build = build_corridor,
};
