// Grids about the eye, each with voxels half as large as the last one's: which of them has what is
// looked for at a place. Cones count levels from the finest grid's texels on, of which the coarsest
// grid's mips go on; places are in texels of level 0 from the corner of the scene's grid.
//
// The boxes in which grids are looked into move with the eye, and lie within the grids, which move
// in steps: a picture does not show the steps.
#ifndef AG_VCT_CLIPMAP_GLSL
#define AG_VCT_CLIPMAP_GLSL

#include "techniques/vct/clipmap/clipmap_shared.h"
#include "techniques/vct/vct_constants.h"

layout(constant_id = VCT_CONSTANT_CLIPS) const int VCT_CLIPS = 1; // grids

layout(set = 0, binding = 22, scalar) uniform vct_clipmap
{
    vct_clip_table clips;
};

// Cones that leave a place do so from the finest grid there. By its border they also leave it from
// the next one, and what they find changes over.
struct vct_start {
    int level;
    float next; // share of the next level, 0…1
};

vct_start vct_start_at(vec3 at)
{
    vct_start start = vct_start(VCT_CLIPS - 1, 0.0);
    for (int i = VCT_CLIPS - 2; i >= 0; i--) {
        vec3 inside = min(at - clips.levels[i].low, clips.levels[i].high - at);
        float depth = min(inside.x, min(inside.y, inside.z)) / float(1 << i);
        if (depth > 0.0) start = vct_start(i, max(1.0 - depth / clips.fade, 0.0));
    }
    return start;
}

// Width of the texels that cones from a place start with.
float vct_texel_at(vec3 at)
{
    return VCT_CLIPS > 1 ? float(1 << vct_start_at(at).level) : 1.0;
}

#endif
