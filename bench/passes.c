#include "passes.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct collection {
    struct pass_time *passes;
    int *count;
    double ms[PASSES_MAX][PASSES_MAX_FRAMES];
};

static int index_of(struct collection *c, const char *name)
{
    for (int i = 0; i < *c->count; i++)
        if (strcmp(c->passes[i].name, name) == 0) return i;
    if (*c->count == PASSES_MAX) return -1;
    struct pass_time *pass = &c->passes[*c->count];
    *pass = (struct pass_time){ 0 };
    snprintf(pass->name, sizeof pass->name, "%.*s", (int)sizeof pass->name - 1, name);
    return (*c->count)++;
}

static void collect(void *user, int index, const struct ag_timing *timings, int count)
{
    struct collection *c = (struct collection *)user + index;
    for (int i = 0; i < count; i++) {
        const int p = index_of(c, timings[i].name);
        if (p >= 0 && c->passes[p].count < PASSES_MAX_FRAMES)
            c->ms[p][c->passes[p].count++] = timings[i].ms;
    }
}

static int by_value(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static void summarize(struct pass_time *pass, double *ms)
{
    int count = pass->count;
    qsort(ms, (size_t)count, sizeof *ms, by_value);
    pass->median_ms = 0.5 * (ms[(count - 1) / 2] + ms[count / 2]);
    pass->p95_ms = ms[(95 * count + 99) / 100 - 1];
}

enum ag_result passes_measure_all(struct ag_renderer *const *renderers, int renderer_count,
                                  const struct ag_frame_desc *frame, int frames,
                                  struct pass_time (*out)[PASSES_MAX], int *counts)
{
    struct collection *all = calloc((size_t)renderer_count, sizeof *all);
    if (!all) return AG_ERROR_MEMORY;
    for (int r = 0; r < renderer_count; r++) {
        counts[r] = 0;
        all[r].passes = out[r];
        all[r].count = &counts[r];
    }
    enum ag_result result =
        passes_alternate(renderers, renderer_count, frame, frames, collect, all);
    for (int r = 0; r < renderer_count; r++)
        for (int i = 0; i < counts[r]; i++) summarize(&out[r][i], all[r].ms[i]);
    free(all);
    return result;
}

enum ag_result passes_measure(struct ag_renderer *renderer, const struct ag_frame_desc *frame,
                              int frames, struct pass_time out[PASSES_MAX], int *count)
{
    return passes_measure_all(&renderer, 1, frame, frames, (struct pass_time(*)[PASSES_MAX])out,
                              count);
}

enum ag_result passes_alternate(struct ag_renderer *const *renderers, int renderer_count,
                                const struct ag_frame_desc *frame, int frames, passes_sample sample,
                                void *user)
{
    enum ag_result result = AG_OK;
    for (int f = 0; f <= frames; f++)
        for (int r = 0; r < renderer_count && result == AG_OK; r++) {
            struct ag_timing timings[PASSES_MAX];
            result = ag_renderer_render(renderers[r], frame);
            if (result == AG_OK) result = ag_renderer_wait(renderers[r]);
            if (result != AG_OK || f == 0) continue;
            const int count = ag_renderer_timings(renderers[r], timings, PASSES_MAX);
            sample(user, r, timings, count < PASSES_MAX ? count : PASSES_MAX);
        }
    return result;
}

const char *passes_stage(const char *pass, const char *gi)
{
    const size_t length = strcspn(gi, ":");
    const bool owned = strncmp(pass, gi, length) == 0 && pass[length] == '.';
    return owned ? pass + length + 1 : NULL;
}

void passes_of_stages(const struct pass_time *passes, int count, const char *gi,
                      const char *const *names, int name_count, double *out_ms)
{
    for (int n = 0; n < name_count; n++) {
        out_ms[n] = 0.0;
        for (int i = 0; i < count; i++) {
            const char *stage = passes_stage(passes[i].name, gi);
            if (stage && strcmp(stage, names[n]) == 0) out_ms[n] = passes[i].median_ms;
        }
    }
}

void passes_keep_least(double *least, double ms)
{
    if (*least == 0.0 || ms < *least) *least = ms;
}
