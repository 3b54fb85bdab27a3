// The light volume: directional radiance and opacity, prefiltered into mips.
#pragma once

#include "frame/frame.h"
#include "techniques/vct/volume/volume_shared.h"

struct vct;
struct vct_clip;

// Lists the texels of a level that hold voxels: only these are filled and filtered.
void vct_volume_list_texels(struct vct *vct, const struct vct_clip *clip, struct gpu_cmd *cmd);
// From the lit voxels to the light volume and its mips.
void vct_volume_fill(struct vct *vct, struct gpu_cmd *cmd);
