// Scales differ: the paper's Sponza is 37.2 units long, the file 29.76 m; the paper's bunny is 2.3
// units wide, the file 0.156 m. The paper's grids are cubes of 32 cells that exceed the scene (10
// units for a floor of 5, 20 for the bunny, 21 in Sponza, 12 for a box of 5.5). Afterglow's grids
// cover the scene's bounds; `dim` gives cells of the paper's size.
#include "paper_lpv_scenes.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

// In the paper a light illuminates the front of the bunny; here from a distance of about four
// cells.
static const struct ag_area_light_desc BUNNY_LIGHT = {
    .position = { 0, 0.11f, 0.225f },
    .direction = { 0, 0, -1 },
    .width = 0.2f,
    .height = 0.2f,
    .radiance = { 10000, 10000, 10000 },
};

// Sun directions: through the arches on the right of the gallery (the paper's hallway); onto the
// drapes of the ground floor but not onto the planters beside them.
#define HALLWAY_SUN                                                                                \
    {                                                                                              \
        -0.15f, -0.8f, 0.5f                                                                        \
    }
#define PLANTER_SUN                                                                                \
    {                                                                                              \
        0.1f, -1, 0.33f                                                                            \
    }

// Section 5.3 has 16 steps for the Sponza scenes, table 5.1 has 8: 8 are used, since the table's
// times are compared.
const struct paper_scene paper_scenes[] = {
    { .name = "diagonal",
      .title = "Diagonal propagation",
      .section = "5.2",
      .spec = "@diagonal",
      .camera = "main",
      .scan_from = { -1.95f, 0, -1.95f },
      .scan_to = { 2.5f, 0, 2.5f },
      .dim = 16,
      .steps = 20,
      .width = 900,
      .height = 900,
      .lpv_ms = 6.0,
      .holpv_ms = 48.0 },
    { .name = "hallway",
      .title = "Sponza hallway",
      .section = "5.3",
      .spec = "sponza.glb",
      .eye = { 8.5f, 6, 2.9f },
      .target = { -10, 5.8f, 2.9f },
      .fov_deg = 60,
      .sun = HALLWAY_SUN,
      .bounces = 1,
      .dim = 56,
      .steps = 8,
      .occlusion = true,
      .width = 1024,
      .height = 768,
      .lpv_ms = 49.0,
      .holpv_ms = 102.7 },
    { .name = "bunny",
      .title = "Stanford bunny",
      .section = "5.4",
      .spec = "bunny.glb",
      .eye = { 0.27f, 0.2f, 0.32f },
      .target = { -0.02f, 0.105f, 0 },
      .fov_deg = 36,
      .area = &BUNNY_LIGHT,
      .dim = 8,
      .steps = 10,
      .width = 900,
      .height = 900,
      .lpv_ms = 5.9,
      .holpv_ms = 26.6 },
    { .name = "planter",
      .title = "Sponza planter",
      .section = "5.5",
      .spec = "sponza.glb",
      .eye = { -0.9f, 0.75f, -0.1f },
      .target = { -2.35f, 0.45f, 1.35f },
      .fov_deg = 45,
      .sun = PLANTER_SUN,
      .bounces = 1,
      .dim = 56,
      .steps = 8,
      .occlusion = true,
      .width = 1024,
      .height = 768,
      .lpv_ms = 49.0,
      .holpv_ms = 99.0 },
    { .name = "floor",
      .title = "Sponza floor",
      .section = "5.6",
      .spec = "sponza.glb",
      .eye = { -2.6f, 1.4f, 0.2f },
      .target = { -2.6f, 0, 0.2f },
      .fov_deg = 45,
      .sun = PLANTER_SUN,
      .scan_from = { -4.6f, 0, 0.2f },
      .scan_to = { -0.6f, 0, 0.2f },
      .bounces = 1,
      .dim = 56,
      .steps = 8,
      .occlusion = true,
      .width = 1024,
      .height = 768 },
    { .name = "cornell",
      .title = "Cornell box",
      .section = "5.7",
      .spec = "@cornell",
      .camera = "main",
      .dim = 16,
      .steps = 16,
      .occlusion = true,
      .width = 900,
      .height = 900,
      .lpv_ms = 9.9,
      .holpv_ms = 174.0 },
    // Not in the paper: a built-in substitute where Sponza's file is missing.
    { .name = "planter-builtin",
      .title = "Planter (@planter)",
      .section = "5.5",
      .spec = "@planter",
      .camera = "main",
      .bounces = 1,
      .dim = 24,
      .steps = 8,
      .occlusion = true,
      .width = 1024,
      .height = 768 },
    { .name = "floor-builtin",
      .title = "Floor (@planter)",
      .section = "5.6",
      .spec = "@planter:textures=false",
      .camera = "floor",
      .scan_from = { -0.84f, 0, -2.45f },
      .scan_to = { 1.04f, 0, -2.45f },
      .bounces = 1,
      .dim = 24,
      .steps = 8,
      .occlusion = true,
      .width = 1024,
      .height = 768 },
};
const int paper_scene_count = sizeof paper_scenes / sizeof *paper_scenes;

