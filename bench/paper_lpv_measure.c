// The reference has the light that the techniques compute: one bounce of sunlight, or the direct
// light of an area light.
#include "paper_lpv_measure.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static void print_progress(const struct paper_scene *scene, const char *step)
{
    fprintf(stderr, "%s: %s\n", scene->name, step);
}

static double luminance(const float *rgb)
{
    return 0.2126 * (double)rgb[0] + 0.7152 * (double)rgb[1] + 0.0722 * (double)rgb[2];
}

// ---- techniques

static bool has_technique(const char *name)
{
    struct ag_technique_info info;
    for (int i = 0; ag_technique_get(i, &info); i++)
        if (strcmp(info.name, name) == 0) return true;
    return false;
}

static void name_techniques(const struct measure *measure, const struct paper_scene *scene,
                            struct scanline *line)
{
    static const char *const names[MEASURE_TECHNIQUES] = { "lpv", "holpv" };
    line->technique_count = 0;
    for (int i = 0; i < MEASURE_TECHNIQUES; i++) {
        if (!has_technique(names[i])) continue;
        struct measured *m = &line->techniques[line->technique_count++];
        char settings[96] = "";
        if (measure->paper_settings)
            snprintf(settings, sizeof settings, "cascades=1,bounces=0,dim=%d,steps=%d", scene->dim,
                     scene->steps);
        const char *more = measure->options ? measure->options : "";
        m->technique = names[i];
        snprintf(m->gi, sizeof m->gi, "%s%s%s%s%s", names[i], settings[0] || more[0] ? ":" : "",
                 settings, settings[0] && more[0] ? "," : "", more);
    }
}

static enum ag_result create_renderer(const struct measure *measure, struct ag_scene *loaded,
                                      const char *gi, int width, int height,
                                      struct ag_renderer **out)
{
    struct ag_renderer_desc desc;
    ag_renderer_desc_default(&desc);
    desc.width = width;
    desc.height = height;
    desc.gi = gi;
    desc.frame_options = "keep_maps=false";
    return ag_renderer_create(measure->bench->device, loaded, &desc, out);
}

// ---- scanlines

static void read_line(const struct measure *measure, struct ag_image *image, double *out)
{
    for (int i = 0; i < image->width; i++) out[i] = luminance(image->pixels + 3 * i);
    ag_image_destroy(measure->bench->context, image);
}

static enum ag_result trace_line(const struct measure *measure, const struct paper_scene *scene,
                                 struct ag_scene *loaded, const struct ag_camera *camera,
                                 struct scanline *line)
{
    struct ag_reference_desc desc;
    ag_reference_desc_default(&desc);
    desc.width = line->count;
    desc.height = 1;
    desc.camera = *camera;
    desc.bounces = scene->bounces;
    struct ag_reference *reference = NULL;
    struct ag_image *image = NULL;
    print_progress(scene, "path tracing the scanline");
    enum ag_result result = ag_reference_create(loaded, &desc, &reference);
    if (result == AG_OK) result = ag_reference_render(reference, measure->spp, NULL, NULL);
    if (result == AG_OK) result = ag_reference_read(reference, "irradiance_emitters_sky", &image);
    if (result == AG_OK) read_line(measure, image, line->reference);
    ag_reference_destroy(reference);
    return result;
}

static enum ag_result render_line(const struct measure *measure, struct ag_scene *loaded,
                                  const struct ag_camera *camera, int count, struct measured *m)
{
    struct ag_renderer *renderer = NULL;
    struct ag_frame_desc frame;
    struct ag_image *image = NULL;
    ag_frame_desc_default(&frame);
    frame.camera = *camera;
    enum ag_result result = create_renderer(measure, loaded, m->gi, count, 1, &renderer);
    if (result == AG_OK) result = ag_renderer_render(renderer, &frame);
    if (result == AG_OK) result = ag_renderer_read(renderer, "irradiance", &image);
    if (result == AG_OK) read_line(measure, image, m->lux);
    ag_renderer_destroy(renderer);
    return result;
}

