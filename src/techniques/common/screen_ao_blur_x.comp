// The blur along rows.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

const ivec2 DOWN = ivec2(1, 0);
layout(set = 0, binding = 2, rg32f) uniform writeonly image2D after;
void store(ivec2 at, vec2 value)
{
    imageStore(after, at, vec4(value, 0.0, 0.0));
}

#include "techniques/common/screen_ao_blur.glsl"

void main()
{
    blur();
}
