// Temporal accumulation: the mean over up to 16 frames in which the pixel's surface was visible. A
// disoccluded surface starts again. A tap of the history is weighted by its depth difference.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#include "techniques/common/reproject.glsl"
#include "techniques/common/screen_ao.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 1) uniform sampler2D estimate; // visibility, depth
layout(set = 0, binding = 2) uniform sampler2D motion;   // at full resolution
layout(set = 0, binding = 3) uniform sampler2D history;  // visibility, depth, frames
layout(set = 0, binding = 4, rgba32f) uniform writeonly image2D target;

const float EDGE = 4.0;        // weight 0 at a quarter of a radius
const float MIN_WEIGHT = 0.25; // sum of the taps' weights; below it the history is rejected
const float MAX_FRAMES = 16.0;

// Visibility and frame count at a position in pixels of the estimate; (0, 0): no history.
vec2 history_at(vec2 position, float depth)
{
    float radius_px = clamp(view.radius_m * screen_pixels_per_m(view.previous_scale, depth),
                            MIN_RADIUS_PX, view.max_radius_px);
    float per_depth = EDGE * screen_radii_per_depth(view.previous_scale, radius_px, depth);
    vec2 sum = vec2(0.0);
    float weights = 0.0;
    for (int i = 0; i < 4; i++) {
        ivec2 at = reproject_tap(position, i);
        if (any(lessThan(at, ivec2(0))) ||
            any(greaterThanEqual(at, ivec2(view.work_width, view.work_height))))
            continue;
        vec3 tap = texelFetch(history, at, 0).rgb;
        float near = max(1.0 - abs(tap.y - depth) * per_depth, 0.0);
        float w = tap.y > 0.0 ? reproject_share(position, i) * near : 0.0;
        sum += w * tap.xz;
        weights += w;
    }
    return weights > MIN_WEIGHT ? sum / weights : vec2(0.0);
}

void main()
{
    ivec2 work = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(work, ivec2(view.work_width, view.work_height)))) return;
    vec2 now = texelFetch(estimate, work, 0).rg;
    vec2 past = vec2(0.0);
    if (now.y > 0.0 && view.has_history != 0u) {
        ivec2 pixel = work * SCREEN_AO_STEP;
        vec4 moved = texelFetch(motion, pixel, 0);
        vec2 position = reproject_place(moved, pixel, vec2(view.width, view.height),
                                        vec2(view.jitter_step_x, view.jitter_step_y)) /
                        float(SCREEN_AO_STEP);
        float distance_m = reproject_distance(moved, screen_distance(now.y));
        vec4 m = view.previous_depth_of_distance;
        float before = (m.x + m.y * distance_m) / (m.z + m.w * distance_m);
        if (distance_m > 0.0 && before > 0.0) past = history_at(position, before);
    }
    float frames = min(past.y + 1.0, MAX_FRAMES);
    imageStore(target, work, vec4(mix(past.x, now.x, 1.0 / frames), now.y, frames, 0.0));
}
