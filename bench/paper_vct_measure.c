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

static void add_sample(void *user, int method, const struct ag_timing *timings, int count)
{
    const struct samples *samples = user;
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
    if (result == AG_OK)
        result = passes_alternate(renderers, VCT_METHODS, measurement->frame,
                                  measurement->bench->frames, add_sample, &samples);
    for (int m = 0; m < VCT_METHODS; m++) ag_renderer_destroy(renderers[m]);
    return result;
}
