// The inputs of the stages of a frame. A stage has a struct of its own, which it alone changes, and
// reads the others' here.
#pragma once

#include "techniques/vct/clipmap/clipmap.h"
#include "techniques/vct/octree/octree.h"
#include "techniques/vct/rays/rays.h"
#include "techniques/vct/vct_layout.h"
#include "techniques/vct/vct_options.h"
#include "techniques/vct/vct_shared.h"
#include "techniques/vct/vct_small_emitters.h"
#include "techniques/vct/volume/volume.h"
#include "techniques/vct/voxelize/voxelize.h"

struct vct_frame {
    const struct vct_options *options;
    struct gpu_cmd *cmd;
    const struct frame_view *view;
    const struct vct_voxels *voxels;
    const struct vct_rays *rays;
    const struct vct_svo *svo; // with storage=svo
    const struct vct_small_emitters *emitters;
    struct vct_clipmap *clipmap; // lighting/ notes the placement of the light volume
    struct vct_volume *volume;   // and fills it
    struct vct_params params;    // but for the placement of a grid
};

static inline bool vct_frame_moves(const struct vct_frame *frame)
{
    return frame->voxels->moving_draws > 0;
}

// Number of the variant of a pass that traces: + 1 if there are moving voxels, + 2 if the frame has
// small emitters or a map of the environment.
static inline int vct_light_variant(const struct vct_frame *frame)
{
    const bool more =
        !frame->options->occlusion &&
        (frame->emitters->count > 0 || frame->view->constants->environment_scale > 0.0f);
    return vct_frame_moves(frame) + 2 * more;
}
