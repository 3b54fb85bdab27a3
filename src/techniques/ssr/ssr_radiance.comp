// Radiance of each pixel, as composite.comp adds it up before this technique: direct light with
// emission, diffuse indirect light, and the specular layer of the source.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require

#include "frame/frame.glsl"
#define SSR_BINDING 1
#include "techniques/ssr/ssr_block.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 2) uniform sampler2D direct;
layout(set = 0, binding = 3) uniform sampler2D albedo;
layout(set = 0, binding = 4) uniform sampler2D irradiance;
layout(set = 0, binding = 5) uniform sampler2D visibility;
layout(set = 0, binding = 6) uniform sampler2D specular;
layout(set = 0, binding = 7, rgba16f) uniform writeonly image2D radiance;

void main()
{
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, ivec2(frame.width, frame.height)))) return;
    vec4 light = texelFetch(direct, pixel, 0), surface = texelFetch(albedo, pixel, 0);
    float open = mix(1.0, texelFetch(visibility, pixel, 0).r, ssr_block.has_visibility);
    vec3 diffuse = surface.rgb * texelFetch(irradiance, pixel, 0).rgb * (light.a * open * INV_PI);
    vec3 indirect = diffuse + texelFetch(specular, pixel, 0).rgb;
    vec3 sum = light.rgb + (frame_is_lit(surface.a) ? indirect : vec3(0.0));
    imageStore(radiance, pixel, vec4(clamp(sum, vec3(0.0), vec3(HALF_MAX)), 1.0));
}