// Pixels without a surface have an irradiance of 0 in both and do not count.
static double error_of(const double *lux, const double *reference, int count)
{
    double difference = 0, sum = 0;
    for (int i = 0; i < count; i++) {
        difference += fabs(lux[i] - reference[i]);
        sum += reference[i];
    }
    return sum > 0 ? difference / sum : 0;
}

// As in docs/metrics.md.
static double relmse_of(const double *lux, const double *reference, int count)
{
    double mean = 0, sum = 0;
    for (int i = 0; i < count; i++) mean += reference[i] / count;
    const double floor = mean > 0 ? 0.01 * mean * mean : 0.01;
    for (int i = 0; i < count; i++) {
        const double difference = lux[i] - reference[i];
        sum += difference * difference / (reference[i] * reference[i] + floor);
    }
    return sum / count;
}

enum ag_result measure_scanline(struct measure *measure, const struct paper_scene *scene,
                                struct ag_scene *loaded, struct scanline *out)
{
    struct ag_camera camera;
    *out = (struct scanline){ .count = MEASURE_COLUMNS };
    name_techniques(measure, scene, out);
    enum ag_result result = paper_scene_scan_camera(scene, loaded, out->count, &camera);
    if (result == AG_OK) result = trace_line(measure, scene, loaded, &camera, out);
    const float *from = scene->scan_from, *to = scene->scan_to;
    double length = hypot((double)(to[0] - from[0]), (double)(to[2] - from[2]));
    for (int i = 0; i < out->count; i++) {
        double at = (i + 0.5) / out->count;
        out->x[i] = paper_scene_scans_floor(scene) ? at * length : at * scene->width;
    }
    for (int t = 0; t < out->technique_count && result == AG_OK; t++) {
        struct measured *m = &out->techniques[t];
        result = render_line(measure, loaded, &camera, out->count, m);
        m->error = error_of(m->lux, out->reference, out->count);
        m->relmse = relmse_of(m->lux, out->reference, out->count);
        m->image_relmse = -1;
    }
    return result;
}

// ---- costs

static void add_pass(struct technique_cost *cost, const struct pass_time *pass,
                     const char *technique)
{
    const char *stage = passes_stage(pass->name, technique);
    if (strcmp(pass->name, "frame") == 0) cost->frame_ms = pass->median_ms;
    if (!stage) return;
    double *sum = strncmp(stage, "inject", 6) == 0 || strncmp(stage, "resolve", 7) == 0
                      ? &cost->inject_ms
                  : strncmp(stage, "propagate", 9) == 0 ? &cost->propagate_ms
                  : strncmp(stage, "apply", 5) == 0     ? &cost->apply_ms
                                                        : &cost->other_ms;
    *sum += pass->median_ms;
    cost->technique_ms += pass->median_ms;
}

static enum ag_result measure_cost(struct measure *measure, struct ag_scene *loaded,
                                   const struct ag_frame_desc *frame, struct measured *m)
{
    struct ag_renderer *renderer = NULL;
    struct pass_time passes[PASSES_MAX];
    int count = 0;
    enum ag_result result = create_renderer(measure, loaded, m->gi, measure->bench->width,
                                            measure->bench->height, &renderer);
    if (result == AG_OK)
        result = passes_measure(renderer, frame, measure->bench->frames, passes, &count);
    m->cost = (struct technique_cost){ 0 };
    for (int i = 0; i < count; i++) add_pass(&m->cost, &passes[i], m->technique);
    if (result == AG_OK) m->cost.bytes = bench_memory_of(renderer, m->technique);
    ag_renderer_destroy(renderer);
    return result;
}

enum ag_result measure_costs(struct measure *measure, const struct paper_scene *scene,
                             struct ag_scene *loaded, struct scanline *line)
{
    struct ag_frame_desc frame;
    ag_frame_desc_default(&frame);
    measure->bench->width = scene->width;
    measure->bench->height = scene->height;
    enum ag_result result = paper_scene_camera(scene, loaded, &frame.camera);
    for (int t = 0; t < line->technique_count && result == AG_OK; t++) {
        print_progress(scene, line->techniques[t].gi);
        result = measure_cost(measure, loaded, &frame, &line->techniques[t]);
    }
    return result;
}

