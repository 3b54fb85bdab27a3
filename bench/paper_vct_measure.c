#include "paper_vct_measure.h"

#include <math.h>
#include <string.h>

static bool stage_has(const char *const *passes, const char *name)
{
    for (; *passes; passes++) {
        size_t length = strlen(*passes);
        bool prefix = length > 0 && (*passes)[length - 1] == '.';
        if (prefix ? strncmp(*passes, name, length) == 0 : strcmp(*passes, name) == 0) return true;
    }
    return false;
}

struct samples {
    const struct vct_measurement *measurement;
    struct vct_method *methods;
};

static void add_sample(struct samples *samples, int method, const struct ag_timing *timings,
                       int count)
{
    const struct vct_measurement *measurement = samples->measurement;
    struct vct_method *out = &samples->methods[method];
    double total = 0.0;
    for (int s = 0; s < measurement->stage_count; s++) {
        double ms = 0.0;
        for (int i = 0; i < count; i++)
            if (stage_has(measurement->stages[s].passes[method], timings[i].name))
                ms += timings[i].ms;
        out->ms[s] = fmin(out->ms[s], ms);
        total += ms;
    }
    out->total_ms = fmin(out->total_ms, total);
}

// A material that is set again makes the next frame voxelize all of the scene.
static enum ag_result voxelize_again(struct ag_scene *scene)
{
    struct ag_material_info info;
    const enum ag_result result = ag_scene_get_material(scene, 0, &info);
    info.material.alpha_mode = AG_ALPHA_DEFAULT;
    return result == AG_OK ? ag_scene_set_material(scene, 0, &info.material) : result;
}

// The first frame of each method is not a sample.
static enum ag_result render_in_turn(struct ag_renderer *const renderers[VCT_METHODS],
                                     struct samples *samples)
{
    const struct vct_measurement *measurement = samples->measurement;
    enum ag_result result = AG_OK;
    for (int f = 0; f <= measurement->bench->frames; f++)
        for (int m = 0; m < VCT_METHODS && result == AG_OK; m++) {
            struct ag_timing timings[PASSES_MAX];
            result = voxelize_again(measurement->scene);
            if (result == AG_OK) result = ag_renderer_render(renderers[m], measurement->frame);
            if (result == AG_OK) result = ag_renderer_wait(renderers[m]);
            if (result != AG_OK || f == 0) continue;
            const int count = ag_renderer_timings(renderers[m], timings, PASSES_MAX);
            add_sample(samples, m, timings, count < PASSES_MAX ? count : PASSES_MAX);
        }
    return result;
}

enum ag_result vct_measure(const struct vct_measurement *measurement,
                           struct vct_method out[VCT_METHODS])
{
    struct ag_renderer *renderers[VCT_METHODS] = { NULL };
    struct samples samples = { measurement, out };
    uint64_t previous = 0;
    enum ag_result result = AG_OK;
    for (int m = 0; m < VCT_METHODS && result == AG_OK; m++) {
        result = bench_create_renderer(measurement->bench, measurement->scene, measurement->gi[m],
                                       "keep_maps=false", &renderers[m]);
        if (result != AG_OK) break;
        uint64_t bytes = bench_memory_of(renderers[m], "vct");
        out[m] = (struct vct_method){ .total_ms = INFINITY, .bytes = bytes - previous };
        for (int s = 0; s < VCT_MAX_STAGES; s++) out[m].ms[s] = INFINITY;
        previous = bytes;
    }
    if (result == AG_OK) result = render_in_turn(renderers, &samples);
    for (int m = 0; m < VCT_METHODS; m++) ag_renderer_destroy(renderers[m]);
    return result;
}
