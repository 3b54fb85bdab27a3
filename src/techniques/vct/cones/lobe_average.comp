// The mean of what arrives by the rays of 4 x 4 pixels, which have all directions of a lobe's cone,
// and with VCT_TEMPORAL over frames, each of which has other directions. A mirror's image does not
// move with its surface: the smoother, the shorter is its history while the camera moves.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#define FRAME_CONSTANTS_BINDING 1
#include "frame/frame.glsl"
#include "frame/lobe.glsl"
#include "frame/octahedral.glsl"
#include "techniques/common/reproject.glsl"
#include "techniques/vct/cones/cones_shared.h"
#include "techniques/vct/cones/lobe_turns.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 2, scalar) uniform vct_specular
{
    vct_specular_params lobe;
};
layout(set = 0, binding = 3) uniform sampler2D depth;
layout(set = 0, binding = 4) uniform sampler2D normal;
layout(set = 0, binding = 5) uniform sampler2D arriving;
layout(set = 0, binding = 6) uniform sampler2D material;
layout(set = 0, binding = 8, rgba16f) uniform writeonly image2D averaged; // weight, frames
#include "techniques/vct/cones/lobe_mean.glsl"
#if VCT_TEMPORAL
layout(set = 0, binding = 9, scalar) uniform vct_history
{
    vct_history_params set;
};
layout(set = 0, binding = 10) uniform sampler2D motion;
layout(set = 0, binding = 11) uniform sampler2D last_averaged;
layout(set = 0, binding = 12) uniform sampler2D last_surface;
#include "techniques/vct/cones/history.glsl"
#endif

const float MIRROR = 0.05; // roughness up to which a pixel is not averaged

// Radiance, and 1; 0: no ray of this frame is near.
vec4 mean_arriving(ivec2 pixel, lobe_pixel p)
{
    vec4 own = texelFetch(arriving, pixel, 0), sum = vec4(own.rgb, 1.0) * own.a;
    float reach = smoothstep(MIRROR, LOBE_ROUGH_PIXEL, p.roughness);
    int stride = int(lobe.stride), side = VCT_REFLECT_SIDE / stride;
    // The first of them in the 4 x 4 pixels from -2 on.
    ivec2 first = pixel - VCT_REFLECT_SIDE / 2;
    first += (lobe_turn(lobe.stride, lobe.turn) - first) & (stride - 1);
    for (int i = 0; i < side * side; i++) {
        ivec2 at = first + stride * ivec2(i % side, i / side);
        if (at != pixel) sum += lobe_neighbour(p, at, reach);
    }
    return sum.a > 0.0 ? vec4(sum.rgb / sum.a, 1.0) : vec4(0.0);
}

#if VCT_TEMPORAL
// Radiance and weight in frames.
vec4 with_history(ivec2 pixel, lobe_pixel p, float z, vec4 now)
{
    vec4 moved = texelFetch(motion, pixel, 0), sum = vec4(0.0);
    float distance_before = reproject_distance(moved, frame_view_distance(z)), weights = 0.0;
    if (set.known == 0u || distance_before <= 0.0) return now;
    vec2 place = reproject_place(moved, pixel, vec2(frame.width, frame.height),
                                 vec2(frame.jitter_step_x, frame.jitter_step_y));
    vec4 expected = history_expected(place, distance_before);
    for (int i = 0; i < 4; i++) {
        float weight = history_weight(place, i, expected, p.normal);
        if (weight <= 0.0) continue;
        sum += weight * texelFetch(last_averaged, reproject_tap(place, i), 0);
        weights += weight;
    }
    sum *= weights > HISTORY_LEAST ? 1.0 / weights : 0.0;
    float most = mix(set.most_of_mirror, set.most_of_lobe,
                     smoothstep(LOBE_ROUGH_PIXEL, 0.5, p.roughness)),
          frames = min(sum.a, most);
    sum = vec4(frames * set.scale * sum.rgb, frames) + vec4(now.rgb, 1.0) * now.a;
    return sum.a > 0.0 ? vec4(sum.rgb / sum.a, sum.a) : vec4(0.0);
}
#endif

void main()
{
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, ivec2(frame.width, frame.height)))) return;
    float z = texelFetch(depth, pixel, 0).r;
    vec4 mean = vec4(0.0);
    lobe_pixel p = lobe_pixel_at(pixel, z);
    if (z > 0.0 && (lobe.tan_half > 0.0 || lobe_tail(p.roughness * p.roughness) < 1.0)) {
        mean = mean_arriving(pixel, p);
#if VCT_TEMPORAL
        mean = with_history(pixel, p, z, mean);
#endif
    }
    imageStore(averaged, pixel, mean);
}
