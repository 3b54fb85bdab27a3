// Radiance that arrives from the directions of the specular lobe.
//
// With rays, each pixel whose turn it is (cones/lobe_turns.glsl) traces one ray of the lobe's cone
// (frame/lobe.glsl), and the pixels around it the others: cones/lobe_average.comp has their mean.
// Cones would average what is behind a wall with it, and the sky behind may be a hundred times as
// bright as a room. Where there are no rays, one cone per pixel has the width of the lobe (Hong
// 2015, sec. 2.5.3.3.7; Crassin et al. 2011).
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#define FRAME_CONSTANTS_BINDING 1
#define GGX_ALBEDO_BINDING      9
#include "frame/frame.glsl"
#include "frame/brdf.glsl"
#include "frame/lobe.glsl"
#include "techniques/vct/vct_constants.h"
layout(constant_id = VCT_CONSTANT_MAP) const bool VCT_HAS_MAP = false;
#define ENVIRONMENT_MAP_BINDING 19
#define ENVIRONMENT_HAS_MAP     VCT_HAS_MAP
#include "frame/environment_map.glsl"
#include "frame/octahedral.glsl"
#define VCT_GRID_BINDING 0
#include "techniques/vct/vct_grid.glsl"
#include "techniques/vct/cones/cones_shared.h"
#include "techniques/vct/cones/trace.glsl"
#if !VCT_SVO
#include "techniques/vct/rays/jitter.glsl"
#include "techniques/vct/rays/ray.glsl"
#endif

#include "techniques/vct/cones/lobe_turns.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 2, scalar) uniform vct_specular
{
    vct_specular_params set;
};
layout(set = 0, binding = 3) uniform sampler2D depth;
layout(set = 0, binding = 4) uniform sampler2D normal;
layout(set = 0, binding = 5) uniform sampler3D light;
layout(set = 0, binding = 7) uniform sampler2D material;
layout(set = 0, binding = 8, rgba16f) uniform writeonly image2D arriving;

// Tangent of the half-angle: a cone wider than 45° is no better resolved by the texels.
const float WIDEST = 1.0;

float tan_half_angle(float alpha)
{
    if (set.tan_half > 0.0) return min(set.tan_half, WIDEST);
    return lobe_tan_half_angle(alpha, WIDEST);
}

// Lifted to the horizon where a normal map bends it below the surface.
vec3 lifted(vec3 direction, vec3 n)
{
    return normalize(direction + max(0.0, 0.01 - dot(direction, n)) * n);
}

#if !VCT_SVO
// A direction of the cone: one in each of 4 x 4 strata of equal solid angle, by the pixel.
vec3 in_cone(ivec2 pixel, vec3 axis, float tan_half)
{
    uvec2 tile = uvec2(pixel) / VCT_REFLECT_SIDE,
          at = lobe_stratum(uvec2(pixel) % VCT_REFLECT_SIDE, set.stride, set.turn);
    uint stratum = at.x + VCT_REFLECT_SIDE * at.y;
    vec2 square = vct_in_stratum(
        stratum, VCT_REFLECT_SIDE, VCT_REFLECT_SIDE,
        vct_low_discrepancy(vct_morton(tile),
                            stratum + VCT_REFLECT_SIDE * VCT_REFLECT_SIDE * set.turn));
    vec2 disk = vct_disk(square);
    float cosine = 1.0 - dot(disk, disk) * (1.0 - inversesqrt(1.0 + tan_half * tan_half));
    float sine = sqrt(max(1.0 - cosine * cosine, 0.0));
    vec2 around = disk * inversesqrt(max(dot(disk, disk), 1e-12));
    vec3 x = normalize(abs(axis.y) < 0.9 ? vec3(axis.z, 0.0, -axis.x) : vec3(0.0, axis.z, -axis.y));
    return cosine * axis + sine * (around.x * x + around.y * cross(axis, x));
}

