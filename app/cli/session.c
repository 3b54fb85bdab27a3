// Context, scene, light and camera of a command.
#include "session.h"
#include "cli/cache/cache_root.h"
#include "values.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double FOV_DEG = 60.0;

enum status session_begin(struct session *session, const struct arguments *arguments)
{
    *session = (struct session){ .arguments = arguments };
    struct ag_context_desc desc;
    char cache[4096];
    ag_context_desc_default(&desc);
    desc.no_links_in = cache_root(cache, sizeof cache) ? cache : NULL;
    desc.follow_links = arguments->follow_links;
    desc.log = log_message;
    desc.log_up_to = arguments->verbose ? AG_LOG_DEBUG : AG_LOG_WARNING;
    enum ag_result result = ag_context_create(&desc, &session->context);
    return result == AG_OK ? DONE : fail("cannot begin: %s", ag_result_string(result));
}

void session_end(struct session *session)
{
    ag_scene_destroy(session->scene);
    ag_environment_destroy(session->environment);
    ag_context_destroy(session->context);
    *session = (struct session){ 0 };
}

// ---- notes

__attribute__((format(printf, 2, 3))) static void remember(struct session *session,
                                                           const char *format, ...)
{
    if (session->note_count == MAX_NOTES) return;
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(session->notes[session->note_count++], sizeof session->notes[0], format, arguments);
    va_end(arguments);
}

void session_say(struct session *session)
{
    for (int i = 0; i < session->note_count; i++) note("%s", session->notes[i]);
    session->note_count = 0;
}

// ---- scene and animation

static int animation_count(const struct session *session)
{
    struct ag_scene_info info = { 0 };
    ag_scene_get_info(session->scene, -1, 0.0, &info);
    return info.animations;
}

static enum status unknown_animation(struct session *session, int count)
{
    char list[SPEC_SIZE] = "none";
    size_t used = 0;
    for (int i = 0; i < count && used < sizeof list; i++) {
        struct ag_animation_info info;
        if (ag_scene_get_animation(session->scene, i, &info) != AG_OK) break;
        int wrote =
            snprintf(list + used, sizeof list - used, "%s%d %s", i ? ", " : "", i, info.name);
        used += wrote > 0 ? (size_t)wrote : 0;
    }
    return fail("cannot find animation %s in %s: it has %s", session->arguments->animation,
                session->name, list);
}

static enum status find_animation(struct session *session)
{
    const char *wanted = session->arguments->animation;
    session->animation = 0;
    if (!wanted) return DONE;
    session->animation = -1;
    if (strcmp(wanted, "none") == 0) return DONE;
    int count = animation_count(session);
    for (int i = 0; i < count && session->animation < 0; i++) {
        struct ag_animation_info info;
        enum ag_result result = ag_scene_get_animation(session->scene, i, &info);
        if (result != AG_OK) return fail_library(session->context, result);
        if (strcmp(info.name, wanted) == 0) session->animation = i;
    }
    long number;
    if (session->animation < 0 && value_int(wanted, 0, count - 1, &number))
        session->animation = (int)number;
    return session->animation >= 0 ? DONE : unknown_animation(session, count);
}

static void remember_still_scene(struct session *session)
{
    const struct arguments *a = session->arguments;
    if ((a->time_s != 0.0 || a->time_step_s != 0.0) && animation_count(session) == 0)
        remember(session, "%s has no effect: %s has no animation",
                 a->time_s != 0.0 ? "--time" : "--time-step", session->name);
}

enum status session_load(struct session *session, const char *name, float scale)
{
    const struct ag_scene_load_desc desc = { .scale = scale };
    enum ag_result result = ag_scene_load_with(session->context, name, &desc, &session->scene);
    if (result != AG_OK) return fail_library(session->context, result);
    session->name = name;
    remember_still_scene(session);
    return find_animation(session);
}

// ---- default light and camera

static void print_floats(char out[SPEC_SIZE], const float v[3])
{
    size_t used = 0;
    for (int i = 0; i < 3; i++) { // a millimetre, even far from the origin
        int digits = fabsf(v[i]) < 1000.0f ? 6 : 9;
        int wrote =
            snprintf(out + used, SPEC_SIZE - used, "%s%.*g", i ? "," : "", digits, (double)v[i]);
        used += wrote > 0 ? (size_t)wrote : 0;
    }
}

