#include "paper_ort/measure.h"

#include <math.h>
#include <string.h>
#include <time.h>

enum { BIN_TEXELS = 1024 * 1024, COLOURS = 3, COPY_RUNS = 5 };

const char *const ort_stages[ORT_STAGES] = {
    [STAGE_DIRECT] = "direct", [STAGE_SPREAD] = "spread", [STAGE_PREFILTER] = "prefilter",
    [STAGE_GATHER] = "gather", [STAGE_FINISH] = "finish", [STAGE_LIGHT_MAP] = "light_map",
};
const struct ort_variant ort_variants[ORT_VARIANTS] = {
    { "tiles", "half" }, { "tiles", "byte" }, { "slices", "half" }, { "slices", "byte" }
};

// ---- the view

// Sky light arrives by the rays of the bake, not by transfer maps, and would hide their error.
static enum ag_result remove_sky(struct ag_scene *scene)
{
    static const float black[3] = { 0.0f, 0.0f, 0.0f };
    struct ag_scene_info info;
    const enum ag_result result = ag_scene_get_info(scene, 0, 0.0, &info);
    if (result != AG_OK || (info.lights == 0 && !info.emissive)) return result;
    return ag_scene_set_sky(scene, black);
}

// Exposure and power of pixels with a surface.
static enum ag_result measure_reference(struct ort_view *view)
{
    struct ag_context *context = view->bench->context;
    const struct ag_image *from = view->reference;
    struct ag_image *masked = NULL;
    const enum ag_result result = ag_image_create(context, from->width, from->height, 4, &masked);
    double squares = 0.0, count = 0.0;
    for (int i = 0; result == AG_OK && i < from->width * from->height; i++) {
        const bool counts = view->mask->pixels[i] > 0.0f;
        for (int c = 0; c < 3; c++) {
            const float value = from->pixels[3 * i + c];
            masked->pixels[4 * i + c] = value;
            if (counts) squares += (double)value * (double)value;
        }
        masked->pixels[4 * i + 3] = counts ? 1.0f : 0.0f;
        count += counts ? 3.0 : 0.0;
    }
    view->power = squares / count;
    if (result == AG_OK) view->ev = ag_image_auto_exposure(masked);
    ag_image_destroy(context, masked);
    return result;
}

static enum ag_result trace(struct ort_view *view, const char *name, int spp)
{
    struct ag_reference_desc desc;
    struct ag_reference *reference = NULL;
    ag_reference_desc_default(&desc);
    desc.width = view->bench->width;
    desc.height = view->bench->height;
    desc.camera = view->frame.camera;
    fprintf(stderr, "%s: path tracing\n", name);
    enum ag_result result = ag_reference_create(view->scene, &desc, &reference);
    if (result == AG_OK) result = ag_reference_render(reference, spp, NULL, NULL);
    if (result == AG_OK)
        result = ag_reference_read(reference, "irradiance_emitters_sky", &view->reference);
    if (result == AG_OK) result = ag_reference_read(reference, "depth", &view->mask);
    ag_reference_destroy(reference);
    return result == AG_OK ? measure_reference(view) : result;
}

enum ag_result ort_view_open(struct ort_view *view, const char *scene, int spp)
{
    enum ag_result result = bench_open_scene(view->bench, scene, &view->scene, &view->frame);
    if (result == AG_OK) result = remove_sky(view->scene);
    return result == AG_OK && spp > 0 ? trace(view, scene, spp) : result;
}

void ort_view_close(struct ort_view *view)
{
    ag_image_destroy(view->bench->context, view->reference);
    ag_image_destroy(view->bench->context, view->mask);
    ag_scene_destroy(view->scene);
}

// ---- errors

static double mean_of(const double rgb[3])
{
    return (rgb[0] + rgb[1] + rgb[2]) / 3.0;
}

