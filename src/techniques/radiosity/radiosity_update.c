// An update of the light map in one frame or spread over several: a list of rows in the order of
// the stages, of which each frame computes a share.
#include "techniques/radiosity/radiosity_state.h"

#include <math.h>

// Steps after which the error is below that of the light map's halves: each multiplies it by
// σ/(1 + √(1 − σ²)) (Golub & Van Loan 2013, section 11.2.8), and it is σ of the solution before.
static int steps_of(const struct radiosity *s)
{
    static const float ENOUGH = 1.0f / 4096.0f;
    const float sigma = s->spectral_radius;
    const float factor = sigma / (1.0f + sqrtf(1.0f - sigma * sigma));
    int steps = 0;
    for (float error = 2.0f * sigma; error > ENOUGH && steps < s->options.bounces; steps++)
        error *= factor;
    return steps;
}

// Cost of a row in form factors of the gather, measured in Sponza on two cores with AVX2.
static float cost_of_row(const struct radiosity *s, enum radiosity_stage stage)
{
    static const float COST[RADIOSITY_STAGES] = {
        [RADIOSITY_DIRECT] = 40,   [RADIOSITY_BOUNCES] = 3, [RADIOSITY_STRATA] = 1,
        [RADIOSITY_GATHER] = 2,    [RADIOSITY_SMOOTH] = 10, [RADIOSITY_SMOOTH_WIDE] = 10,
        [RADIOSITY_LIGHT_MAP] = 5, [RADIOSITY_SEAMS] = 32,
    };
    static const float SHORT_ENTRY = 0.35f; // half the words, no direction
    if (stage == RADIOSITY_BOUNCES)
        return COST[stage] + SHORT_ENTRY * s->tables.cluster_factors.mean_entries;
    if (stage == RADIOSITY_STRATA) return COST[stage] + SHORT_ENTRY * s->tables.shares.mean_entries;
    if (stage == RADIOSITY_GATHER) return COST[stage] + s->tables.factors.mean_entries;
    return COST[stage];
}

static double cost_of_update(const struct radiosity *s, int steps)
{
    double sum = 0.0;
    for (int stage = 0; stage < RADIOSITY_STAGES; stage++)
        sum += (double)cost_of_row(s, stage) * radiosity_stage_rows(s, stage) *
               (stage == RADIOSITY_BOUNCES ? steps : 1);
    return sum;
}

static void start(struct radiosity_update *u, int steps)
{
    u->running = true;
    u->changed = false;
    u->brings_other |= u->other;
    u->other = false;
    u->at = (struct radiosity_part){ .steps = steps };
}

static bool is_empty(const struct radiosity *s, const struct radiosity_part *at)
{
    return radiosity_stage_rows(s, at->stage) == 0 ||
           (at->stage == RADIOSITY_BOUNCES && at->steps == 0);
}

static void advance(struct radiosity *s)
{
    struct radiosity_update *u = &s->update;
    struct radiosity_part *at = &u->at;
    at->first += at->count;
    at->count = 0;
    if (at->first < radiosity_stage_rows(s, at->stage)) return;
    at->first = 0;
    if (at->stage == RADIOSITY_BOUNCES && ++at->step < at->steps) return;
    do at->stage++;
    while (at->stage < RADIOSITY_STAGES && is_empty(s, at));
    if (at->stage == RADIOSITY_GATHER) s->probes.fresh = false;
    if (at->stage < RADIOSITY_STAGES) return;
    u->running = u->brings_other = false;
    s->light_map.front = 1 - s->light_map.front;
}

static void record_rows(struct radiosity *s, struct gpu_cmd *cmd, const struct frame_view *view,
                        uint32_t rows)
{
    s->update.at.count = rows;
    radiosity_record_part(s, cmd, view, &s->update.at);
    advance(s);
}

static uint32_t rows_left(const struct radiosity_part *at, const struct radiosity *s)
{
    return radiosity_stage_rows(s, at->stage) - at->first;
}

// Rows of whole tiles.
static uint32_t rows_within(const struct radiosity *s, double cost)
{
    const struct radiosity_part *at = &s->update.at;
    const double rows = ceil(cost / (double)cost_of_row(s, at->stage) / RADIOSITY_LOCAL);
    const uint32_t left = rows_left(at, s);
    return rows * RADIOSITY_LOCAL < left ? (uint32_t)rows * RADIOSITY_LOCAL : left;
}

static void record_share(struct radiosity *s, struct gpu_cmd *cmd, const struct frame_view *view,
                         double cost)
{
    while (s->update.running && cost > 0.0) {
        const uint32_t rows = rows_within(s, cost);
        cost -= (double)cost_of_row(s, s->update.at.stage) * rows;
        record_rows(s, cmd, view, rows);
    }
}

// All that is left, each stage as a pass of its own.
static void record_rest(struct radiosity *s, struct gpu_cmd *cmd, const struct frame_view *view)
{
    const struct radiosity_part *at = &s->update.at;
    while (s->update.running) {
        const enum radiosity_stage stage = at->stage;
        gpu_scope_begin(cmd, radiosity_stage_name(stage));
        while (s->update.running && at->stage == stage) record_rows(s, cmd, view, rows_left(at, s));
        gpu_scope_end(cmd);
    }
}

void radiosity_record_update(struct radiosity *s, struct gpu_cmd *cmd,
                             const struct frame_view *view)
{
    struct radiosity_update *u = &s->update;
    const int frames = s->options.frames;
    if (u->at_once || frames == 1) {
        if (u->changed) start(u, steps_of(s));
        u->at_once = false;
        record_rest(s, cmd, view);
        return;
    }
    if (!u->running && u->changed) start(u, steps_of(s));
    if (!u->running) return;
    gpu_scope_begin(cmd, "transfer");
    record_share(s, cmd, view, cost_of_update(s, u->at.steps) / frames);
    gpu_scope_end(cmd);
}