enum status defaults_light(struct session *session, struct defaults *out)
{
    struct ag_default_lighting lighting;
    out->light[0] = out->sky[0] = 0;
    enum ag_result result = ag_scene_default_lighting(session->scene, &lighting);
    if (result != AG_OK) return fail_library(session->context, result);
    if (!lighting.needed) return DONE;
    char direction[SPEC_SIZE], lux[SPEC_SIZE];
    print_floats(direction, lighting.sun_direction);
    print_floats(lux, lighting.sun_lux);
    print_floats(out->sky, lighting.sky);
    const char *why;
    int wrote = snprintf(out->light, sizeof out->light, "sun:%s:%s", direction, lux);
    if (wrote < (int)sizeof out->light && value_light(out->light, &out->light_value, &why) &&
        value_floats(out->sky, 3, out->sky_radiance))
        return DONE;
    return fail("cannot light %s: its default light %s is not finite", session->name, out->light);
}

enum status defaults_camera(struct session *session, double time_s, struct defaults *out)
{
    bool made_up = false;
    out->eye[0] = out->target[0] = out->fov[0] = 0;
    enum ag_result result =
        ag_scene_default_camera(session->scene, session->animation, time_s, &out->camera, &made_up);
    if (result != AG_OK) return fail_library(session->context, result);
    if (!made_up) return DONE;
    print_floats(out->eye, out->camera.eye);
    print_floats(out->target, out->camera.target);
    snprintf(out->fov, sizeof out->fov, "%.6g", degrees(out->camera.vertical_fov_rad));
    float eye[3], target[3];
    double fov_deg;
    if (!value_floats(out->eye, 3, eye) || !value_floats(out->target, 3, target) ||
        !value_number(out->fov, &fov_deg))
        return fail("cannot look at %s: its default camera is not finite", session->name);
    result = ag_scene_look_at(session->scene, eye, target, radians(fov_deg), &out->camera);
    if (result == AG_OK) return DONE;
    fail_library(session->context, result);
    return FAILED; // an unsuitable scene is not wrong usage
}

// ---- light

static enum status add_default_light(struct session *session)
{
    struct defaults defaults;
    enum status status = defaults_light(session, &defaults);
    if (status != DONE || !defaults.light[0]) return status;
    enum ag_result result =
        ag_scene_add_light(session->scene, &defaults.light_value.punctual, NULL);
    if (result == AG_OK) result = ag_scene_set_sky(session->scene, defaults.sky_radiance);
    if (result != AG_OK) return fail_library(session->context, result);
    session->made_up_light = true;
    snprintf(session->light, sizeof session->light, "--light %s --sky %s", defaults.light,
             defaults.sky);
    struct ag_scene_info info = { 0 };
    ag_scene_get_info(session->scene, -1, 0.0, &info);
    remember(session, "%s in %s: using %s", info.emissive ? "only negligible emission" : "no light",
             session->name, session->light);
    return DONE;
}

// Fails with the library's message about an option's value, without the name of the function.
static enum status fail_option(const struct session *session, enum ag_result result,
                               const char *option)
{
    static const char call[] = "cannot call ";
    const char *why = ag_context_last_error(session->context);
    const char *end = strncmp(why, call, sizeof call - 1) == 0 ? strstr(why, ": ") : NULL;
    if (result != AG_ERROR_ARGUMENT || !end) return fail_library(session->context, result);
    return wrong_usage("wrong value %s: %s", option, end + 2);
}

static enum ag_result add_light(struct ag_scene *scene, const struct light_value *light)
{
    return light->is_area ? ag_scene_add_area_light(scene, &light->area, NULL)
                          : ag_scene_add_light(scene, &light->punctual, NULL);
}

// The options of light and sky.
static void describe_light(struct session *session)
{
    const struct arguments *a = session->arguments;
    size_t used = 0;
    char sky[SPEC_SIZE];
    print_floats(sky, a->sky);
    for (int i = 0; i < a->light_count && used < LIGHT_SIZE; i++) {
        int wrote = snprintf(session->light + used, LIGHT_SIZE - used, "%s--light %s",
                             used ? " " : "", a->light_texts[i]);
        used += wrote > 0 ? (size_t)wrote : 0;
    }
    if (used >= LIGHT_SIZE) return;
    snprintf(session->light + used, LIGHT_SIZE - used, "%s%s%s%s%s%s%s", used ? " " : "",
             a->no_scene_lights ? "--no-scene-lights " : "", a->environment ? "--environment " : "",
             a->environment ? a->environment : "", a->environment ? " " : "",
             a->has_sky ? "--sky " : "", a->has_sky ? sky : "");
    for (used = strlen(session->light); used > 0 && session->light[used - 1] == ' '; used--)
        session->light[used - 1] = 0;
}

float session_scene_size_m(const struct session *session)
{
    struct ag_scene_info info = { 0 };
    float longest = 0.0f;
    if (session->scene) ag_scene_get_info(session->scene, -1, 0.0, &info);
    for (int i = 0; i < 3; i++) longest = fmaxf(longest, info.bounds_max[i] - info.bounds_min[i]);
    return longest;
}

