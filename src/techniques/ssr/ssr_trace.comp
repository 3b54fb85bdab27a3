// One ray of each pixel that reflects: its direction is a sample of the GGX lobe (Heitz 2018), its
// hit the first visible surface. Neighbours have complementary directions, which ssr_resolve.comp
// averages.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_control_flow_attributes : require

#define FRAME_CONSTANTS_COPIED
#include "core/basis.glsl"
#include "frame/brdf.glsl"
#include "frame/frame.glsl"
#include "frame/octahedral.glsl"
#include "techniques/common/pattern.glsl"
#define SSR_BINDING         1
#define SSR_PYRAMID_BINDING 2
#include "techniques/ssr/ssr_block.glsl"
#include "techniques/ssr/ssr_lobe.glsl"
#include "techniques/ssr/ssr_march.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(constant_id = SSR_CONSTANT_STEP) const int STEP = 1;
layout(constant_id = SSR_CONSTANT_REUSE) const int REUSE = 4;

layout(set = 0, binding = 3) uniform sampler2D normal;
layout(set = 0, binding = 4) uniform sampler2D material;
layout(set = 0, binding = 5) uniform sampler2D albedo;
layout(set = 0, binding = 6) uniform sampler2D radiance;
layout(set = 0, binding = 7, rgba32f) uniform writeonly image2D hits; // world position, 1/density
layout(set = 0, binding = 8, rgba16f) uniform writeonly image2D rays; // radiance, confidence

const float FULL_CONFIDENCE = 0.5; // of the thickness: hits up to there behind a surface
const float LEAST_COSINE = 0.0025; // of normal and line of sight
const float EXTENT = 4.0;          // of a surface in a pixel along the view axis, pixel widths

// Points of the R2 sequence (Roberts 2018): those of 16 neighbours are successive ones.
vec2 sample_of(ivec2 work)
{
    uint number = ssr_of.first_sample + pattern_4x4(uvec2(work));
    uvec2 point = number * uvec2(3242174889u, 2447445414u);
    return vec2(point >> 8u) / 16777216.0;
}

// The mip of a hit: its texels have the solid angle that one of the averaged rays stands for
// (Křivánek & Colbert 2008, "Real-time Shading with Filtered Importance Sampling").
float mip_of(vec3 from, vec4 hit, float density, float spread)
{
    float rays = mix(1.0, float(REUSE * REUSE), spread * spread);
    float width = inversesqrt(density * rays) * distance(hit.xyz, from);
    float view_m = dot(frame.axis.xyz, hit.xyz) + frame.axis.w;
    return log2(
        max(ssr_of.mip_scale * width * ssr_of.focal_px / mix(1.0, view_m, frame.viewer.w), 1.0));
}

// How far a ray in a pixel is behind its surface, over the thickness; above 1: no hit. The surface
// has an extent along the view axis within the pixel.
float depth_behind(ssr_ray ray, ssr_cell cell)
{
    float surface_m = frame_view_distance(cell.depth);
    float nearest = ray.from.z + (ray.along.z > 0.0 ? cell.out_ : cell.in_) * ray.along.z;
    float behind_m = frame_view_distance(max(nearest, 1.0e-12)) - surface_m;
    float extent_m = EXTENT * ssr_of.pixel_m * mix(1.0, surface_m, frame.viewer.w);
    return behind_m / (ssr_of.thickness_m + extent_m);
}

// Fades hits near the border of the image.
float border_fade(vec2 at)
{
    vec2 size = vec2(frame.width, frame.height);
    vec2 inside = min(at, size - at) / max(ssr_of.border_px, 1.0e-3);
    return smoothstep(0.0, 1.0, clamp(min(inside.x, inside.y), 0.0, 1.0));
}

// Position of the hit and confidence in a; without one a is 0 and the position far along the ray.
vec4 hit_of(ssr_ray ray, vec3 position, vec3 direction, out vec2 at)
{
    int left = int(ssr_of.steps);
    float t = ssr_exit(ray, floor(ray.from.xy), 1.0), behind = 2.0;
    ssr_cell cell;
    [[dont_unroll]] for (;;)
    {
        cell = ssr_next(ray, t, left);
        if (!cell.reached) break;
        behind = depth_behind(ray, cell);
        if (behind < 1.0) break;
        t = cell.out_;
        left--;
    }
    at = vec2(0.0);
    if (!cell.reached) return vec4(position + SSR_FAR * direction, 0.0);
    float meets = (cell.depth - ray.from.z) / (ray.along.z == 0.0 ? 1.0e-12 : ray.along.z);
    at = ray.from.xy + clamp(meets, cell.in_, cell.out_) * ray.along.xy;
    float certain = clamp((1.0 - behind) / (1.0 - FULL_CONFIDENCE), 0.0, 1.0);
    return vec4(frame_world_position(at / vec2(frame.width, frame.height), cell.depth),
                certain * border_fade(at));
}

struct traced {
    vec4 hit;   // world position, 1/density; 0: the direction is below the surface
    vec4 light; // radiance, confidence
};

traced trace(ivec2 work, ivec2 pixel, float z, float roughness)
{
    vec3 position = frame_world_position(frame_uv(uvec2(pixel)), z);
    vec3 n = octahedral_decode(texelFetch(normal, pixel, 0).rg);
    vec3 to_viewer = normalize(frame_to_viewer(position));
    float alpha = brdf_alpha(roughness), a2 = alpha * alpha;
    mat3 world_from_tangent = basis_of(n);
    vec3 v = to_viewer * world_from_tangent;
    v.z = max(v.z, LEAST_COSINE);
    float spread = ssr_spread(roughness, ssr_of.spread_roughness);
    vec2 u = sample_of(work) * vec2(spread, 1.0);
    vec3 h = world_from_tangent * ssr_visible_normal(normalize(v), alpha, u);
    vec3 direction = reflect(-to_viewer, h);
    float density = ssr_density(brdf_distribution(n, h, a2), brdf_cosine(n, to_viewer), a2);
    vec2 at;
    vec4 hit = hit_of(ssr_ray_of(position, direction), position, direction, at);
    float mip = mip_of(position, hit, density, spread);
    vec3 light = textureLod(radiance, at / vec2(frame.width, frame.height), mip).rgb;
    return traced(vec4(hit.xyz, dot(direction, n) > 0.0 ? 1.0 / density : 0.0), vec4(light, hit.a));
}

void main()
{
    frame = frame_block;
    ssr_of = ssr_block;
    ivec2 work = ivec2(gl_GlobalInvocationID.xy), pixel = work * STEP;
    if (any(greaterThanEqual(work, ivec2(ssr_of.work_width, ssr_of.work_height)))) return;
    float z = texelFetch(pyramid, pixel, 0).r;
    float roughness = texelFetch(material, pixel, 0).r;
    bool reflects =
        z > 0.0 && roughness < ssr_of.max_roughness && frame_is_lit(texelFetch(albedo, pixel, 0).a);
    traced found = traced(vec4(0.0), vec4(0.0));
    // A loop that is left, not a branch: software drivers execute masked branches.
    [[dont_unroll]] for (; reflects; reflects = false) found = trace(work, pixel, z, roughness);
    imageStore(hits, work, found.hit);
    imageStore(rays, work, found.light);
}
