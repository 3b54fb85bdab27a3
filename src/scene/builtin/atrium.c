// @atrium: a colonnaded two-storey courtyard, open to the sky, for the same tests as Sponza:
// sunlight falls on the floor, one long wall and coloured cloth; aisles and gallery receive
// indirect light only. All solids are closed and have thickness.
#include "scene/builtin/atrium.h"
#include "scene/builtin/textures.h"

#include <math.h>

struct atrium_options {
#define OPTION OPTION_FIELD
#include "atrium_options.def"
#undef OPTION
};

#define OPTION(...) OPTION_ROW(struct atrium_options, __VA_ARGS__)
static const struct option_row rows[] = {
#include "atrium_options.def"
};
#undef OPTION

static const float WALL = 0.5f, FLOOR_DEPTH = 0.4f;

static bool build_materials(struct scene *scene, int texels, int *materials)
{
    static const struct painted painted[] = {
        [ATRIUM_WALL] = { "wall", paint_bricks, 1.6f, { { 1, 1, 1 } }, 0.95f },
        [ATRIUM_STONE] = { "stone", paint_stone, 1.5f, { { 1, 1, 1 } }, 0.8f },
        [ATRIUM_FLOOR] = { "floor", paint_tiles, 1.5f, { { 1, 1, 1 } }, 0.45f },
        [ATRIUM_PLASTER] = { "plaster", paint_plaster, 2.0f, { { 1, 1, 1 } }, 0.95f },
        [ATRIUM_WOOD] = { "wood", paint_wood, 1.2f, { { 1, 1, 1 } }, 0.6f },
        [ATRIUM_RED] = { "red cloth", paint_cloth, 0.7f, { { 0.62f, 0.045f, 0.035f } }, 0.9f },
        [ATRIUM_GREEN] = { "green cloth", paint_cloth, 0.7f, { { 0.06f, 0.34f, 0.07f } }, 0.9f },
        [ATRIUM_BLUE] = { "blue cloth", paint_cloth, 0.7f, { { 0.05f, 0.13f, 0.52f } }, 0.9f },
        [ATRIUM_TERRACOTTA] = { "terracotta", paint_stone, 1.0f, { { 0.95f, 0.5f, 0.32f } }, 0.7f },
    };
    for (int m = 0; m <= ATRIUM_TERRACOTTA; m++) {
        materials[m] = builtin_painted(scene, &painted[m], texels);
        if (materials[m] < 0) return false;
    }
    struct material brass = material_default();
    brass.name = "brass";
    brass.base_color = (vec4s){ { 0.88f, 0.66f, 0.33f, 1 } };
    brass.metallic = 1.0f;
    brass.roughness = 0.3f;
    materials[ATRIUM_BRASS] = scene_add_material(scene, &brass);
    struct material water = material_default();
    water.name = "water";
    water.base_color = (vec4s){ { 0.03f, 0.07f, 0.07f, 1 } };
    water.roughness = 0.08f;
    materials[ATRIUM_WATER] = scene_add_material(scene, &water);
    return materials[ATRIUM_BRASS] >= 0 && materials[ATRIUM_WATER] >= 0;
}

// Walls, floor and roof overlap, so that no light leaks at their edges and no two visible faces are
// coplanar.
static bool build_shell(struct scene *scene, const int *materials)
{
    struct shape_builder builder;
    shape_begin(&builder, scene);
    float length = ATRIUM_HALF_LENGTH, width = ATRIUM_HALF_WIDTH;
    shape_box(&builder, vec3_of(-length - WALL, -FLOOR_DEPTH, -width - WALL),
              vec3_of(length + WALL, 0, width + WALL));
    if (shape_emit(&builder, "floor", materials[ATRIUM_FLOOR]) < 0) return false;
    for (int side = -1; side <= 1; side += 2) {
        float near_z = side > 0 ? width : -width - WALL;
        shape_box(&builder, vec3_of(-length - 0.96f * WALL, -0.2f, near_z + 0.02f),
                  vec3_of(length + 0.96f * WALL, ATRIUM_ROOF + 0.2f, near_z + WALL - 0.02f));
        float near_x = side > 0 ? length : -length - 0.9f * WALL;
        shape_box(&builder, vec3_of(near_x, -0.2f, -width - 0.5f * WALL),
                  vec3_of(near_x + 0.9f * WALL, ATRIUM_ROOF + 1.2f, width + 0.5f * WALL));
    }
    return shape_emit(&builder, "walls", materials[ATRIUM_WALL]) >= 0;
}

