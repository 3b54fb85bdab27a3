// Small emitters: draws that shadow cones sample, as diffuse cones would hit them by chance.
// Selected once per scene; their sample points move with them.
#pragma once

#include "frame/frame.h"
#include "techniques/vct/cones/cones_shared.h"

struct vct_small_emitters {
    bool chosen;                       // `draws` is valid for the scene
    int draws[VCT_MAX_SMALL_EMITTERS]; // of the scene's draws
    int count;
    struct vct_small_emitter list[VCT_MAX_SMALL_EMITTERS]; // as shaders read them
};

// Selects where `chosen` is false, then updates the sample points to this frame's positions and
// radiance scale. Each value of `frame` gives other points.
void vct_small_emitters_update(struct vct_small_emitters *emitters, const struct frame_view *view,
                               uint32_t frame);
bool vct_small_emitters_have(const struct vct_small_emitters *emitters, int draw);
