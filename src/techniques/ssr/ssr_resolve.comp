// Mean of the rays of neighbouring pixels, each weighted by the pixel's own lobe over the density
// of the ray (Stachowiak 2015, "Stochastic Screen-Space Reflections", ratio estimator): radiance of
// the hits times confidence, and confidence. Fresnel's factor is left out: the mean radiance is
// reflected by the directional albedo, as that of the sources.
//
// Permutation: TEMPORAL, the mean is kept for ssr_temporal.comp.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_control_flow_attributes : require

#define FRAME_CONSTANTS_COPIED
#define GGX_ALBEDO_BINDING 3
#include "core/half.glsl"
#include "frame/brdf.glsl"
#include "frame/frame.glsl"
#include "frame/octahedral.glsl"
#define SSR_BINDING 1
#include "techniques/ssr/ssr_block.glsl"
#include "techniques/ssr/ssr_lobe.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(constant_id = SSR_CONSTANT_STEP) const int STEP = 1;
layout(constant_id = SSR_CONSTANT_REUSE) const int REUSE = 4;

layout(set = 0, binding = 2) uniform sampler2D depth;
layout(set = 0, binding = 4) uniform sampler2D normal;
layout(set = 0, binding = 5) uniform sampler2D material;
layout(set = 0, binding = 6) uniform sampler2D albedo;
layout(set = 0, binding = 7) uniform sampler2D dielectric;
layout(set = 0, binding = 8) uniform sampler2D hits;
layout(set = 0, binding = 9) uniform sampler2D rays;
layout(set = 0, binding = 10, rgba16f) uniform writeonly image2D mean;
layout(set = 0, binding = 11, rgba16f) uniform image2D specular;
#include "techniques/ssr/ssr_apply.glsl"

vec4 mean_around(ivec2 pixel, ssr_surface s)
{
    float alpha = brdf_alpha(s.material.roughness), a2 = alpha * alpha;
    float n_v = brdf_cosine(s.n, s.to_viewer);
    ivec2 last = ivec2(ssr_of.work_width, ssr_of.work_height) - 1;
    ivec2 first = pixel / STEP - (REUSE - 1) / 2;
    vec4 sum = vec4(0.0);
    float weights = 0.0;
    [[dont_unroll]] for (int i = 0; i < REUSE * REUSE; i++)
    {
        ivec2 at = clamp(first + ivec2(i % REUSE, i / REUSE), ivec2(0), last);
        vec4 hit = texelFetch(hits, at, 0), ray = texelFetch(rays, at, 0);
        vec3 l = normalize(hit.xyz - s.position), h = normalize(s.to_viewer + l);
        float n_l = clamp(dot(s.n, l), 1.0e-4, 1.0);
        float lobe = brdf_distribution(s.n, h, a2) * brdf_visibility(n_v, n_l, a2) * n_l;
        float w = hit.a > 0.0 ? hit.a * lobe : 0.0;
        sum += (w * ray.a) * vec4(ray.rgb, 1.0);
        weights += w;
    }
    return weights > 0.0 ? sum / weights : vec4(0.0);
}

void main()
{
    frame = frame_block;
    ssr_of = ssr_block;
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, ivec2(frame.width, frame.height)))) return;
    ssr_surface s = ssr_surface_at(pixel);
    vec4 light = vec4(0.0);
    [[dont_unroll]] for (bool once = s.reflects; once; once = false) light = mean_around(pixel, s);
#if TEMPORAL
    imageStore(mean, pixel, min(light, vec4(HALF_MAX)));
#else
    ssr_apply(s, pixel, light);
#endif
}
