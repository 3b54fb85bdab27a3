#include "paper_vo_measure.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { MAX_PASSES = 64, TEXT = 256, PAN_FRAMES = 30 };

static const double PAN_PX = 0.5;         // a frame
static const float SECOND_RADIUS = 0.25f; // of the first

// ---- the truth

static enum ag_result trace(struct vo_view *view, float radius_m, struct ag_image **obscurance,
                            struct ag_image **ambient, struct ag_image **depth)
{
    struct ag_reference_desc desc;
    ag_reference_desc_default(&desc);
    desc.width = view->width;
    desc.height = view->height;
    desc.camera = view->frame.camera;
    desc.direct_only = true; // the light does not matter
    desc.bounces = 0;
    desc.obscurance_radius_m = radius_m;
    struct ag_reference *reference = NULL;
    enum ag_result result = ag_reference_create(view->scene, &desc, &reference);
    if (result == AG_OK) result = ag_reference_render(reference, view->spp, NULL, NULL);
    if (result == AG_OK) result = ag_reference_read(reference, "obscurance", obscurance);
    if (result == AG_OK && ambient)
        result = ag_reference_read(reference, "ambient_occlusion", ambient);
    if (result == AG_OK && depth) result = ag_reference_read(reference, "depth", depth);
    ag_reference_destroy(reference);
    return result;
}

static size_t pixels_of(const struct ag_image *image)
{
    return (size_t)image->width * (size_t)image->height;
}

static enum ag_result trace_all(struct vo_view *view)
{
    enum ag_result result =
        trace(view, view->radius_m, &view->obscurance, &view->ambient, &view->depth);
    if (result == AG_OK)
        result = trace(view, SECOND_RADIUS * view->radius_m, &view->of_two_radii, NULL, NULL);
    if (result != AG_OK) return result;
    for (size_t i = 0; i < pixels_of(view->obscurance); i++)
        view->of_two_radii->pixels[i] =
            0.5f * (view->of_two_radii->pixels[i] + view->obscurance->pixels[i]);
    return AG_OK;
}

static enum ag_result find_radius(struct vo_view *view, double share)
{
    struct ag_scene_info info;
    const enum ag_result result = ag_scene_get_info(view->scene, 0, 0.0, &info);
    if (result != AG_OK) return result;
    double sum = 0.0;
    for (int i = 0; i < 3; i++) sum += pow((double)(info.bounds_max[i] - info.bounds_min[i]), 2.0);
    view->radius_m = (float)(share * sqrt(sum));
    return AG_OK;
}

enum ag_result vo_view_open(struct vo_view *view, const char *scene, double radius_share)
{
    ag_frame_desc_default(&view->frame);
    enum ag_result result = ag_scene_load(view->context, scene, &view->scene);
    if (result == AG_OK) result = ag_scene_add_default_lighting(view->scene, NULL);
    if (result == AG_OK)
        result = ag_scene_default_camera(view->scene, 0, 0.0, &view->frame.camera, NULL);
    if (result == AG_OK) result = find_radius(view, radius_share);
    if (result == AG_OK) result = trace_all(view);
    return result;
}

void vo_view_close(struct vo_view *view)
{
    struct ag_image *images[] = { view->obscurance, view->of_two_radii, view->ambient,
                                  view->depth };
    for (int i = 0; i < 4; i++) ag_image_destroy(view->context, images[i]);
    ag_scene_destroy(view->scene);
}

// ---- errors

static void compare(const struct vo_view *view, const struct ag_image *seen, bool twice,
                    struct vo_result *out)
{
    const struct ag_image *truth = twice ? view->of_two_radii : view->obscurance;
    double sum = 0.0, squares = 0.0, off = 0.0, ambient = 0.0, count = 0.0;
    for (size_t i = 0; i < pixels_of(seen); i++) {
        if (view->depth->pixels[i] <= 0.0f) continue;
        const double d = (double)seen->pixels[i] - (double)truth->pixels[i];
        sum += fabs(d);
        squares += d * d;
        off += d;
        ambient += fabs((double)seen->pixels[i] - (double)view->ambient->pixels[i]);
        count += 1.0;
    }
    const double n = fmax(count, 1.0);
    out->mean_error = sum / n;
    out->rms_error = sqrt(squares / n);
    out->bias = off / n;
    out->ambient_error = ambient / n;
}

static double mean_difference(const struct ag_image *a, const struct ag_image *b)
{
    double sum = 0.0;
    for (size_t i = 0; i < pixels_of(a); i++)
        sum += fabs((double)a->pixels[i] - (double)b->pixels[i]);
    return sum / (double)pixels_of(a);
}