static enum ag_result add_lights(const struct paper_scene *scene, struct ag_scene *loaded)
{
    if (scene->area) return ag_scene_add_area_light(loaded, scene->area, NULL);
    if (scene->sun[1] == 0.0f) return AG_OK;
    struct ag_light_desc sun;
    ag_light_desc_default(&sun, AG_LIGHT_SUN);
    memcpy(sun.direction, scene->sun, sizeof sun.direction);
    for (int c = 0; c < 3; c++) sun.intensity[c] = 100000;
    return ag_scene_add_light(loaded, &sun, NULL);
}

enum ag_result paper_scene_open(const struct paper_scene *scene, struct ag_context *context,
                                const char *folder, struct ag_scene **out)
{
    char path[1024];
    bool builtin = scene->spec[0] == '@';
    snprintf(path, sizeof path, "%s%s%s", builtin ? "" : folder, builtin ? "" : "/", scene->spec);
    enum ag_result result = ag_scene_load(context, path, out);
    return result == AG_OK ? add_lights(scene, *out) : result;
}

static float radians(float degrees)
{
    return degrees * 3.14159265f / 180;
}

enum ag_result paper_scene_camera(const struct paper_scene *scene, struct ag_scene *loaded,
                                  struct ag_camera *out)
{
    if (scene->camera) return ag_scene_camera(loaded, scene->camera, 0, 0.0, out);
    return ag_scene_look_at(loaded, scene->eye, scene->target, radians(scene->fov_deg), out);
}

bool paper_scene_scans_floor(const struct paper_scene *scene)
{
    return memcmp(scene->scan_from, scene->scan_to, sizeof scene->scan_from) != 0;
}

enum ag_result paper_scene_scan_camera(const struct paper_scene *scene, struct ag_scene *loaded,
                                       int width, struct ag_camera *out)
{
    if (!paper_scene_scans_floor(scene)) {
        enum ag_result result = paper_scene_camera(scene, loaded, out);
        float row = tanf(0.5f * out->vertical_fov_rad) / (float)scene->height;
        row *= (float)scene->width / (float)width; // same width as the image
        out->vertical_fov_rad = 2 * atanf(row);
        return result;
    }
    static const float HEIGHT_M = 1.2f;
    const float *from = scene->scan_from, *to = scene->scan_to;
    float x = to[0] - from[0], z = to[2] - from[2], length = hypotf(x, z);
    float target[3] = { 0.5f * (from[0] + to[0]), from[1], 0.5f * (from[2] + to[2]) };
    float eye[3] = { target[0], target[1] + HEIGHT_M, target[2] };
    float fov_rad = 2 * atanf(0.5f * length / (float)width / HEIGHT_M);
    enum ag_result result = ag_scene_look_at(loaded, eye, target, fov_rad, out);
    // The direction from one point to the other points to the right of the image.
    out->up[0] = z / length;
    out->up[1] = 0;
    out->up[2] = -x / length;
    return result;
}
