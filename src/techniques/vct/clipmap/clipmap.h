// The clip map: grids of the same resolution around the camera, each with voxels half as large as
// those of the previous one.
#pragma once

#include "frame/frame.h"
#include "techniques/vct/clipmap/clipmap_shared.h"
#include "techniques/vct/clipmap/grid.h"

struct vct;

// Fits the grids to the scene and the camera. Voxels and light of grids that moved become invalid.
// False: the scene has no extent.
bool vct_clipmap_update(struct vct *vct, const struct frame_view *view);
// Uniform block "vct_clipmap": the grids as pixels sample them, around the camera.
struct gpu_binding vct_clipmap_binding(const struct vct *vct, struct gpu_cmd *cmd);
// The grids as voxels sample them: whole, with the placement of the filled light volume.
struct gpu_binding vct_lit_clipmap_binding(const struct vct *vct, struct gpu_cmd *cmd);
