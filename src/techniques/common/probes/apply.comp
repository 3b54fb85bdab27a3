// Irradiance of pixels that the light map does not have, from probes. SPECULAR: also the radiance
// that the specular lobe reflects, E/π in its mean direction.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#if SPECULAR
#define GGX_ALBEDO_BINDING 8
#endif
#include "core/sh.glsl"
#include "frame/frame.glsl"
#include "frame/brdf.glsl"
#include "frame/octahedral.glsl"
#include "frame/probes.glsl"
#include "techniques/common/probes/lookup.glsl"
#include "techniques/common/light_map/lobe.glsl"
#include "techniques/common/probes/apply_shared.h"

layout(local_size_x = PROBE_APPLY_LOCAL, local_size_y = PROBE_APPLY_LOCAL) in;

layout(push_constant, scalar) uniform push_block
{
    probe_apply_push push;
};
layout(set = 0, binding = 1) uniform sampler2D depth;
layout(set = 0, binding = 2) uniform sampler2D normal;
layout(set = 0, binding = 3) uniform sampler3D volume;
layout(set = 0, binding = 4) uniform sampler2D probe_depths;
layout(set = 0, binding = 5, rgba16f) uniform image2D irradiance; // of the light map

#if SPECULAR
layout(set = 0, binding = 9) uniform sampler2D albedo;
layout(set = 0, binding = 10) uniform sampler2D material;
layout(set = 0, binding = 11) uniform sampler2D dielectric; // FRAME_DIELECTRIC if `has_dielectric`
layout(set = 0, binding = 12, rgba16f) uniform writeonly image2D specular;
#endif

vec3 light_at(vec3 position, vec3 n, vec3 direction)
{
    return probes_seen_irradiance(volume, probe_depths, push.grid, position, n, direction);
}

#if SPECULAR
vec3 reflected(ivec2 pixel, vec3 position, vec3 n)
{
    vec4 lobe = BRDF_DEFAULT_DIELECTRIC;
    if (push.has_dielectric != 0u) lobe = texelFetch(dielectric, pixel, 0);
    brdf_material m =
        brdf_material_of(texelFetch(albedo, pixel, 0).rgb, texelFetch(material, pixel, 0).rg, lobe);
    vec3 to_viewer = normalize(frame.camera_position - position);
    vec3 upwards = dot(to_viewer, n) * n;
    vec3 mean = upwards + (upwards - to_viewer) * lobe_lean(brdf_alpha(m.roughness));
    vec3 radiance = INV_PI * light_at(position, n, normalize(mean + 1e-4 * n));
    return brdf_lobes_at(m, brdf_cosine(n, to_viewer)).specular_albedo *
           clamp(radiance, vec3(0.0), vec3(HALF_MAX));
}
#endif

void main()
{
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, ivec2(frame.width, frame.height)))) return;
    if (pixel.x < push.map_columns && imageLoad(irradiance, pixel).a > 0.0) return;
    float z = texelFetch(depth, pixel, 0).r;
    vec3 result = vec3(0.0), radiance = vec3(0.0);
    if (z > 0.0) {
        vec3 position = frame_world_position(frame_uv(uvec2(pixel)), z);
        vec3 n = octahedral_decode(texelFetch(normal, pixel, 0).rg);
        result = light_at(position, n, n);
#if SPECULAR
        radiance = reflected(pixel, position, n);
#endif
    }
    imageStore(irradiance, pixel, vec4(min(result, HALF_MAX), 1.0));
#if SPECULAR
    imageStore(specular, pixel, vec4(radiance, 1.0));
#endif
}
