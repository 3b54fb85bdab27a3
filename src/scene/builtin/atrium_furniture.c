// Drapes and furniture of @atrium: curtains, banners, swags over the courtyard, a fountain, urns, a
// brass sphere.
#include "scene/builtin/atrium.h"

#include <math.h>

// Cloth on a rod, with folds that deepen downwards.
struct drape {
    vec3s corner; // upper left; the front faces +z
    float width, length;
    float waves, depth, phase;
};

static vec3s drape_at(const void *user, float s, float t)
{
    const struct drape *drape = user;
    float angle = 2.0f * GLM_PIf * (drape->waves * s) + drape->phase;
    // Folds drift sideways downwards; the hem rises where a fold comes forward.
    float depth = drape->depth * (0.35f + 0.65f * t);
    float z = depth * sinf(angle + 0.7f * t) + 0.25f * depth * sinf(1.7f * angle + 1.0f);
    float gather = 1.0f - 0.06f * sinf(GLM_PIf * t);
    float x = 0.5f * drape->width + (s - 0.5f) * drape->width * gather;
    float y = -t * drape->length * (1.0f - 0.02f * sinf(angle));
    return glms_vec3_add(drape->corner, vec3_of(x, y, z));
}

// Cloth that spans the courtyard, fixed at both ends and sagging between.
struct swag {
    vec3s middle; // of the line between the ends
    float half_span, width, sag, phase;
};

// s runs across the courtyard along +z, t along +x; the front faces down.
static vec3s swag_at(const void *user, float s, float t)
{
    const struct swag *swag = user;
    float along = 2.0f * s - 1.0f, across = t - 0.5f;
    float sag = swag->sag * (1.0f - along * along);
    float ripple = 0.12f * (1.0f - 0.6f * along * along) *
                   sinf(2.0f * GLM_PIf * 2.5f * t + 1.3f * along + swag->phase);
    float width = swag->width * (0.72f + 0.28f * (1.0f - along * along));
    return glms_vec3_add(swag->middle,
                         vec3_of(across * width, ripple - sag, along * swag->half_span));
}

static void hang(struct shape_builder *builder, const struct drape *drape, int columns, int rows)
{
    struct shape_sheet sheet = { drape_at, drape,  columns,
                                 rows,     0.012f, { { drape->width, drape->length } } };
    shape_cloth(builder, &sheet);
}

// A curtain or banner: bay of the colonnade, side (sign of z), material.
struct curtained_bay {
    int bay, side, material;
};

static const struct curtained_bay CURTAINS[] = {
    { 1, -1, ATRIUM_RED }, { 3, -1, ATRIUM_GREEN }, { 5, -1, ATRIUM_BLUE }, { 6, -1, ATRIUM_RED },
    { 2, 1, ATRIUM_BLUE }, { 4, 1, ATRIUM_RED },    { 6, 1, ATRIUM_GREEN },
};
// Banners over the balustrade, on the side of the courtyard.
static const struct curtained_bay BANNERS[] = {
    { 2, -1, ATRIUM_BLUE }, { 4, -1, ATRIUM_RED }, { 7, -1, ATRIUM_GREEN },
    { 1, 1, ATRIUM_GREEN }, { 3, 1, ATRIUM_BLUE }, { 5, 1, ATRIUM_RED },
};
enum {
    CURTAIN_COUNT = sizeof CURTAINS / sizeof *CURTAINS,
    BANNER_COUNT = sizeof BANNERS / sizeof *BANNERS
};

static void hang_curtain(struct shape_builder *builder, const struct curtained_bay *at, int index)
{
    float from = atrium_column_x(at->bay) + 0.34f;
    struct drape drape = { .corner = vec3_of(from, ATRIUM_ARCH_LOW + 0.02f,
                                             (float)at->side * (ATRIUM_COLONNADE + 0.1f)),
                           .width = ATRIUM_BAY - 0.68f,
                           .length = 2.35f,
                           .waves = 4.0f,
                           .depth = 0.13f,
                           .phase = 1.7f * (float)index };
    hang(builder, &drape, 28, 6);
}

