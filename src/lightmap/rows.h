// Tasks whose rows are texels of both sides.
#pragma once

#include "bake/plan.h"
#include "lightmap/gather.h"

// Calls `each` for the texels of the task's rows of its first output, with denormals flushed. False
// where the task is cancelled. row: from 0 in the task.
typedef void lightmap_row(void *user, const struct bake_task *task, uint32_t texel, uint64_t row);
bool lightmap_run_rows(const struct bake_task *task, uint64_t texels, lightmap_row *each,
                       void *user);
// Tasks for that many paths, at least one.
size_t lightmap_task_count(uint64_t texels, uint64_t paths_of_texel);
// A row of LIGHTMAP_REST by paths; some of the texel's points are outside geometry. tile: of it.
void lightmap_write_row(const struct gather_tile *tile, uint32_t texel, float *row);

// About; of a path that a tile shares with shadow rays to the other texels.
enum { LIGHTMAP_RAYS_PER_PATH = 8, LIGHTMAP_RAYS_OF_SHARED = 8 + GATHER_TILE - 1 };
