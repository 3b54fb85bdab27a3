// @planter: a planter in the shade of an arcade, beside a sunlit red drape, after the planter and
// the floor of Martin 2012, sections 5.5 and 5.6. Shows one-sided indirect light on fine geometry
// (flutes, leaves) and grid artefacts on a plain floor. The cameras are `main` (the planter) and
// `floor`.
//
// The aisle lies behind the arcade, at z < 0, closed by walls and a ceiling; sunlight enters
// through the one open arch and falls on the drape and on the floor in front of it. All solids are
// closed.
#include "scene/builtin/parts.h"
#include "scene/builtin/textures.h"

#include <math.h>

struct planter_options {
#define OPTION OPTION_FIELD
#include "planter_options.def"
#undef OPTION
};

#define OPTION(...) OPTION_ROW(struct planter_options, __VA_ARGS__)
static const struct option_row rows[] = {
#include "planter_options.def"
};
#undef OPTION

enum planter_material { WALL, STONE, FLOOR, PLASTER, CLOTH, TERRACOTTA, SOIL, LEAF, MATERIALS };

// Metres. The bays of the arcade are along x around the open one, its columns at z = 0.
static const float BAY = 3.6f, END = 4.8f, BACK = -3.4f, YARD = 3.0f, CEILING = 4.7f;
static const float ARCH_FOOT = 2.7f, ARCH_RADIUS = 1.52f, DRAPE_X = -2.2f;
static const vec3s POT = { { 2.15f, 0.30f, -2.0f } }; // on its plinth

static bool build_materials(struct scene *scene, const struct planter_options *options,
                            int *materials)
{
    static const struct painted painted[] = {
        [WALL] = { "wall", paint_bricks, 1.6f, { { 1, 1, 1 } }, 0.95f },
        [STONE] = { "stone", paint_stone, 1.5f, { { 1, 1, 1 } }, 0.8f },
        [FLOOR] = { "floor", paint_tiles, 1.5f, { { 1, 1, 1 } }, 0.45f },
        [PLASTER] = { "plaster", paint_plaster, 2.0f, { { 1, 1, 1 } }, 0.95f },
        [CLOTH] = { "red cloth", paint_cloth, 0.7f, { { 0.62f, 0.045f, 0.035f } }, 0.9f },
        [TERRACOTTA] = { "terracotta", paint_stone, 1.0f, { { 0.95f, 0.62f, 0.45f } }, 0.7f },
    };
    // About the mean colours of the textures.
    static const vec3s plain[MATERIALS] = {
        [WALL] = { { 0.45f, 0.38f, 0.29f } },    [STONE] = { { 0.58f, 0.53f, 0.45f } },
        [FLOOR] = { { 0.41f, 0.34f, 0.28f } },   [PLASTER] = { { 0.74f, 0.71f, 0.63f } },
        [CLOTH] = { { 0.52f, 0.038f, 0.029f } }, [TERRACOTTA] = { { 0.55f, 0.33f, 0.20f } },
        [SOIL] = { { 0.07f, 0.05f, 0.035f } },   [LEAF] = { { 0.10f, 0.26f, 0.06f } },
    };
    static const char *const names[MATERIALS] = { "wall",      "stone",      "floor", "plaster",
                                                  "red cloth", "terracotta", "soil",  "leaf" };
    for (int m = 0; m < MATERIALS; m++) {
        materials[m] = m <= TERRACOTTA && options->textures
                           ? builtin_painted(scene, &painted[m], options->texels)
                           : builtin_diffuse(scene, names[m], plain[m]);
        if (materials[m] < 0) return false;
    }
    return true;
}

// ---- building

