#include "paper_vo_measure.h"

#include "visibility.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { PAN_FRAMES = 30 };

static const double PAN_PX = 0.5;         // per frame
static const float SECOND_RADIUS = 0.25f; // relative to the first

// ---- references

static size_t pixels_of(const struct ag_image *image)
{
    return (size_t)image->width * (size_t)image->height;
}

static enum ag_result trace(struct vo_view *view)
{
    struct visibility_desc desc = { &view->frame.camera, view->spp, view->radius_m, 0.0f };
    enum ag_result result = visibility_trace(view->bench, view->scene, &desc, &view->obscurance,
                                             &view->ambient_occlusion, &view->depth);
    desc.radius_m *= SECOND_RADIUS;
    if (result == AG_OK)
        result = visibility_trace(view->bench, view->scene, &desc, &view->two_radii, NULL, NULL);
    if (result != AG_OK) return result;
    for (size_t i = 0; i < pixels_of(view->obscurance); i++)
        view->two_radii->pixels[i] =
            0.5f * (view->two_radii->pixels[i] + view->obscurance->pixels[i]);
    return AG_OK;
}

static enum ag_result set_radius(struct vo_view *view, double share)
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
    enum ag_result result = bench_open_scene(view->bench, scene, &view->scene, &view->frame);
    if (result == AG_OK) result = set_radius(view, radius_share);
    if (result == AG_OK) result = trace(view);
    return result;
}

void vo_view_close(struct vo_view *view)
{
    struct ag_image *images[] = { view->obscurance, view->two_radii, view->ambient_occlusion,
                                  view->depth };
    for (int i = 0; i < 4; i++) ag_image_destroy(view->bench->context, images[i]);
    ag_scene_destroy(view->scene);
}

// ---- errors

static void compare(const struct vo_view *view, const struct ag_image *visibility, bool two_radii,
                    struct vo_result *out)
{
    const struct visibility_error error =
        visibility_compare(visibility, two_radii ? view->two_radii : view->obscurance, view->depth);
    out->mean_error = error.mean;
    out->rms_error = error.rms;
    out->bias = error.bias;
    out->ambient_error = visibility_compare(visibility, view->ambient_occlusion, view->depth).mean;
}

static double mean_difference(const struct ag_image *a, const struct ag_image *b)
{
    double sum = 0.0;
    for (size_t i = 0; i < pixels_of(a); i++)
        sum += fabs((double)a->pixels[i] - (double)b->pixels[i]);
    return sum / (double)pixels_of(a);
}

// ---- times

struct samples {
    const char *gi;
    struct vo_result *out;
};

static bool is_filter(const char *stage)
{
    return strcmp(stage, "temporal") == 0 || strcmp(stage, "blur") == 0 ||
           strcmp(stage, "upsample") == 0;
}

static void add_sample(void *user, int index, const struct ag_timing *timings, int count)
{
    const struct samples *samples = user;
    double geometry = 0.0, pyramid = 0.0, estimate = 0.0, filter = 0.0;
    (void)index;
    for (int i = 0; i < count; i++) {
        const char *stage = passes_stage(timings[i].name, samples->gi);
        if (strcmp(timings[i].name, "gbuffer") == 0) geometry = timings[i].ms;
        if (!stage) continue;
        *(strcmp(stage, "pyramid") == 0 ? &pyramid
          : is_filter(stage)            ? &filter
                                        : &estimate) += timings[i].ms;
    }
    passes_keep_least(&samples->out->geometry_ms, geometry);
    passes_keep_least(&samples->out->pyramid_ms, pyramid);
    passes_keep_least(&samples->out->estimate_ms, estimate);
    passes_keep_least(&samples->out->filter_ms, filter);
}

// ---- pan

// Rotates the view direction about +y.
static struct ag_camera rotated(const struct ag_camera *camera, double angle_rad)
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
    const double pixel_rad = (double)view->frame.camera.vertical_fov_rad / view->bench->height;
    struct ag_image *previous = NULL;
    enum ag_result result = AG_OK;
    for (int f = 0; f < PAN_FRAMES && result == AG_OK; f++) {
        struct ag_frame_desc frame = view->frame;
        struct ag_image *current = NULL;
        frame.camera = rotated(&view->frame.camera, PAN_PX * pixel_rad * f);
        result = ag_renderer_render(renderer, &frame);
        if (result == AG_OK) result = ag_renderer_read(renderer, "visibility", &current);
        if (previous && current)
            out->change += mean_difference(previous, current) / (PAN_FRAMES - 1);
        ag_image_destroy(view->bench->context, previous);
        previous = current;
    }
    ag_image_destroy(view->bench->context, previous);
    return result;
}

enum ag_result vo_measure(const struct vo_view *view, const char *gi, bool two_radii,
                          struct vo_result *out)
{
    char spec[BENCH_TEXT], second[64] = "";
    if (two_radii)
        snprintf(second, sizeof second, ",radius2=%.9g", (double)(SECOND_RADIUS * view->radius_m));
    snprintf(spec, sizeof spec, "%s%cradius=%.9g%s", gi, strchr(gi, ':') ? ',' : ':',
             (double)view->radius_m, second);
    struct samples samples = { gi, out };
    struct ag_renderer *renderer = NULL;
    struct ag_image *visibility = NULL;
    *out = (struct vo_result){ 0 };
    enum ag_result result =
        bench_create_renderer(view->bench, view->scene, spec, "shadow_size=256", &renderer);
    if (result == AG_OK)
        result =
            passes_alternate(&renderer, 1, &view->frame, view->bench->frames, add_sample, &samples);
    if (result == AG_OK) result = ag_renderer_read(renderer, "visibility", &visibility);
    if (result == AG_OK) compare(view, visibility, two_radii, out);
    if (result == AG_OK) result = pan(view, renderer, out);
    ag_image_destroy(view->bench->context, visibility);
    ag_renderer_destroy(renderer);
    return result;
}
