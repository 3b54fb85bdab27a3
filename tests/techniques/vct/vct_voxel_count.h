// Occupied voxels, counted on the CPU.
#pragma once

#include "core/host.h"
#include "scene/pose.h"
#include "techniques/vct/clipmap/grid.h"

// Counts the voxels that triangles overlap; differs from the GPU by rounding only. Counting ends
// beyond `enough`. `dim`: voxels along a side of the index space. False: no memory.
bool vct_count_touched(struct host *host, const struct scene_pose *pose,
                       const struct vct_grid *grid, int32_t dim, uint32_t enough, uint32_t *count);