// Gallery floors, aisle roofs, and the mouldings along their edges over the courtyard.
static bool build_slabs(struct scene *scene, const int *materials)
{
    struct shape_builder builder;
    shape_begin(&builder, scene);
    float end = ATRIUM_HALF_LENGTH + 0.2f, edge = ATRIUM_COLONNADE - 0.4f;
    float into_wall = ATRIUM_HALF_WIDTH + 0.3f;
    for (int half_turns = 0; half_turns < 2; half_turns++) {
        builder.scene_from_shape = glms_rotate_y(glms_mat4_identity(), GLM_PIf * (float)half_turns);
        shape_box(&builder, vec3_of(-end, ATRIUM_GALLERY - 0.3f, edge),
                  vec3_of(end, ATRIUM_GALLERY, into_wall));
        shape_box(&builder, vec3_of(-end, ATRIUM_ROOF, edge - 0.1f),
                  vec3_of(end, ATRIUM_ROOF + 0.4f, into_wall + 0.4f));
    }
    if (shape_emit(&builder, "slabs", materials[ATRIUM_PLASTER]) < 0) return false;
    for (int half_turns = 0; half_turns < 2; half_turns++) {
        builder.scene_from_shape = glms_rotate_y(glms_mat4_identity(), GLM_PIf * (float)half_turns);
        shape_box(&builder, vec3_of(-end, ATRIUM_GALLERY - 0.16f, edge - 0.1f),
                  vec3_of(end, ATRIUM_GALLERY + 0.06f, edge + 0.2f));
        shape_box(&builder, vec3_of(-end, ATRIUM_ROOF + 0.22f, edge - 0.25f),
                  vec3_of(end, ATRIUM_ROOF + 0.5f, edge + 0.3f));
    }
    return shape_emit(&builder, "mouldings", materials[ATRIUM_STONE]) >= 0;
}

// A column: a square plinth and abacus, between them a turned shaft with a swelling and a capital.
static void column(struct shape_builder *builder, vec3s foot, float height, float radius,
                   int segments)
{
    const vec2s profile[] = {
        { { 0, 0.10f } },
        { { 1.30f * radius, 0.10f } },
        { { 1.36f * radius, 0.17f } },
        { { 1.10f * radius, 0.25f } },
        { { radius, 0.32f } },
        { { 1.01f * radius, 0.4f * height } },
        { { 0.88f * radius, height - 0.42f } },
        { { 1.02f * radius, height - 0.38f } },
        { { 0.90f * radius, height - 0.33f } },
        { { 1.25f * radius, height - 0.15f } },
        { { 0, height - 0.15f } },
    };
    shape_lathe(builder, foot, profile, sizeof profile / sizeof *profile, segments);
    float half = 1.4f * radius;
    shape_box(builder, vec3_of(foot.x - half, foot.y, foot.z - half),
              vec3_of(foot.x + half, foot.y + 0.12f, foot.z + half));
    half = 1.32f * radius;
    shape_box(builder, vec3_of(foot.x - half, foot.y + height - 0.17f, foot.z - half),
              vec3_of(foot.x + half, foot.y + height, foot.z + half));
}

