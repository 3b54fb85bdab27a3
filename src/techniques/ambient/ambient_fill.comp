// Writes the irradiance to every pixel with a surface: that of the scene's flux, the same
// everywhere, and the environment's by the normal. SPECULAR: also the mean of the environment over
// the specular lobe.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#include "core/half.glsl"
#define FRAME_CONSTANTS_BINDING 3
#if SPECULAR
#define GGX_ALBEDO_BINDING      5
#define ENVIRONMENT_MAP_BINDING 6
#include "frame/brdf.glsl"
#include "frame/environment_map.glsl"
#include "frame/lobe.glsl"
#endif
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
#if SPECULAR
layout(set = 0, binding = 7) uniform sampler2D albedo;
layout(set = 0, binding = 8) uniform sampler2D material;
layout(set = 0, binding = 9) uniform sampler2D dielectric; // FRAME_DIELECTRIC if `has_dielectric`
layout(set = 0, binding = 10, rgba16f) uniform writeonly image2D specular;
#include "techniques/common/reflected.glsl"

// irradiance: of the environment at the normal.
vec3 reflected(ivec2 pixel, float z, vec3 n, vec3 irradiance)
{
    brdf_material m = pixel_material(pixel, push.has_dielectric != 0u);
    vec3 position = frame_world_position(frame_uv(uvec2(pixel)), z);
    vec3 to_viewer = normalize(frame_to_viewer(position));
    float alpha = brdf_alpha(m.roughness);
    vec3 lobe = environment_lobe(lobe_mean(n, to_viewer, alpha), lobe_deviation(alpha));
    vec3 radiance = mix(lobe, INV_PI * irradiance, lobe_roughness(m.roughness));
    return pixel_reflected(m, n, to_viewer, push.strength * radiance);
}
#endif

void main()
{
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, ivec2(push.width, push.height)))) return;
    float z = texelFetch(depth, pixel, 0).r;
    vec3 sum = vec3(0.0), radiance = vec3(0.0);
    if (z > 0.0) {
        vec3 n = octahedral_decode(texelFetch(normal, pixel, 0).rg);
        vec3 environment = environment_irradiance_at(n);
        sum = min(everywhere + push.strength * environment, vec3(HALF_MAX));
#if SPECULAR
        radiance = reflected(pixel, z, n, environment);
#endif
    }
    imageStore(irradiance, pixel, vec4(sum, 1.0));
#if SPECULAR
    imageStore(specular, pixel, vec4(radiance, 1.0));
#endif
}
