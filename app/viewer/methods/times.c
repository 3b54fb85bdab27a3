#include "times.h"

#include <stdio.h>
#include <string.h>

static int find_pass(struct times *times, const char *name)
{
    for (int i = 0; i < times->count; i++)
        if (strcmp(times->names[i], name) == 0) return i;
    if (times->count == VIEWER_PASSES) return -1;
    snprintf(times->names[times->count], sizeof times->names[0], "%.47s", name);
    return times->count++;
}

void times_add(struct viewer *v)
{
    struct ag_timing timings[VIEWER_PASSES];
    struct ag_finished_frame finished;
    struct times *times = &v->times;
    if (ag_renderer_finished(v->main.renderer, &finished) != AG_OK ||
        finished.frame == times->frame)
        return;
    const int count = ag_renderer_finished_timings(v->main.renderer, timings, VIEWER_PASSES);
    times->frame = finished.frame;
    times->newest = (times->newest + 1) % VIEWER_HISTORY;
    if (times->frames < VIEWER_HISTORY) times->frames++;
    times->frame_ms[times->newest] = 0;
    for (int i = 0; i < VIEWER_PASSES; i++) times->ms[i][times->newest] = 0;
    for (int i = 0; i < count && i < VIEWER_PASSES; i++) {
        if (strcmp(timings[i].name, "frame") == 0) {
            times->frame_ms[times->newest] = (float)timings[i].ms;
            continue;
        }
        const int pass = find_pass(times, timings[i].name);
        if (pass >= 0) times->ms[pass][times->newest] += (float)timings[i].ms;
    }
}