// Light of the place that a ray meets, filtered to the texels of its width.
vec3 met_light(vct_ray_sum s, vec3 place, vec3 direction, float texel)
{
    int coarsest = int(set.last_mip) + VCT_CLIPS - 1; // the last mip of the coarsest level
    float weight,
        level = clamp(log2(max(texel, 1.0)), float(vct_ray_place_level(s.place)), float(coarsest));
    int fine = int(level), coarse = min(fine + 1, coarsest);
    vec4 a = vct_sample_volume(light, vct_within_volume(place, fine, weight), direction, direction,
                               fine)
                 .light,
         b = vct_sample_volume(light, vct_within_volume(place, coarse, weight), direction,
                               direction, coarse)
                 .light;
    vec4 found = mix(a, b, fract(level));
    vec3 radiance = found.rgb / max(found.a, VCT_RAY_COVERED);
    if (found.a < VCT_RAY_COVERED) radiance = vct_ray_light(s.face, s.place);
    return radiance;
}

vec3 ray_light(ivec2 pixel, vec3 at, vec3 n, vec3 mirror, float tan_half)
{
    vec3 direction = lifted(in_cone(pixel, mirror, tan_half), n);
    float share = tan_half / float(VCT_REFLECT_SIDE); // of the cone that the ray stands for
    vct_ray_sum s = vct_ray_faces(vct_ray_of(at, n, direction, vct_start_at(at).level), 0.0);
    vec3 last = vec3(0.0);
    if (s.visible > 0.0)
        last = met_light(s, at + 0.5 * s.distance * direction, direction, share * s.distance);
    vec4 traced = vct_ray_total(s, last);
    return traced.rgb + (1.0 - traced.a) * environment_cone(direction, atan(share));
}
#endif

vec3 cone_light(vec3 at, vec3 n, vec3 mirror, float tan_half)
{
    vec3 direction = lifted(mirror, n);
    vec4 traced = vct_cone(light, at, n, direction, set.offset, 2.0 * set.step_size * tan_half,
                           set.last_mip, vct_start_at(at));
    return traced.rgb + (1.0 - traced.a) * environment_cone(direction, atan(tan_half));
}

vec3 arriving_light(ivec2 pixel, float z, float roughness)
{
    vec3 position = frame_world_position(frame_uv(uvec2(pixel)), z);
    vec3 n = octahedral_decode(texelFetch(normal, pixel, 0).rg),
         mirror = reflect(-normalize(frame_to_viewer(position)), n),
         at = (position - clips.origin_m) / set.texel_m;
    float tan_half = tan_half_angle(brdf_alpha(roughness));
#if !VCT_SVO
    if (VCT_RAYS) return ray_light(pixel, at, n, mirror, tan_half);
#endif
    return cone_light(at, n, mirror, tan_half);
}

void main()
{
    // A workgroup traces pixels of one stratum, so that its invocations have near directions.
    uint parts = VCT_REFLECT_SIDE * VCT_REFLECT_SIDE, part = gl_WorkGroupID.x % parts;
    uvec2 tile = uvec2(gl_WorkGroupID.x / parts, gl_WorkGroupID.y) * gl_WorkGroupSize.xy +
                 gl_LocalInvocationID.xy;
    ivec2 pixel =
        ivec2(tile * VCT_REFLECT_SIDE + uvec2(part % VCT_REFLECT_SIDE, part / VCT_REFLECT_SIDE));
    if (any(greaterThanEqual(pixel, ivec2(frame.width, frame.height)))) return;
    float z = texelFetch(depth, pixel, 0).r, roughness = texelFetch(material, pixel, 0).r;
    bool wide = set.tan_half == 0.0 && lobe_tail(brdf_alpha(roughness)) >= 1.0;
    bool traced = z > 0.0 && !wide &&
                  (roughness < LOBE_ROUGH_PIXEL || lobe_traces(pixel, set.stride, set.turn));
    vec3 radiance = traced ? arriving_light(pixel, z, roughness) : vec3(0.0);
    imageStore(arriving, pixel, vec4(clamp(radiance, 0.0, HALF_MAX), traced ? 1.0 : 0.0));
}