// ---- images

static enum ag_result trace_image(const struct measure *measure, const struct paper_scene *scene,
                                  struct ag_scene *loaded, const struct ag_camera *camera,
                                  int height, struct ag_image **out)
{
    struct ag_reference_desc desc;
    ag_reference_desc_default(&desc);
    desc.width = measure->image_width;
    desc.height = height;
    desc.camera = *camera;
    desc.bounces = scene->bounces;
    struct ag_reference *reference = NULL;
    print_progress(scene, "path tracing the image");
    enum ag_result result = ag_reference_create(loaded, &desc, &reference);
    if (result == AG_OK) result = ag_reference_render(reference, measure->image_spp, NULL, NULL);
    if (result == AG_OK) result = ag_reference_read(reference, "color", out);
    ag_reference_destroy(reference);
    return result;
}

static enum ag_result render_image(const struct measure *measure, struct ag_scene *loaded,
                                   const struct ag_camera *camera, int height, const char *gi,
                                   float *ev, struct ag_image **out)
{
    struct ag_renderer *renderer = NULL;
    struct ag_frame_desc frame;
    ag_frame_desc_default(&frame);
    frame.camera = *camera;
    enum ag_result result =
        create_renderer(measure, loaded, gi, measure->image_width, height, &renderer);
    if (result == AG_OK) result = ag_renderer_render(renderer, &frame);
    if (result == AG_OK) result = ag_renderer_read(renderer, "color", out);
    if (result == AG_OK) result = ag_renderer_exposure(renderer, ev);
    ag_renderer_destroy(renderer);
    return result;
}

// Appends an image at the right of *all, which may be NULL; takes ownership of both.
static enum ag_result append(struct ag_context *context, struct ag_image **all,
                             struct ag_image *image)
{
    struct ag_image *joined = NULL;
    if (!*all) {
        *all = image;
        return AG_OK;
    }
    enum ag_result result = ag_image_side_by_side(context, *all, image, 4, &joined);
    ag_image_destroy(context, *all);
    ag_image_destroy(context, image);
    *all = joined;
    return result;
}

static enum ag_result compare_image(struct ag_context *context, const struct ag_image *image,
                                    const struct ag_image *reference, double *relmse)
{
    struct ag_compare_desc desc;
    struct ag_metrics metrics;
    ag_compare_desc_default(&desc);
    desc.radiance = true;
    const enum ag_result result = ag_image_metrics(context, image, reference, &desc, &metrics);
    if (result == AG_OK) *relmse = metrics.relmse;
    return result;
}

enum ag_result measure_image(struct measure *measure, const struct paper_scene *scene,
                             struct ag_scene *loaded, struct scanline *line, struct ag_image **out)
{
    int height = measure->image_width * scene->height / scene->width;
    struct ag_camera camera;
    struct ag_image *all = NULL, *images[1 + MEASURE_TECHNIQUES] = { NULL };
    float ev = 0;
    *out = NULL;
    enum ag_result result = paper_scene_camera(scene, loaded, &camera);
    if (result == AG_OK) result = trace_image(measure, scene, loaded, &camera, height, &images[0]);
    for (int t = 0; t < line->technique_count && result == AG_OK; t++) {
        struct measured *m = &line->techniques[t];
        result = render_image(measure, loaded, &camera, height, m->gi, &ev, &images[1 + t]);
        if (result == AG_OK)
            result =
                compare_image(measure->bench->context, images[1 + t], images[0], &m->image_relmse);
    }
    for (int i = 0; i <= line->technique_count; i++) {
        if (result == AG_OK)
            result = append(measure->bench->context, &all, images[i]);
        else
            ag_image_destroy(measure->bench->context, images[i]);
    }
    if (result == AG_OK) result = ag_image_tonemap(measure->bench->context, all, ev, out);
    ag_image_destroy(measure->bench->context, all);
    return result;
}
