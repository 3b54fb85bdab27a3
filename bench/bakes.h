// Bakes for benchmarks: cached ones, or runs that are then cached.
#pragma once

#include <afterglow/afterglow.h>

enum { BENCH_MAX_BAKES = 3 };

struct bench_bakes {
    struct ag_bake *owned[BENCH_MAX_BAKES];
    const struct ag_bake *bakes[BENCH_MAX_BAKES]; // for ag_renderer_desc
    int count;
    bool run; // at least one was run, not loaded
};
// Those that the techniques of `gi` need. Finish in any case.
enum ag_result bench_bakes_prepare(struct bench_bakes *bakes, struct ag_context *context,
                                   struct ag_scene *scene, const char *gi);
void bench_bakes_finish(struct bench_bakes *bakes);