static void hang_banner(struct shape_builder *builder, const struct curtained_bay *at, int index)
{
    float from = atrium_column_x(at->bay) + 0.75f;
    struct drape drape = { .corner = vec3_of(from, ATRIUM_GALLERY + 0.8f,
                                             (float)at->side * (ATRIUM_COLONNADE - 0.58f)),
                           .width = ATRIUM_BAY - 1.5f,
                           .length = 2.3f,
                           .waves = 2.5f,
                           .depth = 0.08f,
                           .phase = 2.1f * (float)index };
    hang(builder, &drape, 14, 8);
}

static void hang_swag(struct shape_builder *builder, int index)
{
    struct swag swag = { .middle = vec3_of(-6.0f + 6.0f * (float)index, ATRIUM_ROOF - 0.7f, 0),
                         .half_span = ATRIUM_COLONNADE - 0.2f,
                         .width = 1.5f,
                         .sag = 1.5f,
                         .phase = 2.0f * (float)index };
    struct shape_sheet sheet = { swag_at, &swag, 18, 10, 0.012f, { { 7.0f, 1.5f } } };
    shape_cloth(builder, &sheet);
}

static bool build_cloth(struct scene *scene, const char *name, int which, int material)
{
    struct shape_builder builder;
    shape_begin(&builder, scene);
    for (int i = 0; i < CURTAIN_COUNT; i++) {
        if (CURTAINS[i].material == which) hang_curtain(&builder, &CURTAINS[i], i);
    }
    for (int i = 0; i < BANNER_COUNT; i++) {
        if (BANNERS[i].material == which) hang_banner(&builder, &BANNERS[i], i);
    }
    hang_swag(&builder, which - ATRIUM_RED);
    return shape_emit(&builder, name, material) >= 0;
}

// A rod along +x.
static void rod(struct shape_builder *builder, vec3s from, float length)
{
    builder->scene_from_shape = glms_rotate_z(glms_translate_make(from), -GLM_PI_2f);
    shape_cylinder(builder, vec3_of(0, 0, 0), 0.02f, length, 8);
    builder->scene_from_shape = glms_mat4_identity();
}

static bool build_rods(struct scene *scene, int material)
{
    struct shape_builder builder;
    shape_begin(&builder, scene);
    for (int i = 0; i < CURTAIN_COUNT; i++) {
        rod(&builder,
            vec3_of(atrium_column_x(CURTAINS[i].bay), ATRIUM_ARCH_LOW + 0.04f,
                    (float)CURTAINS[i].side * (ATRIUM_COLONNADE + 0.1f)),
            ATRIUM_BAY);
    }
    for (int i = 0; i < BANNER_COUNT; i++) {
        rod(&builder,
            vec3_of(atrium_column_x(BANNERS[i].bay) + 0.6f, ATRIUM_GALLERY + 0.81f,
                    (float)BANNERS[i].side * (ATRIUM_COLONNADE - 0.58f)),
            ATRIUM_BAY - 1.2f);
    }
    return shape_emit(&builder, "rods", material) >= 0;
}

bool atrium_drapes(struct scene *scene, const int *materials)
{
    return build_cloth(scene, "red drapes", ATRIUM_RED, materials[ATRIUM_RED]) &&
           build_cloth(scene, "green drapes", ATRIUM_GREEN, materials[ATRIUM_GREEN]) &&
           build_cloth(scene, "blue drapes", ATRIUM_BLUE, materials[ATRIUM_BLUE]) &&
           build_rods(scene, materials[ATRIUM_BRASS]);
}

static const vec3s FOUNTAIN = { { 1.5f, 0, 0 } };

