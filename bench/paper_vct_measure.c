#include "paper_vct_measure.h"

#include <math.h>
#include <string.h>

enum { MOST_PASSES = 64, MOST_OWNERS = 32 };

// Of the device, and so of all renderers that there are.
static uint64_t vct_bytes(struct ag_renderer *renderer)
{
    struct ag_memory owners[MOST_OWNERS];
    int count = ag_renderer_memory(renderer, owners, MOST_OWNERS);
    for (int i = 0; i < count && i < MOST_OWNERS; i++)
        if (strcmp(owners[i].owner, "vct") == 0) return owners[i].bytes;
    return 0;
}

static bool stage_has(const char *const *passes, const char *name)
{
    for (; *passes; passes++) {
        size_t length = strlen(*passes);
        bool all = length > 0 && (*passes)[length - 1] == '.';
        if (all ? strncmp(*passes, name, length) == 0 : strcmp(*passes, name) == 0) return true;
    }
    return false;
}

static void keep_least(const struct vct_measurement *how, int method, struct ag_renderer *renderer,
                       struct vct_method *out)
{
    struct ag_timing timings[MOST_PASSES];
    int count = ag_renderer_timings(renderer, timings, MOST_PASSES);
    double all = 0.0;
    for (int s = 0; s < how->stage_count; s++) {
        double ms = 0.0;
        for (int i = 0; i < count && i < MOST_PASSES; i++)
            if (stage_has(how->stages[s].passes[method], timings[i].name)) ms += timings[i].ms;
        out->ms[s] = fmin(out->ms[s], ms);
        all += ms;
    }
    out->all_ms = fmin(out->all_ms, all);
}

static enum ag_result open(const struct vct_measurement *how, int method,
                           struct ag_renderer **renderer)
{
    struct ag_renderer_desc desc;
    ag_renderer_desc_default(&desc);
    desc.width = how->width;
    desc.height = how->height;
    desc.gi = how->gi[method];
    desc.frame_options = "keep_maps=false"; // as if all moved
    return ag_renderer_create(how->device, how->scene, &desc, renderer);
}

enum ag_result vct_measure(const struct vct_measurement *how, struct vct_method out[VCT_METHODS])
{
    struct ag_renderer *renderers[VCT_METHODS] = { NULL };
    uint64_t before = 0;
    enum ag_result result = AG_OK;
    for (int m = 0; m < VCT_METHODS && result == AG_OK; m++) {
        result = open(how, m, &renderers[m]);
        if (result != AG_OK) break;
        uint64_t bytes = vct_bytes(renderers[m]);
        out[m] = (struct vct_method){ .all_ms = INFINITY, .bytes = bytes - before };
        for (int s = 0; s < VCT_MOST_STAGES; s++) out[m].ms[s] = INFINITY;
        before = bytes;
    }
    for (int f = 0; f <= how->frames; f++)
        for (int m = 0; m < VCT_METHODS && result == AG_OK; m++) {
            result = ag_renderer_render(renderers[m], how->frame);
            if (result == AG_OK) result = ag_renderer_wait(renderers[m]);
            if (result == AG_OK && f > 0) keep_least(how, m, renderers[m], &out[m]);
        }
    for (int m = 0; m < VCT_METHODS; m++) ag_renderer_destroy(renderers[m]);
    return result;
}