// Floor, ceiling, back and end walls. They overlap, so that no two visible faces are coplanar.
static bool build_shell(struct scene *scene, const int *materials)
{
    struct shape_builder builder;
    shape_begin(&builder, scene);
    shape_box(&builder, vec3_of(-END - 0.3f, -0.3f, BACK - 0.3f), vec3_of(END + 0.3f, 0, YARD));
    if (shape_emit(&builder, "floor", materials[FLOOR]) < 0) return false;
    shape_box(&builder, vec3_of(-END - 0.26f, -0.2f, BACK - 0.28f),
              vec3_of(END + 0.26f, CEILING + 0.15f, BACK));
    for (int side = -1; side <= 1; side += 2) {
        float inner = (float)side * END, outer = (float)side * (END + 0.28f);
        shape_box(&builder, vec3_of(fminf(inner, outer), -0.2f, BACK - 0.2f),
                  vec3_of(fmaxf(inner, outer), CEILING + 0.2f, 0.2f));
    }
    // The other bays are closed by walls between the columns.
    for (int side = -1; side <= 1; side += 2) {
        float a = (float)side * (0.5f * BAY - 0.1f), b = (float)side * (END + 0.1f);
        shape_box(&builder, vec3_of(fminf(a, b), -0.1f, -0.14f),
                  vec3_of(fmaxf(a, b), CEILING + 0.1f, 0.14f));
    }
    if (shape_emit(&builder, "walls", materials[WALL]) < 0) return false;
    shape_box(&builder, vec3_of(-END - 0.22f, CEILING, BACK - 0.24f),
              vec3_of(END + 0.22f, CEILING + 0.3f, 0.27f));
    return shape_emit(&builder, "ceiling", materials[PLASTER]) >= 0;
}

static void column(struct shape_builder *builder, vec3s foot)
{
    static const vec2s profile[] = {
        { { 0, 0.12f } },     { { 0.34f, 0.12f } }, { { 0.36f, 0.19f } }, { { 0.29f, 0.27f } },
        { { 0.26f, 0.34f } }, { { 0.27f, 1.2f } },  { { 0.23f, 2.28f } }, { { 0.27f, 2.32f } },
        { { 0.24f, 2.37f } }, { { 0.33f, 2.55f } }, { { 0, 2.55f } },
    };
    shape_lathe(builder, foot, profile, sizeof profile / sizeof *profile, 24);
    shape_box(builder, vec3_of(foot.x - 0.38f, -0.05f, foot.z - 0.38f),
              vec3_of(foot.x + 0.38f, 0.14f, foot.z + 0.38f));
    shape_box(builder, vec3_of(foot.x - 0.36f, 2.53f, foot.z - 0.36f),
              vec3_of(foot.x + 0.36f, ARCH_FOOT, foot.z + 0.36f));
}

static bool build_arcade(struct scene *scene, const int *materials)
{
    struct shape_builder builder;
    shape_begin(&builder, scene);
    for (int k = -1; k <= 1; k += 2) column(&builder, vec3_of((float)k * 0.5f * BAY, 0, 0));
    float half = 0.5f * BAY + 0.2f;
    shape_arch(&builder, vec3_of(-half, ARCH_FOOT, -0.22f), vec3_of(half, CEILING + 0.05f, 0.22f),
               ARCH_RADIUS, ARCH_FOOT + 0.08f, 20);
    // A skirting along the back wall.
    shape_box(&builder, vec3_of(-END - 0.1f, -0.05f, BACK - 0.1f),
              vec3_of(END + 0.1f, 0.18f, BACK + 0.05f));
    return shape_emit(&builder, "arcade", materials[STONE]) >= 0;
}

// ---- drape

// s runs from the arcade to the back wall, t downwards; the front faces +x.
static vec3s drape_at(const void *user, float s, float t)
{
    (void)user;
    float angle = 2.0f * GLM_PIf * 5.0f * s;
    float depth = 0.13f * (0.35f + 0.65f * t);
    float fold = depth * sinf(angle + 0.6f * t) + 0.25f * depth * sinf(1.7f * angle + 1.0f);
    return vec3_of(DRAPE_X + fold, 4.3f - 4.15f * t * (1.0f - 0.01f * sinf(angle)),
                   -0.42f + (BACK + 0.75f) * s);
}

