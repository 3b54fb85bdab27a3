// What the grid makes of a scene that does not suit it, in sentences for the log. Said once, when a
// technique is created.
#pragma once

#include "core/host.h"
#include "scene/pose.h"

struct vct_grid;
struct vct_options;

void vct_remark_on_scene(struct host *host, const char *technique,
                         const struct vct_options *options, const struct scene_pose *pose);

// The voxels that surfaces touch at this moment, as the GPU finds them but for rounding; counting
// ends beyond `enough`. `dim` numbers them along a side. false: no memory.
bool vct_count_touched(struct host *host, const struct scene_pose *pose,
                       const struct vct_grid *grid, int32_t dim, uint32_t enough, uint32_t *count);
