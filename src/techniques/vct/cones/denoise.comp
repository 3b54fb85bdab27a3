// Means of accumulated irradiance over pixels around, as far as its noise hides the differences
// between them: a filter by variance (after Schied et al. 2017, SVGF). The history is not filtered,
// so that a still image converges to what its pixels see.
//
// Pixels of one block share a set of rays, and its noise: the taps of the second pass are a block
// apart. Those of the first one, within a block, take away the lattice that gathering leaves.
// VCT_ACROSS: 0, the first pass; 1, the second one.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#define FRAME_CONSTANTS_BINDING 0
#include "core/half.glsl"
#include "frame/frame.glsl"
#include "frame/octahedral.glsl"
#include "techniques/vct/cones/cones_shared.h"
#include "techniques/vct/cones/packed_normal.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 1) uniform sampler2D light;   // irradiance, accumulated frames
layout(set = 0, binding = 2) uniform sampler2D surface; // as in temporal.comp
layout(set = 0, binding = 3) uniform sampler2D change;  // alpha: deviation of one frame
layout(set = 0, binding = 4) uniform writeonly image2D irradiance;

layout(push_constant, scalar) uniform push_block
{
    vct_denoise_push push;
};

// Taps: the nine around, or every other one of 25, as on a chessboard.
const int REACH = 1 + VCT_ACROSS, EVERY = 1 + VCT_ACROSS;
const float DEVIATIONS = 4.0;    // of the mean, in which two pixels differ by noise alone
const float CONVERGED = 512.0;   // frames: their noise does not show
const float PER_DISTANCE = 0.05; // distance from the plane over that along it

float total(vec3 v)
{
    return v.r + v.g + v.b;
}

// Distance from the origin along a normal of the point in a pixel, o + d r: both are linear in the
// pixel's coordinates.
struct along_normal {
    vec3 o, r; // here, and more for a step to the right and down
};

along_normal along(vec3 n, vec2 uv, vec2 step_uv)
{
    vec2 per = 2.0 * step_uv;
    return along_normal(
        vec3(dot(n, frame_ray_origin(uv)), dot(n, frame.origin_x) * per.x,
             dot(n, frame.origin_y) * per.y),
        vec3(dot(n, frame_view_ray(uv)), dot(n, frame.ray_x) * per.x, dot(n, frame.ray_y) * per.y));
}

float at_step(along_normal a, ivec2 by, float distance_m)
{
    vec3 weights = vec3(1.0, by);
    return dot(a.o, weights) + distance_m * dot(a.r, weights);
}

// Deviation of a pixel's mean of some frames.
float deviation_of(ivec2 pixel, float frames)
{
    return texelFetch(change, pixel, 0).a * inversesqrt(max(frames, 1.0));
}

// A pixel that has met a small bright surface by chance has too large a deviation, one that has not
// has too small a one: the larger of two counts.
vec3 denoised(ivec2 pixel, vec4 here, vec2 stored)
{
    float deviation = deviation_of(pixel, here.w);
    vec3 n = unpacked_normal(stored.y);
    vec2 size = vec2(frame.width, frame.height);
    along_normal a = along(n, frame_uv(uvec2(pixel)), float(push.stride) / size);
    float plane = at_step(a, ivec2(0), stored.x);
    float level = total(here.rgb),
          per_m = 1.0 / (PER_DISTANCE * push.step_per_m * mix(1.0, stored.x, frame.viewer.w));
    vec3 sum = here.w * here.rgb;
    float weights = here.w;
    for (int y = -REACH; y <= REACH; y++)
        for (int x = (y & EVERY - 1) - REACH; x <= REACH; x += EVERY) {
            ivec2 by = ivec2(x, y), at = pixel + push.stride * by;
            if (by == ivec2(0) || any(lessThan(at, ivec2(0))) ||
                any(greaterThanEqual(at, ivec2(size))))
                continue;
            vec2 there = texelFetch(surface, at, 0).rg;
            if (there.x <= 0.0) continue;
            vec4 tap = texelFetch(light, at, 0);
            float off_plane = abs(at_step(a, by, there.x) - plane);
            float most = DEVIATIONS * max(deviation, deviation_of(at, tap.w));
            float unlike = abs(total(tap.rgb) - level) / max(most, 1e-12);
            float weight = tap.w * normal_similarity(n, unpacked_normal(there.y)) *
                           max(1.0 - off_plane * per_m, 0.0) * max(1.0 - unlike, 0.0);
            sum += weight * tap.rgb;
            weights += weight;
        }
    return sum / weights;
}

void main()
{
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, ivec2(frame.width, frame.height)))) return;
    vec4 here = texelFetch(light, pixel, 0);
    vec2 stored = texelFetch(surface, pixel, 0).rg;
    vec3 result = here.rgb;
    if (stored.x > 0.0 && here.w < CONVERGED) result = denoised(pixel, here, stored);
    imageStore(irradiance, pixel, vec4(result, here.w));
}
