// Small emitters: draws that shadow cones sample, as diffuse cones would hit them by chance. The
// frame's virtual point lights on them are divided into groups, and each group into parts of equal
// flux, of which each frame samples one light.
#pragma once

#include "frame/frame.h"
#include "techniques/vct/cones/cones_shared.h"
#include "techniques/vct/vct_emitter_groups.h"

#define VCT_MAX_EMITTER_LIGHTS 4096

struct vct_small_emitters {
    bool chosen; // `draws` is valid for the scene
    int draw_count, light_count;
    int draws[VCT_MAX_EMITTER_LIGHTS];               // of the scene's draws, ascending
    struct vct_light lights[VCT_MAX_EMITTER_LIGHTS]; // of the frame's emitters, by groups
    int instances[VCT_MAX_EMITTER_LIGHTS];           // of these lights when they were sorted
    struct vct_emitter_group groups[VCT_MAX_SMALL_EMITTERS];
    // The light nearest to the centroid of each part of a group, counted from the group's first.
    int middles[VCT_MAX_SMALL_EMITTERS][VCT_EMITTER_POINTS];
    int count;                                             // of groups
    struct vct_small_emitter list[VCT_MAX_SMALL_EMITTERS]; // as shaders read them
};

// Selects where `chosen` is false, then updates the sample points to this frame's positions and
// radiance scale. Each value of `frame` gives other
// points, 0 the middles.
void vct_small_emitters_update(struct vct_small_emitters *emitters, const struct frame_view *view,
                               uint32_t frame);
bool vct_small_emitters_have(const struct vct_small_emitters *emitters, int draw);
