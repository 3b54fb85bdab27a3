// Means of accumulated irradiance over pixels around, as far as its noise hides the differences
// between them: a filter by variance (after Schied et al. 2017, SVGF). The history is not filtered,
// so that a still image converges to what its pixels see.
//
// Two passes of four taps each: along rows and columns, and along diagonals (VCT_DIAGONAL). They
// average 25 pixels together. In the first frames of a history more pairs of passes follow.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#define FRAME_CONSTANTS_BINDING 0
#define FRAME_CONSTANTS_COPIED
#include "core/half.glsl"
#include "frame/frame.glsl"
#include "frame/octahedral.glsl"
#include "techniques/vct/cones/cones_shared.h"
#include "techniques/vct/cones/packed_normal.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 1) uniform sampler2D light;   // irradiance, accumulated frames
layout(set = 0, binding = 2) uniform sampler2D surface; // as in temporal.comp
layout(set = 0, binding = 3) uniform writeonly image2D irradiance;

layout(push_constant, scalar) uniform push_block
{
    vct_denoise_push push;
};

// Steps to the four taps: along rows and columns, or diagonals.
const ivec2 ACROSS = ivec2(1, VCT_DIAGONAL), DOWN = ivec2(-VCT_DIAGONAL, 1);
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

// A pixel that has met a small bright surface by chance has too large a deviation, one that has not
// has too small a one: the larger of two counts.
vec3 denoised(ivec2 pixel, vec4 here, vec4 own)
{
    vec3 n = unpacked_normal(own.y);
    ivec2 last = ivec2(frame.width, frame.height) - 1;
    int stride = push.stride;
    along_normal a =
        along(n, frame_uv(uvec2(pixel)), float(stride) / vec2(frame.width, frame.height));
    float plane = at_step(a, ivec2(0), own.x);
    float level = total(here.rgb), step_m = push.step_per_m * mix(1.0, own.x, frame.viewer.w),
          per_m = 1.0 / (PER_DISTANCE * step_m), far = step_m / push.radius_m,
          near = max(1.0 - far * far * float(1 + VCT_DIAGONAL), 0.0);
    vec3 sum = here.w * here.rgb;
    float weights = here.w;
    for (int i = 0; i < 4; i++) {
        ivec2 by = (i < 2 ? -1 : 1) * ((i & 1) == 0 ? ACROSS : DOWN);
        ivec2 at = pixel + stride * by, inside = clamp(at, ivec2(0), last);
        vec4 there = texelFetch(surface, inside, 0), tap = texelFetch(light, inside, 0);
        float off_plane = abs(at_step(a, by, there.x) - plane);
        float most = push.deviations * max(own.w, there.w);
        float unlike = abs(total(tap.rgb) - level) / max(most, 1e-12);
        float weight = tap.w * near * normal_similarity(n, unpacked_normal(there.y)) *
                       max(1.0 - off_plane * per_m, 0.0) * max(1.0 - unlike, 0.0);
        if (at != inside || there.x <= 0.0) weight = 0.0;
        sum += weight * tap.rgb;
        weights += weight;
    }
    return sum / weights;
}

void main()
{
    frame = frame_block;
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, ivec2(frame.width, frame.height)))) return;
    vec4 here = texelFetch(light, pixel, 0), own = texelFetch(surface, pixel, 0);
    vec3 result = here.rgb;
    if (own.x > 0.0 && here.w < CONVERGED) result = denoised(pixel, here, own);
    imageStore(irradiance, pixel, vec4(result, here.w));
}