static bool build_columns(struct scene *scene, const int *materials)
{
    struct shape_builder builder;
    shape_begin(&builder, scene);
    for (int side = -1; side <= 1; side += 2) {
        for (int k = 0; k <= ATRIUM_BAYS; k++) {
            vec3s foot = vec3_of(atrium_column_x(k), 0, (float)side * ATRIUM_COLONNADE);
            column(&builder, foot, ATRIUM_ARCH_LOW, 0.26f, 16);
        }
    }
    if (shape_emit(&builder, "lower columns", materials[ATRIUM_STONE]) < 0) return false;
    for (int side = -1; side <= 1; side += 2) {
        for (int k = 0; k <= ATRIUM_BAYS; k++) {
            vec3s foot =
                vec3_of(atrium_column_x(k), ATRIUM_GALLERY, (float)side * ATRIUM_COLONNADE);
            column(&builder, foot, ATRIUM_ARCH_HIGH - ATRIUM_GALLERY, 0.19f, 12);
        }
    }
    return shape_emit(&builder, "upper columns", materials[ATRIUM_STONE]) >= 0;
}

// Arches from column to column on both storeys, and across the lower aisles from each column to the
// wall.
static bool build_arches(struct scene *scene, const int *materials)
{
    struct shape_builder builder;
    shape_begin(&builder, scene);
    for (int side = -1; side <= 1; side += 2) {
        float z = (float)side * ATRIUM_COLONNADE;
        for (int k = 0; k < ATRIUM_BAYS; k++) {
            float left = atrium_column_x(k), right = atrium_column_x(k + 1);
            shape_arch(&builder, vec3_of(left, ATRIUM_ARCH_LOW, z - 0.3f),
                       vec3_of(right, ATRIUM_GALLERY - 0.25f, z + 0.3f), 1.2f,
                       ATRIUM_ARCH_LOW + 0.1f, 12);
            shape_arch(&builder, vec3_of(left, ATRIUM_ARCH_HIGH, z - 0.2f),
                       vec3_of(right, ATRIUM_ROOF + 0.1f, z + 0.2f), 1.24f,
                       ATRIUM_ARCH_HIGH + 0.08f, 12);
        }
    }
    if (shape_emit(&builder, "arches", materials[ATRIUM_STONE]) < 0) return false;
    float from = ATRIUM_COLONNADE + 0.28f, to = ATRIUM_HALF_WIDTH + 0.2f;
    for (int side = -1; side <= 1; side += 2) {
        for (int k = 1; k < ATRIUM_BAYS; k++) {
            // The arch's local x is the scene's z.
            builder.scene_from_shape = glms_rotate_y(
                glms_translate_make(vec3_of(atrium_column_x(k), 0, 0)), -GLM_PI_2f * (float)side);
            shape_arch(&builder, vec3_of(from, ATRIUM_ARCH_LOW, -0.2f),
                       vec3_of(to, ATRIUM_GALLERY - 0.25f, 0.2f), 1.35f, ATRIUM_ARCH_LOW + 0.02f,
                       10);
        }
    }
    return shape_emit(&builder, "aisle arches", materials[ATRIUM_STONE]) >= 0;
}

static void baluster(struct shape_builder *builder, vec3s foot)
{
    static const vec2s profile[] = { { { 0, 0 } },         { { 0.07f, 0 } },
                                     { { 0.045f, 0.1f } }, { { 0.085f, 0.27f } },
                                     { { 0.04f, 0.55f } }, { { 0.06f, 0.62f } },
                                     { { 0, 0.62f } } };
    shape_lathe(builder, foot, profile, sizeof profile / sizeof *profile, 8);
}

