#include "operations.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { SIDEBAR_UNITS = 360, LEAST_SIZE = 16 };
static const double MESSAGE_S = 8.0;

const char *const viewer_layers[] = {
    "color",  "direct",     "indirect", "irradiance", "specular",
    "albedo", "visibility", "normal",   "depth",      "emissive"
};
const char *const viewer_light_types[3] = { "sun", "point", "spot" };
const int viewer_layer_count = sizeof viewer_layers / sizeof *viewer_layers;

// ---- messages

static void say(struct viewer *v, bool warns, const char *format, va_list arguments)
{
    vsnprintf(v->message, sizeof v->message, format, arguments);
    v->message_until_s = window_seconds() + MESSAGE_S;
    v->message_warns = warns;
}

void viewer_say(struct viewer *v, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    say(v, false, format, arguments);
    va_end(arguments);
}

void viewer_warn(struct viewer *v, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    say(v, true, format, arguments);
    va_end(arguments);
}

bool viewer_check(struct viewer *v, enum ag_result result)
{
    if (result != AG_OK) viewer_warn(v, "%s", ag_context_last_error(v->desc->context));
    return result == AG_OK;
}

bool viewer_write_text(struct viewer *v, const char *path, const char *text)
{
    char why[512];
    const bool done = v->desc->write_text(v->desc->user, path, text, why);
    if (done)
        viewer_say(v, "written: %s", path);
    else
        viewer_warn(v, "%s", why);
    return done;
}

bool viewer_write_json(struct viewer *v, const char *path, json_t *document, size_t flags)
{
    static const size_t ALWAYS = JSON_PRESERVE_ORDER | JSON_REAL_PRECISION(12);
    char *text = json_dumps(document, ALWAYS | flags), *line = NULL;
    if (text && asprintf(&line, "%s\n", text) < 0) line = NULL;
    if (!line) viewer_warn(v, "cannot write %s: out of memory", path);
    const bool done = line && viewer_write_text(v, path, line);
    json_decref(document);
    free(text);
    free(line);
    return done;
}

// ---- the image

void viewer_touch(struct viewer *v)
{
    v->dirty = SETTLE_FRAMES;
    v->version++;
    v->offered = false;
}

void viewer_change(struct viewer *v)
{
    v->changed = true;
    viewer_touch(v);
}

void viewer_note(struct viewer *v, const char *what, int index)
{
    if (v->restoring) return;
    if (index < 0)
        snprintf(v->change, sizeof v->change, "%s", what);
    else
        snprintf(v->change, sizeof v->change, "%s %d", what, index);
}

struct region viewer_images(const struct viewer *v)
{
    const float sidebar = SIDEBAR_UNITS * window_scale(v->window);
    const float width = (float)v->swapchain.width, height = (float)v->swapchain.height;
    return (struct region){ 0, 0, fmaxf(width - sidebar, 0.25f * width), height };
}

struct region viewer_region(const struct viewer *v)
{
    struct region r = viewer_images(v);
    if (viewer_is_side_by_side(v)) r.x1 = floorf(0.5f * (r.x0 + r.x1));
    return r;
}

bool viewer_is_divided(const struct viewer *v)
{
    return v->split || v->truth;
}

bool viewer_is_side_by_side(const struct viewer *v)
{
    return v->side_by_side && viewer_is_divided(v);
}

float viewer_first_share(const struct viewer *v)
{
    return viewer_is_divided(v) && !v->side_by_side ? v->split_at : 1.0f;
}

void viewer_set_side_by_side(struct viewer *v, bool on)
{
    v->side_by_side = on;
    v->mouse_right = false; // until it moves
    viewer_change(v);
}

static float aspect_of(const struct region *r)
{
    return (r->x1 - r->x0) / (r->y1 - r->y0);
}

bool viewer_project(const struct viewer *v, const float point[3], float *x, float *y)
{
    const struct region r = viewer_region(v);
    float at[2];
    if (!look_project(&v->look, aspect_of(&r), point, at)) return false;
    *x = r.x0 + 0.5f * (at[0] + 1.0f) * (r.x1 - r.x0);
    *y = r.y0 + 0.5f * (at[1] + 1.0f) * (r.y1 - r.y0);
    return isfinite(*x) && isfinite(*y); // an image of no width has no pixel
}