// ---- times

static double keep_least(double least, double ms)
{
    return least == 0.0 || ms < least ? ms : least;
}

// A technique's pass is named "technique.pass".
static void collect(struct ag_renderer *renderer, const char *gi, struct vo_result *out)
{
    struct ag_timing timings[MAX_PASSES];
    const int count = ag_renderer_timings(renderer, timings, MAX_PASSES);
    const size_t length = strcspn(gi, ":");
    double geometry = 0.0, pyramid = 0.0, estimate = 0.0, after = 0.0;
    for (int i = 0; i < count && i < MAX_PASSES; i++) {
        const char *name = timings[i].name, *pass = name + length + 1;
        if (strcmp(name, "gbuffer") == 0) geometry = timings[i].ms;
        if (strncmp(name, gi, length) != 0 || name[length] != '.') continue;
        const bool follows =
            strcmp(pass, "temporal") == 0 || strcmp(pass, "blur") == 0 || strcmp(pass, "fit") == 0;
        *(strcmp(pass, "pyramid") == 0 ? &pyramid : follows ? &after : &estimate) += timings[i].ms;
    }
    out->geometry_ms = keep_least(out->geometry_ms, geometry);
    out->pyramid_ms = keep_least(out->pyramid_ms, pyramid);
    out->estimate_ms = keep_least(out->estimate_ms, estimate);
    out->after_ms = keep_least(out->after_ms, after);
}

static enum ag_result time_frames(const struct vo_view *view, struct ag_renderer *renderer,
                                  const char *gi, struct vo_result *out)
{
    enum ag_result result = AG_OK;
    for (int f = 0; f <= view->frames && result == AG_OK; f++) {
        result = ag_renderer_render(renderer, &view->frame);
        if (result == AG_OK) result = ag_renderer_wait(renderer);
        if (result == AG_OK && f > 0) collect(renderer, gi, out);
    }
    return result;
}

// ---- a pan

// Turned about +y.
static struct ag_camera turned(const struct ag_camera *camera, double angle_rad)
{
    struct ag_camera out = *camera;
    const double c = cos(angle_rad), s = sin(angle_rad);
    const double x = (double)(camera->target[0] - camera->eye[0]);
    const double z = (double)(camera->target[2] - camera->eye[2]);
    out.target[0] = camera->eye[0] + (float)(c * x + s * z);
    out.target[2] = camera->eye[2] + (float)(c * z - s * x);
    return out;
}

static enum ag_result pan(const struct vo_view *view, struct ag_renderer *renderer,
                          struct vo_result *out)
{
    const double pixel_rad = (double)view->frame.camera.vertical_fov_rad / view->height;
    struct ag_image *last = NULL;
    enum ag_result result = AG_OK;
    for (int f = 0; f < PAN_FRAMES && result == AG_OK; f++) {
        struct ag_frame_desc frame = view->frame;
        struct ag_image *now = NULL;
        frame.camera = turned(&view->frame.camera, PAN_PX * pixel_rad * f);
        result = ag_renderer_render(renderer, &frame);
        if (result == AG_OK) result = ag_renderer_read(renderer, "visibility", &now);
        if (last && now) out->change += mean_difference(last, now) / (PAN_FRAMES - 1);
        ag_image_destroy(view->context, last);
        last = now;
    }
    ag_image_destroy(view->context, last);
    return result;
}

enum ag_result vo_measure(const struct vo_view *view, const char *gi, bool twice,
                          struct vo_result *out)
{
    char text[TEXT], second[64] = "";
    if (twice)
        snprintf(second, sizeof second, ",radius2=%.9g", (double)(SECOND_RADIUS * view->radius_m));
    snprintf(text, sizeof text, "%s%cradius=%.9g%s", gi, strchr(gi, ':') ? ',' : ':',
             (double)view->radius_m, second);
    struct ag_renderer_desc desc;
    ag_renderer_desc_default(&desc);
    desc.width = view->width;
    desc.height = view->height;
    desc.gi = text;
    desc.frame_options = "shadow_size=256";
    struct ag_renderer *renderer = NULL;
    struct ag_image *seen = NULL;
    *out = (struct vo_result){ 0 };
    enum ag_result result = ag_renderer_create(view->device, view->scene, &desc, &renderer);
    if (result == AG_OK) result = time_frames(view, renderer, gi, out);
    if (result == AG_OK) result = ag_renderer_read(renderer, "visibility", &seen);
    if (result == AG_OK) compare(view, seen, twice, out);
    if (result == AG_OK) result = pan(view, renderer, out);
    ag_image_destroy(view->context, seen);
    ag_renderer_destroy(renderer);
    return result;
}
