#include "pace.h"

#include <stdlib.h>
#include <string.h>

void pace_clear(struct pace *pace)
{
    pace->count = 0;
}

void pace_add(struct pace *pace, float ms)
{
    if (pace->count < PACE_FRAMES) pace->ms[pace->count++] = ms;
}

static int shorter(const void *a, const void *b)
{
    const float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

void pace_get(const struct pace *pace, struct pace_summary *out)
{
    float sorted[PACE_FRAMES];
    double sum = 0;
    memset(out, 0, sizeof *out);
    out->frames = pace->count;
    if (pace->count == 0) return;
    memcpy(sorted, pace->ms, (size_t)pace->count * sizeof *sorted);
    qsort(sorted, (size_t)pace->count, sizeof *sorted, shorter);
    for (int i = 0; i < pace->count; i++) sum += (double)sorted[i];
    out->mean_ms = (float)(sum / pace->count);
    out->p95_ms = sorted[(pace->count - 1) * 95 / 100];
    out->most_ms = sorted[pace->count - 1];
}