static bool build_drape(struct scene *scene, const int *materials)
{
    struct shape_builder builder;
    shape_begin(&builder, scene);
    struct shape_sheet sheet = { drape_at, NULL, 48, 10, 0.012f, { { 2.65f, 4.15f } } };
    shape_cloth(&builder, &sheet);
    if (shape_emit(&builder, "drape", materials[CLOTH]) < 0) return false;
    // The rod, along z.
    builder.scene_from_shape =
        glms_rotate_x(glms_translate_make(vec3_of(DRAPE_X, 4.32f, BACK - 0.1f)), GLM_PI_2f);
    shape_cylinder(&builder, vec3_of(0, 0, 0), 0.025f, -BACK, 10);
    return shape_emit(&builder, "rod", materials[TERRACOTTA]) >= 0;
}

// ---- planter

enum { FLUTES = 18, AROUND = 6 * FLUTES };

// (radius, height, depth of the flutes), from the foot to the bed of the soil.
static const vec3s POT_PROFILE[] = {
    { { 0.22f, 0.00f, 0 } },     { { 0.30f, 0.00f, 0 } },     { { 0.31f, 0.06f, 0 } },
    { { 0.24f, 0.10f, 0 } },     { { 0.25f, 0.14f, 0.01f } }, { { 0.37f, 0.26f, 0.025f } },
    { { 0.46f, 0.40f, 0.03f } }, { { 0.50f, 0.54f, 0.03f } }, { { 0.50f, 0.64f, 0.02f } },
    { { 0.48f, 0.70f, 0 } },     { { 0.49f, 0.71f, 0 } },     { { 0.56f, 0.76f, 0 } },
    { { 0.57f, 0.84f, 0 } },     { { 0.53f, 0.85f, 0 } },     { { 0.47f, 0.80f, 0 } },
    { { 0.45f, 0.68f, 0 } },
};
enum { RINGS = sizeof POT_PROFILE / sizeof *POT_PROFILE };

static vec3s pot_point(int ring, int step)
{
    const vec3s p = POT_PROFILE[ring];
    float angle = 2.0f * GLM_PIf * (float)(step % AROUND) / (float)AROUND;
    // Wide flutes between narrow ridges.
    float flute = fabsf(cosf(0.5f * (float)FLUTES * angle));
    float radius = p.x - p.z * (1.0f - flute * flute);
    return vec3_of(radius * sinf(angle), p.y, radius * cosf(angle));
}

// Flat shaded.
static void pot(struct shape_builder *builder)
{
    for (int step = 0; step < AROUND; step++) {
        for (int ring = 0; ring + 1 < RINGS; ring++)
            shape_quad(builder, pot_point(ring, step), pot_point(ring, step + 1),
                       pot_point(ring + 1, step + 1), pot_point(ring + 1, step));
        vec3s bottom = vec3_of(0, POT_PROFILE[0].y, 0);
        vec3s bed = vec3_of(0, POT_PROFILE[RINGS - 1].y, 0);
        shape_polygon(builder, (vec3s[]){ bottom, pot_point(0, step + 1), pot_point(0, step) }, 3);
        shape_polygon(builder,
                      (vec3s[]){ bed, pot_point(RINGS - 1, step), pot_point(RINGS - 1, step + 1) },
                      3);
    }
}

// A leaf that rises and bends down: s across, t from the root to the tip.
struct leaf {
    float angle, length;
    float rise, bend; // radians: elevation at the root, and its decrease to the tip
};

