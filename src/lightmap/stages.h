// The job that all stages of a light map by the path tracer share.
#pragma once

#include "bake/plan.h"
#include "lightmap/gather.h"
#include "lightmap/lightmap.h"
#include "lightmap/noise.h"
#include "scene/statics.h"

struct lightmap_job {
    struct host *host;
    struct lightmap_bake how;
    struct charts charts;     // since planning
    struct noise_units units; // since planning, with a bound of noise
    struct scene_statics statics;
    struct gather_scene scene;
};

// ---- rows.c

// Calls `gather` for each texel of the task's rows of its first output: true, until the task is
// cancelled.
bool lightmap_run_rows(const struct bake_task *task,
                       void (*gather)(const struct bake_task *task, uint32_t texel, uint64_t row));
// Tasks for that many paths, at least one.
size_t lightmap_task_count(uint64_t texels, uint64_t paths_of_texel);

enum { LIGHTMAP_RAYS_PER_PATH = 8 };
