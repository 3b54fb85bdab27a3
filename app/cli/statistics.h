// Pass times of frames, and the JSON of --stats.
#pragma once

#include "cli/files/json.h"
#include "session.h"

enum { MAX_PASSES = 128 };

struct pass_times {
    char name[48];
    double *ms; // [count]
    int count, capacity;
};

struct statistics {
    struct pass_times passes[MAX_PASSES];
    int pass_count;
    int frames; // that were added
};

// Adds the newest frame's times; waits for the GPU. False: out of memory.
bool statistics_add(struct statistics *statistics, struct ag_renderer *renderer);
void statistics_finish(struct statistics *statistics); // accepts zero
// {"median": …, "p95": …}: nulls without times. Sorts the times.
json_t *statistics_summary(struct pass_times *times);
// Parts of the document of --stats. NULL: out of memory.
json_t *statistics_passes(struct statistics *statistics);       // all but the whole frame
json_t *statistics_frame(struct statistics *statistics);        // the whole frame's summary
json_t *statistics_options(const struct ag_renderer *renderer); // of each technique
json_t *statistics_memory(struct ag_renderer *renderer);        // bytes by owner
// The document of --stats; NULL: out of memory. Its `frames` counts all rendered frames.
struct bakes;
json_t *statistics_json(struct statistics *statistics, const struct session *session,
                        struct ag_device *device, struct ag_renderer *renderer,
                        const struct bakes *bakes);