static vec3s leaf_at(const void *user, float s, float t)
{
    const struct leaf *leaf = user;
    float side = 2.0f * s - 1.0f;
    float half_width = 0.006f + 0.043f * sinf(GLM_PIf * (0.12f + 0.86f * t)) * (1.0f - 0.3f * t);
    float keel = -0.3f * half_width * (1.0f - side * side);
    // An arc whose slope falls from rise to rise - bend.
    float slope = leaf->rise - leaf->bend * t, scale = leaf->length / leaf->bend;
    float out = 0.06f + scale * (sinf(leaf->rise) - sinf(slope));
    float up = 0.66f + scale * (cosf(slope) - cosf(leaf->rise)) + keel;
    float x = cosf(leaf->angle), z = sinf(leaf->angle), across = side * half_width;
    return vec3_of(out * x - across * z, up, out * z + across * x);
}

static void plant(struct shape_builder *builder)
{
    enum { LEAVES = 26 };
    for (int i = 0; i < LEAVES; i++) {
        float u = (float)i / (float)(LEAVES - 1);
        struct leaf leaf = { .angle = 2.39996f * (float)i, // the golden angle
                             .length = 0.95f - 0.25f * u,
                             .rise = 0.75f + 0.72f * u,
                             .bend = 1.9f - 1.1f * u };
        struct shape_sheet sheet = { leaf_at, &leaf, 4, 12, 0.006f, { { 0.1f, 1 } } };
        shape_cloth(builder, &sheet);
    }
}

static bool build_planter(struct scene *scene, const int *materials)
{
    struct shape_builder builder;
    shape_begin(&builder, scene);
    shape_box(&builder, vec3_of(POT.x - 0.44f, -0.05f, POT.z - 0.44f),
              vec3_of(POT.x + 0.44f, 0.12f, POT.z + 0.44f));
    shape_box(&builder, vec3_of(POT.x - 0.38f, 0.1f, POT.z - 0.38f),
              vec3_of(POT.x + 0.38f, POT.y + 0.01f, POT.z + 0.38f));
    if (shape_emit(&builder, "plinth", materials[STONE]) < 0) return false;
    builder.scene_from_shape = glms_translate_make(POT);
    pot(&builder);
    if (shape_emit(&builder, "planter", materials[TERRACOTTA]) < 0) return false;
    shape_cylinder(&builder, vec3_of(0, 0.6f, 0), 0.449f, 0.11f, 48);
    if (shape_emit(&builder, "soil", materials[SOIL]) < 0) return false;
    plant(&builder);
    return shape_emit(&builder, "plant", materials[LEAF]) >= 0;
}

// ---- light and cameras

static bool build_sun(struct scene *scene, const struct planter_options *options)
{
    float elevation = glm_rad(options->elevation), azimuth = glm_rad(options->azimuth);
    vec3s direction = vec3_of(-cosf(elevation) * sinf(azimuth), -sinf(elevation),
                              -cosf(elevation) * cosf(azimuth));
    return builtin_sun(scene, "sun", vec3_of(3, 8, 6), direction,
                       glms_vec3_scale(vec3_of(1.0f, 0.93f, 0.82f), options->sun));
}

static bool build_scene(struct scene *scene, const void *options)
{
    const struct planter_options *o = options;
    int materials[MATERIALS];
    return build_materials(scene, o, materials) && build_shell(scene, materials) &&
           build_arcade(scene, materials) && build_drape(scene, materials) &&
           build_planter(scene, materials) && build_sun(scene, o) &&
           builtin_camera(scene, "main", vec3_of(3.5f, 1.7f, -0.3f), vec3_of(1.45f, 0.9f, -2.15f),
                          glm_rad(50.0f)) &&
           builtin_camera(scene, "floor", vec3_of(0.1f, 1.7f, -2.45f), vec3_of(0.1f, 0, -2.45f),
                          glm_rad(45.0f));
}

const struct builtin_scene builtin_planter = {
    .name = "planter",
    .title = "a planter in a shaded arcade, lit indirectly by a sunlit drape",
    .options = OPTION_TABLE(struct planter_options, rows, NULL),
    .build = build_scene,
};
