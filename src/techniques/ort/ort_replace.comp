// The light map of a scene whose surfaces scatter has all light that leaves a texel diffusely: the
// irradiance that FRAME_DIRECT has reflected already is taken off. Pixels without a light map
// keep it.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#include "frame/frame.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 1) uniform sampler2D direct_irradiance;
layout(set = 0, binding = 2, rgba16f) uniform image2D irradiance; // alpha 0: no light map

void main()
{
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, ivec2(frame.width, frame.height)))) return;
    vec4 scattered = imageLoad(irradiance, pixel);
    vec4 direct = texelFetch(direct_irradiance, pixel, 0);
    imageStore(irradiance, pixel, vec4(scattered.rgb - scattered.a * direct.rgb, scattered.a));
}