static void warn_of_empty_scene(struct session *session)
{
    struct ag_scene_info info = { 0 };
    ag_scene_get_info(session->scene, -1, 0.0, &info);
    if (info.triangles == 0)
        remember(session, "nothing to see in %s: it has no triangles", session->name);
}

// The environment replaces the scene's own sky.
static enum status set_environment(struct session *session)
{
    static const float NONE[3] = { 0, 0, 0 };
    const struct arguments *a = session->arguments;
    enum ag_result result =
        environment_make(session->context, &a->environment_value, &session->environment);
    if (result == AG_OK)
        result = environment_turn(session->scene, session->environment, &a->environment_value, 0);
    if (result == AG_OK && !a->has_sky) result = ag_scene_set_sky(session->scene, NONE);
    return result == AG_OK ? DONE : fail_option(session, result, "--environment");
}

static enum status set_sky(struct session *session)
{
    const enum ag_result result = ag_scene_set_sky(session->scene, session->arguments->sky);
    return result == AG_OK ? DONE : fail_option(session, result, "--sky");
}

enum status session_light(struct session *session)
{
    const struct arguments *a = session->arguments;
    warn_of_empty_scene(session);
    if (a->light_count == 0 && !a->no_scene_lights && !a->has_sky && !a->environment)
        return add_default_light(session);
    enum ag_result result = AG_OK;
    describe_light(session);
    if (a->no_scene_lights) result = ag_scene_remove_lights(session->scene);
    if (result != AG_OK) return fail_library(session->context, result);
    for (int i = 0; i < a->light_count; i++) {
        char option[LIGHT_SIZE];
        result = add_light(session->scene, &a->lights[i]);
        snprintf(option, sizeof option, "--light %s", a->light_texts[i]);
        if (result != AG_OK) return fail_option(session, result, option);
    }
    const enum status status = a->environment ? set_environment(session) : DONE;
    return status == DONE && a->has_sky ? set_sky(session) : status;
}

// ---- camera

static enum status camera_from_options(struct session *session, struct ag_camera *out)
{
    const struct arguments *a = session->arguments;
    double fov_deg = a->has_fov ? a->fov_deg : FOV_DEG;
    enum ag_result result =
        ag_scene_look_at(session->scene, a->eye, a->target, radians(fov_deg), out);
    if (result != AG_OK) return fail_option(session, result, "--eye, --target");
    char eye[SPEC_SIZE], target[SPEC_SIZE];
    print_floats(eye, a->eye);
    print_floats(target, a->target);
    snprintf(session->camera_name, sizeof session->camera_name,
             "--eye %.70s --target %.70s --fov %.6g", eye, target, fov_deg);
    return DONE;
}

static enum status camera_from_scene(struct session *session, double time_s, struct ag_camera *out)
{
    const char *name = session->arguments->camera;
    enum ag_result result = ag_scene_camera(session->scene, name, session->animation, time_s, out);
    snprintf(session->camera_name, sizeof session->camera_name, "%s", name);
    if (result == AG_OK) return DONE;
    fail_library(session->context, result);
    return FAILED; // a missing camera is not wrong usage
}

static enum status camera_default(struct session *session, double time_s, struct ag_camera *out)
{
    struct defaults defaults;
    *out = session->made_up_camera;
    if (session->made_up) return DONE;
    enum status status = defaults_camera(session, time_s, &defaults);
    if (status != DONE) return status;
    *out = defaults.camera;
    if (!defaults.eye[0]) {
        const char *name = ag_scene_camera_name(session->scene, 0);
        snprintf(session->camera_name, sizeof session->camera_name, "%s", name ? name : "");
        return DONE;
    }
    session->made_up = true;
    session->made_up_camera = defaults.camera;
    remember(session, "no camera in %s: using --eye %s --target %s --fov %s", session->name,
             defaults.eye, defaults.target, defaults.fov);
    snprintf(session->camera_name, sizeof session->camera_name,
             "--eye %.70s --target %.70s --fov %.20s", defaults.eye, defaults.target, defaults.fov);
    return DONE;
}

enum status session_camera(struct session *session, double time_s, struct ag_camera *out)
{
    const struct arguments *a = session->arguments;
    if (a->has_eye) return camera_from_options(session, out);
    enum status status =
        a->camera ? camera_from_scene(session, time_s, out) : camera_default(session, time_s, out);
    if (status == DONE && a->has_fov) out->vertical_fov_rad = radians(a->fov_deg);
    return status;
}
