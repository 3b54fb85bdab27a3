// Bright texels of a block: radiosity above a multiple of the block's mean, which a few modes
// cannot represent.
#ifndef AG_MRT_BRIGHT_GLSL
#define AG_MRT_BRIGHT_GLSL

#include "techniques/mrt/mrt_shared.h"

// [block]: the number of its texels.
layout(set = 0, binding = MRT_BRIGHT_COUNTS_BINDING) buffer mrt_bright_counts
{
    uint bright_count_table[];
};
// [block][MRT_BRIGHT_TEXELS]
layout(set = 0, binding = MRT_BRIGHT_TEXELS_BINDING, scalar) buffer mrt_bright_texels
{
    mrt_gpu_bright_texel bright_table[];
};
// [block][colour][quad]: T_d→b of their radiosity.
layout(set = 0, binding = MRT_B_BRIGHT_BINDING, scalar) buffer mrt_b_bright
{
    vec4 b_bright_table[];
};

#endif