static enum ag_result measure_error(const struct ort_view *view, struct ag_renderer *renderer,
                                    struct ort_error *out)
{
    const double none = (double)NAN;
    struct ag_context *context = view->bench->context;
    struct ag_compare_desc desc;
    struct ag_image *image = NULL;
    struct ag_metrics metrics;
    *out = (struct ort_error){ none, none, none, none };
    if (!view->reference) return AG_OK;
    ag_compare_desc_default(&desc);
    desc.radiance = true;
    desc.ev = view->ev;
    desc.mask = view->mask;
    enum ag_result result = ag_renderer_read(renderer, "irradiance", &image);
    if (result == AG_OK)
        result = ag_image_metrics(context, image, view->reference, &desc, &metrics);
    if (result == AG_OK)
        *out = (struct ort_error){ sqrt(metrics.mse / view->power), metrics.relmse, metrics.flip,
                                   mean_of(metrics.mean_a) / mean_of(metrics.mean_b) };
    ag_image_destroy(context, image);
    return result;
}

enum ag_result ort_error_of(const struct ort_view *view, const char *gi, struct ort_error *out)
{
    struct ag_renderer *renderer = NULL;
    enum ag_result result = bench_create_renderer(view->bench, view->scene, gi, NULL, &renderer);
    if (result == AG_OK) result = ag_renderer_render(renderer, &view->frame);
    if (result == AG_OK) result = measure_error(view, renderer, out);
    ag_renderer_destroy(renderer);
    return result;
}

// ---- a setting

static void print_gi(const struct ort_view *view, const struct ort_setting *setting, int variant,
                     char out[GI_SIZE])
{
    snprintf(out, GI_SIZE, "ort:texels=%d,offsets=%d,order=%s,precision=%s%s%s",
             setting->map.texels_option, setting->offsets, ort_variants[variant].order,
             ort_variants[variant].precision, view->options ? "," : "",
             view->options ? view->options : "");
}

