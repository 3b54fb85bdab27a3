// The stage of the bake that makes probes.
#pragma once

#include "bake/plan.h"
#include "techniques/radiosity/bake/row.h"
#include "techniques/radiosity/probes/grid.h"

// Room of a task. row: [2 · sources].
struct radiosity_probe_scratch {
    struct radiosity_gather *gather;
    struct radiosity_rows *rows;
    struct radiosity_entry *row;
};

struct radiosity_probe_size {
    int rays, sources;
    uint64_t columns; // of emission
};

// `run` calls radiosity_probe_run. scratch_bytes: of `scratch`.
bool radiosity_probe_plan(struct bake_plan *plan, struct frame_probes grid,
                          const struct radiosity_probe_size *size,
                          bool (*run)(const struct bake_task *task), size_t scratch_bytes);
bool radiosity_probe_run(const struct bake_task *task, const struct radiosity_scene *scene,
                         const struct radiosity_probe_scratch *scratch);
