// Error of scattered light in images lit from behind: ort beside the profile summed over points
// of all surfaces at each pixel.
//
//     ort-scattering [--options KEY=VALUE,…] [--points N] [--out DIR] [--size WxH] [SCENE]…
#include "ort_scattering/image_pair.h"

#include <string.h>

struct program {
    struct bench bench;
    const char *options, *folder;
    int points;
};

// ---- the view

// From the front, a little from one side.
static void look_at_upper_part(struct image_pair *p, const struct ag_scene_info *info)
{
    static const float FROM[3] = { -0.55f, 0.0f, 1.1f }, UP = 0.17f;
    const float height = info->bounds_max[1] - info->bounds_min[1];
    float target[3], eye[3];
    for (int a = 0; a < 3; a++) {
        target[a] = 0.5f * (info->bounds_min[a] + info->bounds_max[a]);
        if (a == 1) target[a] += UP * height;
        eye[a] = target[a] + FROM[a] * height;
    }
    ag_scene_look_at(p->scene, eye, target, 0.5f, &p->frame.camera);
}

// From behind: the sun from one side, or a spot that meets the upper part.
static void place_light(struct image_pair *p, const struct ag_scene_info *info, bool spot)
{
    const float *target = p->frame.camera.target,
                height = info->bounds_max[1] - info->bounds_min[1];
    static const float SUN[3] = { 0.35f, -0.3f, 1.0f }, FROM[3] = { -0.75f, 0.1f, -1.0f };
    ag_light_desc_default(&p->light, spot ? AG_LIGHT_SPOT : AG_LIGHT_SUN);
    p->light_name = spot ? "spot" : "sun";
    p->light.outer_rad = 0.25f;
    p->light.inner_rad = 0.15f;
    for (int a = 0; a < 3; a++) {
        p->light.position[a] = target[a] + height * FROM[a];
        p->light.direction[a] = spot ? -FROM[a] : SUN[a];
        p->light.intensity[a] = spot ? 1e5f * height * height : 1e5f;
    }
}

static enum ag_result set_view(struct image_pair *p, bool spot)
{
    static const float black[3] = { 0.0f, 0.0f, 0.0f };
    struct ag_scene_info info;
    enum ag_result result = ag_scene_get_info(p->scene, 0, 0.0, &info);
    if (result != AG_OK) return result;
    ag_frame_desc_default(&p->frame);
    look_at_upper_part(p, &info);
    place_light(p, &info, spot);
    result = ag_scene_remove_lights(p->scene);
    if (result == AG_OK) result = ag_scene_set_sky(p->scene, black);
    return result == AG_OK ? ag_scene_add_light(p->scene, &p->light, NULL) : result;
}

// ---- main

static enum ag_result measure_light(const struct program *b, const char *name, bool spot)
{
    struct image_pair p = {
        .bench = &b->bench, .scene_name = name, .folder = b->folder, .points = b->points
    };
    snprintf(p.gi, sizeof p.gi, "ort:transfer=scattering,%s", b->options);
    enum ag_result result = ag_scene_load(b->bench.context, name, &p.scene);
    if (result == AG_OK) result = set_view(&p, spot);
    if (result == AG_OK) result = image_pair_render(&p);
    if (result == AG_OK) result = image_pair_make_reference(&p);
    if (result == AG_OK) result = image_pair_print_errors(&p);
    if (result == AG_OK) result = image_pair_write(&p);
    image_pair_finish(&p);
    return result;
}

static enum ag_result measure_scene(void *user, const char *name)
{
    const enum ag_result result = measure_light(user, name, false);
    return result == AG_OK ? measure_light(user, name, true) : result;
}

static bool parse_option(void *user, const char *name, const char *value)
{
    struct program *b = user;
    if (strcmp(name, "--options") == 0) return (b->options = value) != NULL;
    if (strcmp(name, "--out") == 0) return (b->folder = value) != NULL;
    if (strcmp(name, "--points") == 0) return parse_int(value, 1000, 100000000, &b->points);
    return false;
}

static bool set_defaults(void *user)
{
    struct program *b = user;
    return b->bench.scenes.count > 0; // none built in has a size in millimetres
}

int main(int argc, char **argv)
{
    static struct program b = { .bench = { .width = 448, .height = 448, .frames = 1 },
                                .options = "material=skin1,mm_per_unit=31,texels=185000",
                                .folder = ".",
                                .points = 2000000 };
    const struct bench_program program = { .name = "ort-scattering",
                                           .usage = "[--options KEY=VALUE,...] [--points N] "
                                                    "[--out DIR]",
                                           .options = BENCH_SIZE | BENCH_SCENES,
                                           .parse_option = parse_option,
                                           .set_defaults = set_defaults,
                                           .measure_scene = measure_scene };
    return bench_main(&program, &b.bench, &b, argc, argv);
}
