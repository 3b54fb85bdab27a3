// Data of the clip map that the host writes for shaders. Scalar layout.
#ifndef AG_VCT_CLIPMAP_SHARED_H
#define AG_VCT_CLIPMAP_SHARED_H

#include "techniques/vct/vct_shared.h"

// A level as cones sample it: in texels of the finest level, from the corner of the scene's grid.
struct vct_clip_level {
    vec3s corner;     // of its first texel
    vec3s size;       // in use, in its own texels
    vec3s low, high;  // the box in which cones and rays sample it
    vec3s lit_corner; // as `corner`, of the grid when the light volume was filled
};

// Uniform block "vct_clipmap".
struct vct_clip_table {
    vec3s origin_m; // corner of the scene's grid, world space
    vec3s size;     // of the scene's grid
    float fade;     // texels over which a level blends into the coarser one
    AG_STRUCT(vct_clip_level) levels[VCT_MAX_CLIPS]; // the finest one first
};

#ifndef AG_GLSL
_Static_assert(sizeof(struct vct_clip_table) == (7 + 15 * VCT_MAX_CLIPS) * 4,
               "layout is shared with GLSL");
#endif

#endif
