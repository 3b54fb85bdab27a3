// Irradiance of pixels that the light map does not have, from probes. SPECULAR: also the radiance
// that the specular lobe reflects, E/π in its mean direction; RADIANCE: the mean of the probes'
// radiance over directions of the lobe.
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
#if RADIANCE
#include "core/basis.glsl"
#include "techniques/common/light_map/table.glsl"
#else
#include "frame/lobe.glsl"
#endif
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
#if RADIANCE
layout(set = 0, binding = 6, rgba16f) uniform readonly image2D probe_radiance;
#endif

#if SPECULAR
layout(set = 0, binding = 9) uniform sampler2D albedo;
layout(set = 0, binding = 10) uniform sampler2D material;
layout(set = 0, binding = 11) uniform sampler2D dielectric; // FRAME_DIELECTRIC if `has_dielectric`
layout(set = 0, binding = 12, rgba16f) uniform writeonly image2D specular;
#include "techniques/common/reflected.glsl"
#endif

vec3 light_at(vec3 position, vec3 n, vec3 direction)
{
    return probes_visible_irradiance(volume, probe_depths, push.grid, position, n, direction);
}

#if RADIANCE
// Radiance that arrives at a point of a surface, by coefficient.
void radiance_at(vec3 position, vec3 n, out vec3 radiance[25])
{
    vec3 at = (position - push.grid.first_m) / push.grid.spacing_m + PROBE_BIAS * n;
    at = clamp(at, vec3(-0.5), vec3(push.grid.count_x, push.grid.count_y, push.grid.count_z) - 0.5);
    uint probes = uint(push.grid.count_x * push.grid.count_y * push.grid.count_z);
    float weights = 0.0;
    for (int k = 0; k < 25; k++) radiance[k] = vec3(0.0);
    for (int i = 0; i < 8; i++) {
        probe_corner corner = probe_corner_of(volume, probe_depths, push.grid, at, i);
        float weight =
            corner.linear * (corner.visibility * probe_facing(n, corner.to) + PROBE_OCCLUDED);
        uint probe = uint((corner.cell.z * push.grid.count_y + corner.cell.y) * push.grid.count_x +
                          corner.cell.x);
        for (uint k = 0u; k < 25u; k++)
            radiance[k] += weight * imageLoad(probe_radiance, light_map_at(k * probes + probe)).rgb;
        weights += weight;
    }
    for (int k = 0; k < 25; k++) radiance[k] /= weights;
}

// A normal of the GGX distribution that is visible from a direction above +z, by a sample of the
// unit square (Dupuy & Benyoub 2023, "Sampling Visible GGX Normals with Spherical Caps").
vec3 visible_normal(vec3 to_viewer, float alpha, vec2 u)
{
    vec3 stretched = normalize(vec3(to_viewer.xy * alpha, to_viewer.z));
    float z = (1.0 - u.y) * (1.0 + stretched.z) - stretched.z, phi = 2.0 * PI * u.x;
    float r = sqrt(clamp(1.0 - z * z, 0.0, 1.0));
    vec3 h = vec3(r * cos(phi), r * sin(phi), z) + stretched;
    return normalize(vec3(h.xy * alpha, max(h.z, 1e-6)));
}

// Bands 0 to 4 are smooth: a few directions have their mean.
vec3 mean_over_lobe(vec3 position, vec3 n, vec3 to_viewer, float alpha)
{
    const uint COUNT = 8u;
    mat3 to_world = basis_of(n);
    vec3 local = to_viewer * to_world, radiance[25], sum = vec3(0.0);
    float count = 0.0;
    local.z = max(local.z, 0.01);
    radiance_at(position, n, radiance);
    for (uint i = 0u; i < COUNT; i++) {
        vec2 u = vec2((float(i) + 0.5) / float(COUNT),
                      float(bitfieldReverse(i)) * 2.3283064e-10 + 0.0625);
        vec3 to_light = reflect(-local, visible_normal(local, alpha, u));
        if (to_light.z <= 0.0) continue;
        float basis[25];
        sh25_eval(to_world * to_light, basis);
        for (int k = 0; k < 25; k++) sum += basis[k] * radiance[k];
        count += 1.0;
    }
    return sum / max(count, 1.0);
}
#elif SPECULAR
vec3 mean_over_lobe(vec3 position, vec3 n, vec3 to_viewer, float alpha)
{
    return INV_PI * light_at(position, n, normalize(lobe_mean(n, to_viewer, alpha)));
}
#endif

#if SPECULAR
vec3 reflected(ivec2 pixel, vec3 position, vec3 n)
{
    brdf_material m = pixel_material(pixel, push.has_dielectric != 0u);
    vec3 to_viewer = normalize(frame_to_viewer(position));
    vec3 radiance = mean_over_lobe(position, n, to_viewer, brdf_alpha(m.roughness));
    return pixel_reflected(m, n, to_viewer, radiance);
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