void viewer_ray(const struct viewer *v, float x, float y, float eye[3], float direction[3])
{
    const struct region r = viewer_region(v);
    const float at[2] = { 2.0f * (x - r.x0) / (r.x1 - r.x0) - 1.0f,
                          2.0f * (y - r.y0) / (r.y1 - r.y0) - 1.0f };
    memcpy(eye, v->look.eye, sizeof v->look.eye);
    look_ray(&v->look, aspect_of(&r), at, direction);
}

float viewer_exposure(const struct viewer *v)
{
    struct ag_finished_frame finished = { 0 };
    if (!v->auto_exposure) return v->exposure_ev;
    ag_renderer_finished(v->main.renderer, &finished);
    return finished.exposure_ev;
}

void viewer_image_size(const struct viewer *v, int *width, int *height)
{
    const struct region r = viewer_region(v);
    *width = (int)(v->scale * (r.x1 - r.x0) + 0.5f);
    *height = (int)(v->scale * (r.y1 - r.y0) + 0.5f);
    if (*width < LEAST_SIZE) *width = LEAST_SIZE;
    if (*height < LEAST_SIZE) *height = LEAST_SIZE;
}

// The catalogue's name of a debug view; NULL: the method has none of that name.
static const char *find_debug_view(const struct method *method, const char *name)
{
    const char *found = NULL, *help;
    for (int i = 0; name && i < ROLE_COUNT && !found; i++) {
        const int technique = method->chosen[i];
        const int view = technique < 0 ? -1 : ag_technique_debug_view_find(technique, name);
        if (view >= 0) ag_technique_debug_view_get(technique, view, &found, &help);
    }
    return found;
}

void viewer_runs(struct viewer *v, bool other, const char *gi)
{
    struct rendering *rendering = other ? &v->other : &v->main;
    snprintf(other ? v->other_gi : v->gi, METHOD_SPEC, "%s", gi);
    method_parse(other ? &v->other_method : &v->method, ag_renderer_gi(rendering->renderer));
    viewer_note(v, CHANGE_METHOD, -1);
    if (!other) v->paint.texels.gi[0] = 0; // paint_step gives it to the new renderer
    // A view ends with its technique; another technique may have one of the same name.
    if (!other && v->debug_view &&
        !viewer_set_debug_view(v, find_debug_view(&v->method, v->debug_view)))
        viewer_set_debug_view(v, NULL);
    viewer_touch(v);
}

bool viewer_set_debug_view(struct viewer *v, const char *name)
{
    const char *layer = name ? "debug" : v->layer > 0 ? viewer_layers[v->layer] : NULL;
    if (!viewer_check(v, ag_renderer_set_debug_view(v->main.renderer, name)) ||
        !viewer_check(v, ag_renderer_set_display(v->main.renderer, layer)))
        return false;
    v->debug_view = find_debug_view(&v->method, name);
    viewer_touch(v);
    return true;
}

void viewer_set_layer(struct viewer *v, int layer)
{
    if (v->debug_view && !viewer_set_debug_view(v, NULL)) return;
    const char *name = layer > 0 ? viewer_layers[layer] : NULL;
    if (!viewer_check(v, ag_renderer_set_display(v->main.renderer, name))) return;
    if (v->other.renderer) viewer_check(v, ag_renderer_set_display(v->other.renderer, name));
    v->layer = layer;
    viewer_touch(v);
}

void viewer_scene_options(const struct viewer *v, char *out, size_t size)
{
    snprintf(out, size, "%s%s", v->desc->scene_words, v->desc->light_words);
}

static float scene_size(struct viewer *v)
{
    struct ag_scene_info info;
    if (ag_scene_get_info(v->desc->scene, v->desc->animation, v->time_s, &info) != AG_OK ||
        info.triangles == 0)
        return 1.0f;
    float sum = 0;
    for (int i = 0; i < 3; i++) {
        const float side = info.bounds_max[i] - info.bounds_min[i];
        sum += side * side;
    }
    return sqrtf(sum);
}

void viewer_set_camera(struct viewer *v, int scene_camera)
{
    const char *name = ag_scene_camera_name(v->desc->scene, scene_camera);
    struct ag_camera camera = v->given;
    if (scene_camera >= 0 &&
        !viewer_check(
            v, ag_scene_camera(v->desc->scene, name, v->desc->animation, v->time_s, &camera)))
        return;
    v->scene_camera = scene_camera;
    v->camera = camera;
    look_from_camera(&v->look, &camera, scene_size(v));
    viewer_change(v);
}
