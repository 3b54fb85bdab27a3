// The stage of the bake that makes low-rank transfer.
#pragma once

#include "bake/plan.h"
#include "techniques/radiosity/bake/row.h"
#include "techniques/radiosity/lowrank/regions.h"

// Room of a task. row: [radiosity_lowrank_sources].
struct radiosity_lowrank_room {
    struct radiosity_gather *gather;
    struct radiosity_rows *rows;
    struct radiosity_entry *row;
};

// `run` calls radiosity_lowrank_run, of wave 1. room_bytes: of its room.
bool radiosity_lowrank_plan(struct bake_plan *plan, const struct radiosity_options *options,
                            uint32_t texels, uint64_t clusters,
                            bool (*run)(const struct bake_task *task), size_t room_bytes);
// regions: radiosity_regions of the map.
bool radiosity_lowrank_run(const struct bake_task *task, const struct radiosity_scene *scene,
                           const uint32_t *regions, const struct radiosity_lowrank_room *room);