static bool build_balustrade(struct scene *scene, const int *materials)
{
    enum { PER_BAY = 5 };
    struct shape_builder builder;
    shape_begin(&builder, scene);
    float low = ATRIUM_GALLERY + 0.08f, high = ATRIUM_GALLERY + 0.72f;
    for (int side = -1; side <= 1; side += 2) {
        float z = (float)side * ATRIUM_COLONNADE;
        shape_box(&builder, vec3_of(-ATRIUM_HALF_LENGTH - 0.1f, high - 0.04f, z - 0.11f),
                  vec3_of(ATRIUM_HALF_LENGTH + 0.1f, high + 0.12f, z + 0.11f));
        shape_box(&builder, vec3_of(-ATRIUM_HALF_LENGTH - 0.1f, low - 0.12f, z - 0.1f),
                  vec3_of(ATRIUM_HALF_LENGTH + 0.1f, low + 0.02f, z + 0.1f));
        for (int k = 0; k < ATRIUM_BAYS; k++) {
            for (int b = 0; b < PER_BAY; b++) {
                float x = atrium_column_x(k) + ATRIUM_BAY * ((float)b + 0.5f) / (float)PER_BAY;
                baluster(&builder, vec3_of(x, low, z));
            }
        }
    }
    return shape_emit(&builder, "balustrade", materials[ATRIUM_STONE]) >= 0;
}

// A wooden door behind a stone arch in the middle of each end wall.
static bool build_doors(struct scene *scene, const int *materials)
{
    struct shape_builder builder;
    shape_begin(&builder, scene);
    for (int half_turns = 0; half_turns < 2; half_turns++) {
        builder.scene_from_shape =
            glms_rotate_y(glms_mat4_identity(), GLM_PI_2f + GLM_PIf * (float)half_turns);
        float wall = -ATRIUM_HALF_LENGTH;
        shape_arch(&builder, vec3_of(-1.9f, -0.1f, wall - 0.1f), vec3_of(1.9f, 4.2f, wall + 0.35f),
                   1.3f, 2.3f, 16);
    }
    if (shape_emit(&builder, "door frames", materials[ATRIUM_STONE]) < 0) return false;
    for (int half_turns = 0; half_turns < 2; half_turns++) {
        builder.scene_from_shape =
            glms_rotate_y(glms_mat4_identity(), GLM_PI_2f + GLM_PIf * (float)half_turns);
        float wall = -ATRIUM_HALF_LENGTH;
        shape_box(&builder, vec3_of(-1.5f, -0.1f, wall - 0.1f), vec3_of(1.5f, 3.8f, wall + 0.08f));
    }
    return shape_emit(&builder, "doors", materials[ATRIUM_WOOD]) >= 0;
}

// At azimuth 0 the sun is towards +z. By default it lights the -z half of the floor, the colonnade
// at -z and the cloth there.
static bool build_light(struct scene *scene, const struct atrium_options *options)
{
    scene->environment.sky = vec3_of(1700, 2300, 3400);
    float elevation = glm_rad(options->elevation), azimuth = glm_rad(options->azimuth);
    vec3s direction = vec3_of(cosf(elevation) * sinf(azimuth), -sinf(elevation),
                              -cosf(elevation) * cosf(azimuth));
    return builtin_sun(scene, "sun", vec3_of(0, 20, 0), direction,
                       glms_vec3_scale(vec3_of(1.0f, 0.95f, 0.88f), options->sun));
}

static bool build_atrium(struct scene *scene, const void *options)
{
    const struct atrium_options *o = options;
    int materials[ATRIUM_MATERIALS];
    return build_materials(scene, o->texels, materials) && build_shell(scene, materials) &&
           build_slabs(scene, materials) && build_columns(scene, materials) &&
           build_arches(scene, materials) && build_balustrade(scene, materials) &&
           build_doors(scene, materials) && (!o->drapes || atrium_drapes(scene, materials)) &&
           atrium_furniture(scene, materials) && build_light(scene, o) &&
           builtin_camera(scene, "main", vec3_of(-11.2f, 1.75f, 1.0f), vec3_of(8, 3.5f, -0.9f),
                          glm_rad(60.0f));
}

const struct builtin_scene builtin_atrium = {
    .name = "atrium",
    .title = "a colonnaded two-storey courtyard with coloured drapes, sunlit from above",
    .options = OPTION_TABLE(struct atrium_options, rows, NULL),
    .build = build_atrium,
};
