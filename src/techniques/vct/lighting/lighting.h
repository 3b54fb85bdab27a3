// Light on the voxels: direct light, emission, and light from other voxels.
#pragma once

#include "frame/frame.h"
#include "techniques/vct/lighting/lighting_shared.h"

// Inputs of the light that emitters and the sky cast on voxels, besides the voxels.
struct vct_bounce_inputs {
    uint64_t environment; // frame_view.environment_key
    double radiance_scale;
};

struct vct_lighting {
    gpu_pipeline parts;
    gpu_pipeline inject[2]; // without and with lights
    gpu_pipeline bounce[4]; // by vct_light_variant
    bool lit;               // the light volume is that of the previous frame, of this grid
    bool bounced;           // bounced irradiance is that of `inputs`
    struct vct_bounce_inputs inputs;
    int bounces_left; // that still propagate a change of light
    int first_level;  // of the clip map, the coarsest one whose light that change reaches
};

struct vct_frame;

// All light is to be gathered again: it is that of another grid, or of other options.
void vct_lighting_invalidate(struct vct_lighting *lighting);
// Divides the voxels of a level into the parts that gather bounced light together.
void vct_list_parts(const struct vct_lighting *lighting, const struct vct_frame *frame, int level);
// Gathers light from other voxels, if that has changed: see vct_record_light. Notes in the frame's
// parameters whether there is any.
bool vct_record_bounce(struct vct_lighting *lighting, struct vct_frame *frame);
// Lights the voxels and fills the light volume, unless all is as in the previous frame. bounced:
// the result of vct_record_bounce; same: neither geometry nor light has changed since then.
void vct_record_light(struct vct_lighting *lighting, const struct vct_frame *frame, bool bounced,
                      bool same);
// Fills the light volume again from voxels that are lit already.
void vct_refill_volume(const struct vct_frame *frame);