static double processor_s(void)
{
    struct timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static enum ag_result bake(const struct ort_view *view, struct ort_setting *setting,
                           struct bench_bakes *bakes)
{
    char gi[GI_SIZE];
    struct ag_bake_info info;
    print_gi(view, setting, 0, gi);
    const double begun = processor_s();
    enum ag_result result = bench_bakes_prepare(bakes, view->bench->context, view->scene, gi);
    setting->processor_s = bakes->run ? processor_s() - begun : (double)NAN;
    if (result == AG_OK) result = ag_bake_get_info(bakes->owned[0], &info);
    if (result == AG_OK) setting->bake_s = info.seconds;
    return result;
}

// Shadow maps and light maps are rendered in each frame.
static enum ag_result create(const struct ort_view *view, struct ort_setting *setting,
                             struct ag_renderer *renderers[ORT_VARIANTS])
{
    struct bench_bakes bakes;
    enum ag_result result = bake(view, setting, &bakes);
    for (int v = 0; v < ORT_VARIANTS && result == AG_OK; v++) {
        char gi[GI_SIZE];
        print_gi(view, setting, v, gi);
        result = bench_create_baked(view->bench, view->scene, gi, "keep_maps=false", &bakes,
                                    &renderers[v]);
        if (result == AG_OK) setting->results[v].bytes = bench_memory_of(renderers[v], "ort");
    }
    bench_bakes_finish(&bakes);
    return result;
}

// Halves and bytes of an order differ by the bins alone, by a byte for each texel and colour.
static void count_bins(struct ort_setting *setting)
{
    for (int v = 0; v < ORT_VARIANTS; v++) {
        struct ort_result *half = &setting->results[v / 2 * 2], *byte = half + 1;
        const uint64_t difference = half->bytes - byte->bytes;
        setting->results[v].bins = (int)(difference / (COLOURS * BIN_TEXELS));
        setting->results[v].map_bytes = v % 2 == 0 ? 2 * difference : difference;
    }
}

struct least {
    double (*stage_ms)[ORT_STAGES]; // by renderer
};

static void keep_least(void *user, int index, const struct ag_timing *timings, int count)
{
    const struct least *least = user;
    for (int i = 0; i < count; i++) {
        const char *stage = passes_stage(timings[i].name, "ort");
        for (int s = 0; stage && s < ORT_STAGES; s++)
            if (strcmp(stage, ort_stages[s]) == 0)
                passes_keep_least(&least->stage_ms[index][s], timings[i].ms);
    }
}

static enum ag_result measure_times(const struct ort_view *view, struct ort_setting *setting,
                                    struct ag_renderer *const *renderers)
{
    double stage_ms[ORT_VARIANTS][ORT_STAGES] = { { 0.0 } };
    struct least least = { stage_ms };
    const enum ag_result result = passes_alternate(renderers, ORT_VARIANTS, &view->frame,
                                                   view->bench->frames, keep_least, &least);
    for (int v = 0; v < ORT_VARIANTS; v++)
        memcpy(setting->results[v].stage_ms, stage_ms[v], sizeof stage_ms[v]);
    return result;
}

static bool measure_copies(const struct ort_view *view, struct ort_setting *setting)
{
    for (int v = 0; v < ORT_VARIANTS; v++) {
        struct ort_result *r = &setting->results[v];
        r->copy = (struct copy_time){ (double)NAN, (double)NAN };
        if (view->bench->info.software &&
            !copy_measure((size_t)r->map_bytes, view->threads, COPY_RUNS, &r->copy))
            return false;
    }
    return true;
}

enum ag_result ort_setting_measure(const struct ort_view *view, struct ort_setting *setting)
{
    struct ag_renderer *renderers[ORT_VARIANTS] = { NULL };
    enum ag_result result = create(view, setting, renderers);
    if (result == AG_OK) count_bins(setting);
    if (result == AG_OK) result = measure_times(view, setting, renderers);
    for (int v = 0; v < ORT_VARIANTS && result == AG_OK; v++)
        result = measure_error(view, renderers[v], &setting->results[v].error);
    for (int v = 0; v < ORT_VARIANTS; v++) ag_renderer_destroy(renderers[v]);
    if (result == AG_OK && !measure_copies(view, setting)) result = AG_ERROR_MEMORY;
    return result;
}

// ---- lights

// On a sphere about the bounds, by the golden angle.
static enum ag_result add_lights(struct ag_scene *scene, int count)
{
    struct ag_scene_info info;
    enum ag_result result = ag_scene_get_info(scene, 0, 0.0, &info);
    if (result == AG_OK) result = ag_scene_remove_lights(scene);
    float centre[3], radius = 0.0f;
    for (int a = 0; a < 3 && result == AG_OK; a++) {
        centre[a] = 0.5f * (info.bounds_min[a] + info.bounds_max[a]);
        radius += powf(info.bounds_max[a] - info.bounds_min[a], 2.0f);
    }
    radius = sqrtf(radius);
    for (int i = 0; i < count && result == AG_OK; i++) {
        struct ag_light_desc light;
        ag_light_desc_default(&light, AG_LIGHT_POINT);
        const float y = 1.0f - (2.0f * (float)i + 1.0f) / (float)count,
                    angle = 2.39996323f * (float)i, // the golden angle, π(3 − √5)
            across = sqrtf(1.0f - y * y);
        const float to[3] = { across * cosf(angle), y, across * sinf(angle) };
        for (int a = 0; a < 3; a++) {
            light.position[a] = centre[a] + radius * to[a];
            light.intensity[a] = 100.0f * radius * radius;
        }
        result = ag_scene_add_light(scene, &light, NULL);
    }
    return result;
}

enum ag_result ort_lights_measure(const struct ort_view *view, const struct ort_setting *setting,
                                  int lights, double stage_ms[ORT_STAGES])
{
    char gi[GI_SIZE];
    struct ag_renderer *renderer = NULL;
    double least_ms[1][ORT_STAGES] = { { 0.0 } };
    struct least least = { least_ms };
    print_gi(view, setting, 0, gi);
    enum ag_result result = add_lights(view->scene, lights);
    if (result == AG_OK)
        result = bench_create_renderer(view->bench, view->scene, gi,
                                       "keep_maps=false,shadow_size=128", &renderer);
    if (result == AG_OK)
        result =
            passes_alternate(&renderer, 1, &view->frame, view->bench->frames, keep_least, &least);
    memcpy(stage_ms, least_ms[0], sizeof least_ms[0]);
    ag_renderer_destroy(renderer);
    return result;
}
