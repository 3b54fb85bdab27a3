// The job that all stages of a light map by the path tracer share.
#pragma once

#include "lightmap/lightmap.h"
#include "lightmap/noise.h"
#include "lightmap/rows.h"
#include "scene/statics.h"

struct lightmap_job {
    struct host *host;
    struct lightmap_bake how;
    struct charts charts;     // since planning
    struct noise_units units; // since planning, with a bound of noise
    struct scene_statics statics;
    struct gather_scene scene;
};

// About: memory of the charts, and of the rays among the surfaces.
size_t lightmap_job_bytes(const struct charts *charts);
// About: memory of the charts of the bake, and of a light map while its files are written.
size_t lightmap_files_bytes(const struct charts *charts, const struct scene *scene);
