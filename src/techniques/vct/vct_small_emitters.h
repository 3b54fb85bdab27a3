// Lamps: small things that glow, which pixels and voxels look for one by one instead of meeting
// them with a cone by chance. Chosen once for a scene; their points follow them.
#pragma once

#include "frame/frame.h"
#include "techniques/vct/vct_shared.h"

struct vct_lamps {
    bool chosen;              // of the scene as it stands
    int draws[VCT_LAMPS_MAX]; // of the scene's draws
    int count;
    struct vct_lamp list[VCT_LAMPS_MAX]; // as shaders read them
};

// Chooses where `chosen` is false, then brings the list to this frame's places and unit. `turn`:
// another number gives other points on the same lamps.
void vct_lamps_update(struct vct_lamps *lamps, const struct frame_view *view, uint32_t turn);
bool vct_lamps_have(const struct vct_lamps *lamps, int draw);
// Storage block "vct_lamps".
struct gpu_binding vct_lamps_binding(const struct vct_lamps *lamps, struct gpu_cmd *cmd);
