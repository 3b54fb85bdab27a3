// The closing of seams: places of the light map beside seams show weighted sums of texels.
#pragma once

#include "scene/charts/seams.h"
#include "trace/trace_scene.h"

// λ: differences of noise that lookups can represent poorly remain with √λ/2 of it at most.
#define SEAM_CLOSING_LAMBDA 0.005

struct seam_closing_scratch;

// seam_closing_finish accepts zero.
struct seam_closing {
    struct host *host;
    const struct charts *charts;
    const struct trace_scene *trace;
    struct chart_seams seams; // without points that a wall divides
    uint32_t *first;          // [places + 1] of the place, in `points`
    uint32_t *points;         // those at each place
};
// trace: of the same pose; outlives it.
bool seam_closing_init(struct seam_closing *out, struct host *host, const struct charts *charts,
                       const struct trace_scene *trace);
void seam_closing_finish(struct seam_closing *closing);

// Scratch memory of a task. NULL: no memory; seam_closing_scratch_destroy accepts it.
struct seam_closing_scratch *seam_closing_scratch_create(struct host *host,
                                                         const struct seam_closing *closing);
void seam_closing_scratch_destroy(struct seam_closing_scratch *scratch);

// Weights of a place, which sum to 1; unused entries have weight 0.
void seam_close(const struct seam_closing *closing, struct seam_closing_scratch *scratch,
                uint32_t place, struct chart_share out[CHART_SEAM_ENTRIES]);