static bool build_fountain(struct scene *scene, const int *materials)
{
    static const vec2s basin[] = {
        { { 0, -0.05f } },    { { 1.45f, -0.05f } }, { { 1.45f, 0.12f } }, { { 1.30f, 0.16f } },
        { { 1.24f, 0.42f } }, { { 1.36f, 0.48f } },  { { 1.36f, 0.56f } }, { { 1.12f, 0.56f } },
        { { 1.12f, 0.25f } }, { { 0, 0.25f } },
    };
    static const vec2s bowl[] = {
        { { 0, 0.2f } },      { { 0.28f, 0.2f } },  { { 0.15f, 0.38f } }, { { 0.11f, 0.80f } },
        { { 0.17f, 0.92f } }, { { 0.48f, 1.06f } }, { { 0.66f, 1.26f } }, { { 0.60f, 1.28f } },
        { { 0.42f, 1.14f } }, { { 0.10f, 1.08f } }, { { 0.06f, 1.40f } }, { { 0, 1.44f } },
    };
    struct shape_builder builder;
    shape_begin(&builder, scene);
    shape_lathe(&builder, FOUNTAIN, basin, sizeof basin / sizeof *basin, 32);
    shape_lathe(&builder, FOUNTAIN, bowl, sizeof bowl / sizeof *bowl, 24);
    if (shape_emit(&builder, "fountain", materials[ATRIUM_STONE]) < 0) return false;
    shape_cylinder(&builder, vec3_of(FOUNTAIN.x, 0.24f, FOUNTAIN.z), 1.14f, 0.24f, 32);
    return shape_emit(&builder, "water", materials[ATRIUM_WATER]) >= 0;
}

enum { URNS = 6 };
static const float URN_POSITIONS[URNS][2] = { { -7.5f, -2.3f }, { -4.0f, 2.3f }, { -1.5f, -2.3f },
                                              { 4.5f, 2.3f },   { 6.0f, -2.3f }, { 9.0f, 2.3f } };

static bool build_urns(struct scene *scene, const int *materials)
{
    static const vec2s urn[] = {
        { { 0, 0 } },         { { 0.20f, 0 } },     { { 0.20f, 0.05f } }, { { 0.08f, 0.11f } },
        { { 0.12f, 0.20f } }, { { 0.29f, 0.48f } }, { { 0.31f, 0.62f } }, { { 0.20f, 0.82f } },
        { { 0.17f, 0.88f } }, { { 0.26f, 0.98f } }, { { 0.21f, 0.98f } }, { { 0.12f, 0.86f } },
        { { 0, 0.84f } },
    };
    struct shape_builder builder;
    shape_begin(&builder, scene);
    for (int i = 0; i < URNS; i++) {
        shape_lathe(&builder, vec3_of(URN_POSITIONS[i][0], 0.45f, URN_POSITIONS[i][1]), urn,
                    sizeof urn / sizeof *urn, 16);
    }
    if (shape_emit(&builder, "urns", materials[ATRIUM_TERRACOTTA]) < 0) return false;
    for (int i = 0; i < URNS; i++) {
        float x = URN_POSITIONS[i][0], z = URN_POSITIONS[i][1];
        shape_box(&builder, vec3_of(x - 0.34f, -0.05f, z - 0.34f),
                  vec3_of(x + 0.34f, 0.08f, z + 0.34f));
        shape_box(&builder, vec3_of(x - 0.27f, 0.04f, z - 0.27f),
                  vec3_of(x + 0.27f, 0.46f, z + 0.27f));
    }
    return shape_emit(&builder, "plinths", materials[ATRIUM_STONE]) >= 0;
}

// On the fountain's spout.
static bool build_ball(struct scene *scene, const int *materials)
{
    struct shape_builder builder;
    shape_begin(&builder, scene);
    shape_sphere(&builder, vec3_of(FOUNTAIN.x, 1.6f, FOUNTAIN.z), 0.2f, 24);
    return shape_emit(&builder, "brass ball", materials[ATRIUM_BRASS]) >= 0;
}

bool atrium_furniture(struct scene *scene, const int *materials)
{
    return build_fountain(scene, materials) && build_urns(scene, materials) &&
           build_ball(scene, materials);
}
