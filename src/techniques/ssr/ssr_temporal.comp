// Temporal accumulation of reflections: the mean over up to 16 frames. History is looked up twice,
// along the motion of the surface and of its virtual image behind the surface, which moves with the
// hit's parallax (Stachowiak 2015); that nearer to the pixel's neighbourhood is taken, and clamped
// to it. Mirrors have no noise, and no history, which resampling would blur.
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
#include "techniques/common/reproject.glsl"
#define SSR_BINDING 1
#include "techniques/ssr/ssr_block.glsl"
#include "techniques/ssr/ssr_lobe.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(constant_id = SSR_CONSTANT_STEP) const int STEP = 1;

layout(set = 0, binding = 2) uniform sampler2D depth;
layout(set = 0, binding = 4) uniform sampler2D normal;
layout(set = 0, binding = 5) uniform sampler2D material;
layout(set = 0, binding = 6) uniform sampler2D albedo;
layout(set = 0, binding = 7) uniform sampler2D dielectric;
layout(set = 0, binding = 8) uniform sampler2D hits;
layout(set = 0, binding = 9) uniform sampler2D motion;
layout(set = 0, binding = 10) uniform sampler2D mean; // of this frame
layout(set = 0, binding = 11, rgba16f) uniform image2D specular;
layout(set = 0, binding = 12) uniform sampler2D history;
layout(set = 0, binding = 13) uniform sampler2D history_surface; // distance, frames
layout(set = 0, binding = 14, rgba16f) uniform writeonly image2D target;
layout(set = 0, binding = 15, rg32f) uniform writeonly image2D target_surface;
#include "techniques/ssr/ssr_apply.glsl"

const float MAX_FRAMES = 16.0;
const float TOLERANCE = 0.1;   // of distances: beyond it, another surface
const float MIN_WEIGHT = 0.25; // sum of the taps' weights; below it the history is rejected
const float DEVIATIONS = 1.5;  // of the clamp

struct past {
    vec4 light;
    float frames; // 0: none
};

past past_at(vec2 place, float distance_m)
{
    past sum = past(vec4(0.0), 0.0);
    float weights = 0.0;
    for (int i = 0; i < 4; i++) {
        ivec2 at = reproject_tap(place, i);
        bool inside = all(greaterThanEqual(at, ivec2(0))) &&
                      all(lessThan(at, ivec2(frame.width, frame.height)));
        at = clamp(at, ivec2(0), ivec2(frame.width, frame.height) - 1);
        vec2 stored = texelFetch(history_surface, at, 0).rg;
        float near = max(1.0 - abs(stored.x - distance_m) / (TOLERANCE * distance_m), 0.0);
        float w = inside && stored.y > 0.0 ? reproject_share(place, i) * near : 0.0;
        sum.light += w * texelFetch(history, at, 0);
        sum.frames += w * stored.y;
        weights += w;
    }
    float scale = weights > MIN_WEIGHT ? 1.0 / weights : 0.0;
    return past(sum.light * scale * vec4(vec3(frame.previous_scale_ratio), 1.0),
                sum.frames * scale);
}

// Place of the virtual image, in pixels of the previous frame.
vec2 virtual_place(ssr_surface s, vec4 hit, vec2 size)
{
    vec3 image = s.position - length(hit.xyz - s.position) * s.to_viewer;
    vec4 clip = frame.previous_clip_from_world * vec4(image, 1.0);
    return (clip.xy / max(clip.w, 1.0e-6) * 0.5 + 0.5) * size - 0.5 +
           vec2(frame.jitter_step_x, frame.jitter_step_y);
}

struct neighbourhood {
    vec4 mean, deviation;
};

neighbourhood around(ivec2 pixel)
{
    vec4 sum = vec4(0.0), squares = vec4(0.0);
    ivec2 last = ivec2(frame.width, frame.height) - 1;
    for (int i = 0; i < 9; i++) {
        vec4 value =
            texelFetch(mean, clamp(pixel + ivec2(i % 3 - 1, i / 3 - 1), ivec2(0), last), 0);
        sum += value;
        squares += value * value;
    }
    sum /= 9.0;
    return neighbourhood(sum, sqrt(max(squares / 9.0 - sum * sum, 0.0)));
}

vec4 accumulated(ivec2 pixel, ssr_surface s, float distance_m, out float frames)
{
    vec2 size = vec2(frame.width, frame.height);
    vec4 now = texelFetch(mean, pixel, 0), moved = texelFetch(motion, pixel, 0);
    vec4 hit = texelFetch(hits, pixel / STEP, 0);
    neighbourhood near = around(pixel);
    float before_m = reproject_distance(moved, distance_m);
    vec2 place =
        reproject_place(moved, pixel, size, vec2(frame.jitter_step_x, frame.jitter_step_y));
    past by_surface = past_at(place, before_m),
         by_image = past_at(virtual_place(s, hit, size), before_m);
    bool image = by_image.frames > 0.0 &&
                 (by_surface.frames == 0.0 ||
                  distance(by_image.light, near.mean) < distance(by_surface.light, near.mean));
    past chosen = by_surface;
    if (image) chosen = by_image;
    bool known = ssr_of.has_history != 0u && before_m > 0.0 && chosen.frames > 0.0;
    float most_frames =
        max(MAX_FRAMES * ssr_spread(s.material.roughness, ssr_of.spread_roughness), 1.0);
    frames = known ? min(chosen.frames + 1.0, most_frames) : 1.0;
    vec4 most = near.mean + DEVIATIONS * near.deviation;
    vec4 least = near.mean - DEVIATIONS * near.deviation;
    return mix(clamp(chosen.light, least, most), now, 1.0 / frames);
}

void main()
{
    frame = frame_block;
    ssr_of = ssr_block;
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, ivec2(frame.width, frame.height)))) return;
    ssr_surface s = ssr_surface_at(pixel);
    float distance_m = frame_view_distance(max(texelFetch(depth, pixel, 0).r, 1.0e-12));
    vec4 light = vec4(0.0);
    float frames = 0.0;
    [[dont_unroll]] for (bool once = s.reflects; once; once = false) light =
        accumulated(pixel, s, distance_m, frames);
    imageStore(target, pixel, light);
    imageStore(target_surface, pixel, vec4(distance_m, frames, 0.0, 0.0));
    ssr_apply(s, pixel, light);
}
