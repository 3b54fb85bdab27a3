#include "paper_prt/times.h"

#include "paper_prt/report.h"

#include <stdlib.h>
#include <string.h>

enum { GI_SIZE = 1024, COEFFICIENTS = 25 };

const char *const prt_passes[PRT_PASSES] = { "rows", "light", "light_map", "reflect", "apply" };
const struct prt_variant prt_variants[PRT_VARIANTS] = {
    { "diffuse", false, "none" },
    { "diffuse, cpca", false, "cpca" },
    { "glossy", true, "none" },
    { "glossy, cpca", true, "cpca" },
};

// ---- renderers

// Times do not depend on the noise of few rays.
static void print_gi(int texels, const struct prt_variant *variant, const char *options,
                     char out[GI_SIZE])
{
    snprintf(out, GI_SIZE,
             "prt:coefficients=%d,transfer=shadowed,texels=%d,glossy=%s,compression=%s,%s",
             COEFFICIENTS, texels, variant->glossy ? "true" : "false", variant->compression,
             options ? options : "rays=64");
}

// Compressed bakes say how many texels there are.
static enum ag_result count_points(struct ag_bake *bake, double *points)
{
    const char *json = NULL;
    const enum ag_result result = ag_bake_report(bake, &json);
    if (result == AG_OK) *points = report_number_of(json, "vector_bytes") / (2.0 * COEFFICIENTS);
    return result;
}

static enum ag_result create(const struct prt_view *view, const char *options, int v,
                             struct prt_times *out, struct ag_renderer **renderer)
{
    char gi[GI_SIZE];
    struct bench_bakes bakes;
    print_gi(out->texels, &prt_variants[v], options, gi);
    enum ag_result result = bench_bakes_prepare(&bakes, view->bench->context, view->scene, gi);
    if (result == AG_OK && strcmp(prt_variants[v].compression, "none") != 0)
        result = count_points(bakes.owned[0], &out->points);
    if (result == AG_OK)
        result = bench_create_baked(view->bench, view->scene, gi, NULL, &bakes, renderer);
    if (result == AG_OK) out->bytes[v] = bench_memory_of(*renderer, "prt");
    bench_bakes_finish(&bakes);
    return result;
}

// ---- frames

struct samples {
    double ms[PRT_VARIANTS][PRT_PASSES][PASSES_MAX_FRAMES];
};

static void add_sample(struct ag_renderer *renderer, double (*ms)[PASSES_MAX_FRAMES], int frame)
{
    struct ag_timing timings[PASSES_MAX];
    int count = ag_renderer_timings(renderer, timings, PASSES_MAX);
    if (count > PASSES_MAX) count = PASSES_MAX;
    for (int i = 0; i < count; i++) {
        const char *stage = passes_stage(timings[i].name, "prt");
        for (int p = 0; p < PRT_PASSES && stage; p++)
            if (strcmp(stage, prt_passes[p]) == 0) ms[p][frame] += timings[i].ms;
    }
}

// The frames of all renderers alternate; the first ones are discarded.
static enum ag_result render_frames(struct prt_view *view, struct ag_renderer *const *renderers,
                                    struct samples *samples)
{
    static const float STEP = 0.1f; // radians
    enum ag_result result = AG_OK;
    for (int f = 0; f <= view->bench->frames && result == AG_OK; f++) {
        result = prt_view_turn(view, STEP * (float)f);
        for (int v = 0; v < PRT_VARIANTS && result == AG_OK; v++) {
            result = ag_renderer_render(renderers[v], &view->frame);
            if (result == AG_OK) result = ag_renderer_wait(renderers[v]);
            if (result == AG_OK && f > 0) add_sample(renderers[v], samples->ms[v], f - 1);
        }
    }
    return result;
}

static int by_value(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static double median_of(double *ms, int count)
{
    qsort(ms, (size_t)count, sizeof *ms, by_value);
    return 0.5 * (ms[(count - 1) / 2] + ms[count / 2]);
}

static enum ag_result measure(struct prt_view *view, struct ag_renderer *const *renderers,
                              struct prt_times *out)
{
    struct samples *samples = calloc(1, sizeof *samples);
    if (!samples) return AG_ERROR_MEMORY;
    const enum ag_result result = render_frames(view, renderers, samples);
    for (int v = 0; v < PRT_VARIANTS; v++)
        for (int p = 0; p < PRT_PASSES; p++)
            out->pass_ms[v][p] = median_of(samples->ms[v][p], view->bench->frames);
    free(samples);
    return result;
}

enum ag_result prt_times_measure(struct prt_view *view, const char *options, struct prt_times *out)
{
    struct ag_renderer *renderers[PRT_VARIANTS] = { NULL };
    enum ag_result result = AG_OK;
    for (int v = 0; v < PRT_VARIANTS && result == AG_OK; v++)
        result = create(view, options, v, out, &renderers[v]);
    if (result == AG_OK) result = measure(view, renderers, out);
    for (int v = 0; v < PRT_VARIANTS; v++) ag_renderer_destroy(renderers[v]);
    return result;
}
