// The blur along columns, of an estimate of the frame's size.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

const ivec2 DOWN = ivec2(0, 1);
layout(set = 0, binding = 2, r8) uniform writeonly image2D visibility;
void store(ivec2 at, vec2 value)
{
    imageStore(visibility, at, vec4(value.x));
}

#include "techniques/common/screen_ao_blur.glsl"

void main()
{
    blur();
}
