// Times by pass, collected frame by frame and then summed up.
#include "passes.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct samples {
    double ms[PASSES_MAX][PASSES_MAX_FRAMES];
};

static int place_of(struct pass_time *passes, int *count, const char *name)
{
    for (int i = 0; i < *count; i++)
        if (strcmp(passes[i].name, name) == 0) return i;
    if (*count == PASSES_MAX) return -1;
    passes[*count] = (struct pass_time){ 0 };
    snprintf(passes[*count].name, sizeof passes->name, "%.*s", (int)sizeof passes->name - 1, name);
    return (*count)++;
}

static int by_value(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static void sum_up(struct pass_time *pass, double *ms)
{
    int count = pass->count;
    qsort(ms, (size_t)count, sizeof *ms, by_value);
    pass->median_ms = 0.5 * (ms[(count - 1) / 2] + ms[count / 2]);
    pass->p95_ms = ms[(95 * count + 99) / 100 - 1];
}

static enum ag_result render(struct ag_renderer *renderer, const struct ag_frame_desc *frame)
{
    enum ag_result result = ag_renderer_render(renderer, frame);
    return result == AG_OK ? ag_renderer_wait(renderer) : result;
}

enum ag_result passes_measure(struct ag_renderer *renderer, const struct ag_frame_desc *frame,
                              int frames, struct pass_time out[PASSES_MAX], int *count)
{
    *count = 0;
    struct samples *samples = malloc(sizeof *samples);
    if (!samples) return AG_ERROR_MEMORY;
    enum ag_result result = AG_OK;
    for (int f = 0; f <= frames && result == AG_OK; f++) {
        struct ag_timing timings[PASSES_MAX];
        result = render(renderer, frame);
        if (result != AG_OK || f == 0) continue;
        int timed = ag_renderer_timings(renderer, timings, PASSES_MAX);
        for (int i = 0; i < timed && i < PASSES_MAX; i++) {
            int place = place_of(out, count, timings[i].name);
            if (place >= 0 && out[place].count < PASSES_MAX_FRAMES)
                samples->ms[place][out[place].count++] = timings[i].ms;
        }
    }
    for (int i = 0; i < *count; i++) sum_up(&out[i], samples->ms[i]);
    free(samples);
    return result;
}
