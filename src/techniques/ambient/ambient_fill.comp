// Writes the irradiance to every pixel with a surface.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#include "core/half.glsl"
#include "techniques/ambient/ambient_shared.h"

layout(local_size_x = 8, local_size_y = 8) in;

layout(push_constant, scalar) uniform push_block
{
    ambient_push push;
};
layout(set = 0, binding = 0, scalar) readonly buffer ambient_result
{
    vec3 everywhere;
};
layout(set = 0, binding = 1) uniform sampler2D depth;
layout(set = 0, binding = 2, rgba16f) uniform writeonly image2D irradiance;

void main()
{
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, ivec2(push.width, push.height)))) return;
    bool surface = texelFetch(depth, pixel, 0).r > 0.0;
    imageStore(irradiance, pixel, vec4(surface ? min(everywhere, vec3(HALF_MAX)) : vec3(0.0), 1.0));
}
