// Light on the voxels: direct light, emission, and light from other voxels.
#pragma once

#include "frame/frame.h"
#include "techniques/vct/lighting/lighting_shared.h"

// Inputs of the light that emitters and the sky cast on voxels, besides the voxels.
struct vct_bounce_inputs {
    uint64_t environment; // frame_view.environment_key
    double radiance_scale;
};

struct vct;
struct vct_clip;

// Divides voxels into the parts that gather bounced light together.
void vct_list_parts(struct vct *vct, const struct vct_clip *clip, struct gpu_cmd *cmd);
// Gathers light from other voxels, if that has changed: see vct_record_light.
bool vct_record_bounce(struct vct *vct, struct gpu_cmd *cmd, const struct frame_view *view);
// Lights the voxels and fills the light volume, unless all is as in the previous frame. bounced:
// the result of vct_record_bounce.
void vct_record_light(struct vct *vct, struct gpu_cmd *cmd, const struct frame_view *view,
                      bool bounced);
// Fills the light volume again from voxels that are lit already.
void vct_refill_volume(struct vct *vct, struct gpu_cmd *cmd);
