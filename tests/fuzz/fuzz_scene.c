// A scene file of the format FUZZ_EXTENSION: loaded, then asked for what `info` shows. Where the
// format is "@", the input is the name of a built-in scene with its options.
#include "fuzz/fuzz.h"

#include <afterglow/scene.h>

#include <math.h>
#include <string.h>

enum { MAX_ASKED = 8 }; // objects of a kind

static void check_floats(const float *values, int count)
{
    for (int i = 0; i < count; i++) FUZZ_CHECK(isfinite(values[i]));
}

static void check_camera(const struct ag_camera *camera)
{
    check_floats(camera->eye, 3);
    check_floats(camera->target, 3);
    check_floats(camera->up, 3);
    FUZZ_CHECK(camera->vertical_fov_rad > 0.0f && camera->near_m > 0.0f);
}

static void ask_cameras(struct ag_scene *scene, double time_s)
{
    struct ag_camera camera;
    bool made_up = false;
    if (ag_scene_default_camera(scene, 0, time_s, &camera, &made_up) == AG_OK)
        check_camera(&camera);
    for (int i = 0; i < MAX_ASKED && i < ag_scene_camera_count(scene); i++) {
        const char *name = ag_scene_camera_name(scene, i);
        if (ag_scene_camera(scene, name, 0, time_s, &camera) == AG_OK) check_camera(&camera);
    }
}

static void ask_lights(struct ag_scene *scene, double time_s)
{
    struct ag_light_info light;
    struct ag_default_lighting lighting;
    for (int i = 0; i < MAX_ASKED; i++) {
        if (ag_scene_get_light(scene, i, 0, time_s, &light) != AG_OK) break;
        check_floats(light.light.position, 3);
        check_floats(light.light.direction, 3);
        check_floats(light.light.intensity, 3);
    }
    if (ag_scene_default_lighting(scene, &lighting) == AG_OK && lighting.needed)
        check_floats(lighting.sun_direction, 3);
}

static void ask_materials(struct ag_scene *scene)
{
    struct ag_material_info info;
    for (int i = 0; i < MAX_ASKED; i++) {
        if (ag_scene_get_material(scene, i, &info) != AG_OK) break;
        check_floats(info.material.base_color, 4);
        check_floats(info.material.emissive, 3);
        FUZZ_CHECK(strlen(info.name) < SIZE_MAX);
    }
}

static void ask(struct ag_scene *scene)
{
    static const double times_s[] = { 0.0, 1.25 };
    struct ag_scene_info info;
    struct ag_animation_info animation;
    for (int i = 0; i < MAX_ASKED; i++)
        if (ag_scene_get_animation(scene, i, &animation) != AG_OK) break;
    ask_materials(scene);
    for (int t = 0; t < 2; t++) {
        if (ag_scene_get_info(scene, 0, times_s[t], &info) == AG_OK) {
            check_floats(info.bounds_min, info.triangles > 0 ? 3 : 0);
            check_floats(info.bounds_max, info.triangles > 0 ? 3 : 0);
        }
        ask_cameras(scene, times_s[t]);
        ask_lights(scene, times_s[t]);
    }
}

struct input {
    const uint8_t *data;
    size_t size;
};

// Every file that the scene refers to is the scene's own, but for some that do not exist.
static bool find(void *user, const char *path, const void **bytes, size_t *size)
{
    const struct input *input = user;
    *bytes = input->data;
    *size = input->size;
    return strlen(path) % 4 != 0;
}

static enum ag_result load_memory(struct ag_context *context, const uint8_t *data, size_t size,
                                  struct ag_scene **scene)
{
    struct input input = { data, size };
    const struct ag_scene_memory_desc desc = {
        .bytes = data, .size = size, .name = "fuzz." FUZZ_EXTENSION, .read = find, .user = &input
    };
    return ag_scene_load_memory(context, &desc, scene);
}

// By the readers of this library, not by the importer program.
static bool is_read_here(void)
{
    return strcmp(FUZZ_EXTENSION, "gltf") == 0 || strcmp(FUZZ_EXTENSION, "glb") == 0 ||
           strcmp(FUZZ_EXTENSION, "ply") == 0;
}

static enum ag_result load(struct ag_context *context, const uint8_t *data, size_t size,
                           struct ag_scene **scene)
{
    if (is_read_here() && size > 0) return load_memory(context, data, size, scene);
    if (strcmp(FUZZ_EXTENSION, "@") != 0)
        return ag_scene_load(context, fuzz_file(data, size, FUZZ_EXTENSION), scene);
    char *text = fuzz_text(data, size), *name = calloc(strlen(text) + 2, 1);
    FUZZ_CHECK(name);
    name[0] = '@';
    memcpy(name + 1, text, strlen(text));
    const enum ag_result result = ag_scene_load(context, name, scene);
    free(name);
    free(text);
    return result;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct ag_context *context = fuzz_context();
    struct ag_scene *scene = NULL;
    const enum ag_result result = load(context, data, size, &scene);
    FUZZ_CHECK((result == AG_OK) == (scene != NULL));
    FUZZ_CHECK(result == AG_OK || ag_context_last_error(context)[0]);
    if (scene) ask(scene);
    ag_scene_destroy(scene);
    ag_context_destroy(context);
    return 0;
}
