#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require

// A source whose irradiance is `share` of the direct one, which it replaces.
#include "frame/frame.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 1) uniform sampler2D direct_irradiance;
layout(set = 0, binding = 2, rgba16f) uniform writeonly image2D irradiance;

layout(push_constant, scalar) uniform push_block
{
    float share;
};

void main()
{
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, ivec2(frame.width, frame.height)))) return;
    vec3 e_direct = texelFetch(direct_irradiance, pixel, 0).rgb;
    imageStore(irradiance, pixel, vec4(share * e_direct - e_direct, 1.0));
}
