// @spheres: a chart of metallic and roughness under a sun and a sky, or a furnace test. In a closed
// box whose walls emit radiance Le and have albedo ρ, radiance is Le / (1 − ρ) everywhere and
// irradiance π times that, whatever the box's shape: a test of energy conservation.
#include "scene/builtin/parts.h"

#include <math.h>
#include <stdio.h>

struct spheres_options {
#define OPTION OPTION_FIELD
#include "spheres_options.def"
#undef OPTION
};

#define OPTION(...) OPTION_ROW(struct spheres_options, __VA_ARGS__)
static const struct option_row rows[] = {
#include "spheres_options.def"
};
#undef OPTION

static const float RADIUS = 0.45f, SPACING = 1.1f;
static const float FURNACE_SIZE = 4.0f, FURNACE_WALL = 0.2f;

static int furnace_part(const void *user, int i, int j, int k)
{
    (void)user;
    return i != 1 || j != 1 || k != 1;
}

// A hollow box; its walls emit on both sides.
static bool build_furnace(struct scene *scene, const struct spheres_options *options)
{
    struct material wall = material_default();
    wall.name = "furnace";
    wall.base_color = (vec4s){ { options->albedo, options->albedo, options->albedo, 1 } };
    wall.emissive = vec3_of(options->radiance, options->radiance, options->radiance);
    int material = scene_add_material(scene, &wall);
    if (material < 0) return false;
    float half = 0.5f * FURNACE_SIZE;
    const float across[4] = { -half - FURNACE_WALL, -half, half, half + FURNACE_WALL };
    const float up[4] = { -FURNACE_WALL, 0, FURNACE_SIZE, FURNACE_SIZE + FURNACE_WALL };
    struct shape_grid grid = { across, up, across, 3, 3, 3, furnace_part, NULL };
    struct shape_builder builder;
    shape_begin(&builder, scene);
    shape_blocks(&builder, &grid, 1);
    return shape_emit(&builder, "furnace", material) >= 0 &&
           builtin_camera(scene, "main", vec3_of(0.3f * half, 0.9f * half, 0.8f * half),
                          vec3_of(-0.2f * half, 0.7f * half, -half), glm_rad(60.0f));
}

static bool build_stage(struct scene *scene, float width, float height)
{
    int material = builtin_diffuse(scene, "stage", vec3_of(0.35f, 0.36f, 0.38f));
    if (material < 0) return false;
    struct shape_builder builder;
    shape_begin(&builder, scene);
    float half = 0.5f * width + 2.0f;
    shape_box(&builder, vec3_of(-half, -0.2f, -1.2f), vec3_of(half, 0, 4.0f));
    shape_box(&builder, vec3_of(-half, -0.2f, -1.4f), vec3_of(half, height + 1.5f, -1.2f));
    return shape_emit(&builder, "stage", material) >= 0;
}

static bool build_sphere(struct scene *scene, vec3s centre, float metallic, float roughness)
{
    char name[48];
    snprintf(name, sizeof name, "metallic %.2f roughness %.2f", (double)metallic,
             (double)roughness);
    struct material material = material_default();
    material.name = name;
    material.base_color = (vec4s){ { 0.92f, 0.62f, 0.36f, 1 } };
    material.metallic = metallic;
    material.roughness = roughness;
    int index = scene_add_material(scene, &material);
    if (index < 0) return false;
    struct shape_builder builder;
    shape_begin(&builder, scene);
    shape_sphere(&builder, centre, RADIUS, 32);
    return shape_emit(&builder, name, index) >= 0;
}

static bool build_chart(struct scene *scene, const struct spheres_options *options)
{
    int columns = options->columns, row_count = options->rows;
    float width = (float)(columns - 1) * SPACING, height = (float)row_count * SPACING;
    if (!build_stage(scene, width, height)) return false;
    for (int row = 0; row < row_count; row++) {
        for (int column = 0; column < columns; column++) {
            vec3s centre =
                vec3_of((float)column * SPACING - 0.5f * width, ((float)row + 0.5f) * SPACING, 0);
            if (!build_sphere(scene, centre, (float)row / (float)(row_count - 1),
                              (float)column / (float)(columns - 1))) {
                return false;
            }
        }
    }
    scene->environment.sky = vec3_of(2500, 3000, 4000);
    vec3s middle = vec3_of(0, 0.5f * height, 0);
    float distance = 1.5f * fmaxf(height + 1.0f, 0.65f * (width + 1.0f));
    return builtin_sun(scene, "sun", vec3_of(0, height + 5, 0), vec3_of(0.45f, -0.8f, -0.6f),
                       vec3_of(60000, 57000, 52000)) &&
           builtin_camera(scene, "main", vec3_of(0, 0.6f * height, distance), middle,
                          glm_rad(40.0f));
}

static bool build_spheres(struct scene *scene, const void *options)
{
    const struct spheres_options *o = options;
    return o->furnace ? build_furnace(scene, o) : build_chart(scene, o);
}

const struct builtin_scene builtin_spheres = {
    .name = "spheres",
    .title = "a chart of metallic and roughness, or a furnace test",
    .options = OPTION_TABLE(struct spheres_options, rows, NULL),
    .build = build_spheres,
};
