// Writes the irradiance to every pixel with a surface: that of the scene's flux, the same
// everywhere, and the environment's by the normal.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#include "core/half.glsl"
#define FRAME_CONSTANTS_BINDING 3
#include "frame/environment.glsl"
#include "frame/octahedral.glsl"
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
layout(set = 0, binding = 4) uniform sampler2D normal;
layout(set = 0, binding = 2, rgba16f) uniform writeonly image2D irradiance;

void main()
{
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, ivec2(push.width, push.height)))) return;
    vec3 sum = vec3(0.0);
    if (texelFetch(depth, pixel, 0).r > 0.0) {
        vec3 n = octahedral_decode(texelFetch(normal, pixel, 0).rg);
        sum = min(everywhere + push.strength * environment_irradiance_at(n), vec3(HALF_MAX));
    }
    imageStore(irradiance, pixel, vec4(sum, 1.0));
}
