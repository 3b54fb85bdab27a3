// The uniform block of ssr. SSR_BINDING: its binding.
#ifndef AG_SSR_BLOCK_GLSL
#define AG_SSR_BLOCK_GLSL

#include "techniques/ssr/ssr_shared.h"

layout(set = 0, binding = SSR_BINDING, scalar) uniform ssr
{
    ssr_params ssr_block;
};
ssr_params ssr_of; // a copy that main begins with, as FRAME_CONSTANTS_COPIED

#endif
