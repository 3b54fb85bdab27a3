// Selects the level of the clip map that cones sample. Level 0 is the finest grid; levels beyond
// the coarsest grid are its mips. Positions are in texels of level 0 from the corner of the scene's
// grid.
//
// Grids move with the camera in steps. Cones sample a smaller box within each grid that moves
// continuously, so that images do not show the steps.
#ifndef AG_VCT_CLIPMAP_GLSL
#define AG_VCT_CLIPMAP_GLSL

#include "techniques/vct/clipmap/clipmap_shared.h"
#include "techniques/vct/vct_constants.h"

layout(constant_id = VCT_CONSTANT_CLIPS) const int VCT_CLIPS = 1; // levels

layout(set = 0, binding = 22, scalar) uniform vct_clipmap
{
    vct_clip_table clips;
};

// Cones start in the finest level whose box contains the position. Near its border they blend with
// cones that start in the next level.
struct vct_start {
    int level;
    float next; // weight of the next level, 0…1
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

// Texel size of the level in which cones from a position start.
float vct_texel_at(vec3 at)
{
    return VCT_CLIPS > 1 ? float(1 << vct_start_at(at).level) : 1.0;
}

#endif
