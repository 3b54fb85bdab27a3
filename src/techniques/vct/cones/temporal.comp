// The temporal filter: blends this frame with the reprojected history, see cones/temporal.c.
//
// A history pixel is weighted by its distance from the plane of the reprojected surface and by the
// difference of normals. The history stores depth and normal, so that the test holds for moving
// cameras and objects.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#define FRAME_CONSTANTS_BINDING 0
#define FRAME_CONSTANTS_COPIED
#include "core/half.glsl"
#include "frame/frame.glsl"
#include "frame/octahedral.glsl"
#include "techniques/common/reproject.glsl"
#include "techniques/vct/cones/cones_shared.h"
#include "techniques/vct/vct_constants.h"

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 1, scalar) uniform vct_history
{
    vct_history_params set_block;
};
vct_history_params set; // a copy that main begins with, as FRAME_CONSTANTS_COPIED
layout(set = 0, binding = 2) uniform sampler2D depth;
layout(set = 0, binding = 3) uniform sampler2D normal;
layout(set = 0, binding = 4) uniform sampler2D motion;
layout(set = 0, binding = 5) uniform sampler2D now;
layout(set = 0, binding = 6) uniform sampler2D last_light; // irradiance, accumulated frames
// Distance along the view axis, 0: none; packed normal; deviation of the sum of colours of one
// frame alone from the mean; that of the mean.
layout(set = 0, binding = 7) uniform sampler2D last_surface;
layout(set = 0, binding = 8, rgba32f) uniform writeonly image2D light;
layout(set = 0, binding = 9) uniform writeonly image2D surface;
layout(set = 0, binding = 10) uniform writeonly image2D irradiance;
layout(set = 0, binding = 11) uniform sampler2D last_now;
layout(set = 0, binding = 12) uniform sampler2D last_change;
layout(set = 0, binding = 13, rgba16f) uniform writeonly image2D change;
layout(constant_id = VCT_CONSTANT_RAYS) const bool VCT_RAYS = false;
layout(constant_id = VCT_CONSTANT_CLAMP) const bool VCT_CLAMP = false;
#include "techniques/vct/cones/history.glsl"

// Relative deviation of one frame from the mean over rotations: measured in a room with all
// bounces.
const float FRAME_NOISE = 0.025;
// Weight of a difference in a moving mean where pixels move: pixels that trace other cones of a
// block differ without a change of light.
const float MOVED_SHARE = 0.25;
const float LATER_BOUNCE = 0.5; // change of light by a bounce over that of the bounce before
const int RADIUS = 2;           // of the neighbourhood of the clamp, px

struct history_sample {
    vec4 light;      // irradiance, weight in frames; 0 frames: rejected
    vec3 now;        // of the previous frame alone
    vec3 change;     // last known change of it
    float deviation; // of one frame
};
const history_sample NO_HISTORY = history_sample(vec4(0.0), vec3(0.0), vec3(0.0), 0.0);

history_sample sample_history(vec2 history_pixel, float distance_m, vec3 n)
{
    vec4 expected = history_expected(history_pixel, distance_m);
    float weights = 0.0;
    history_sample sum = NO_HISTORY;
    for (int i = 0; i < 4; i++) {
        ivec2 at = reproject_tap(history_pixel, i);
        float weight = history_weight(history_pixel, i, expected, n);
        if (weight <= 0.0) continue;
        sum.light += weight * texelFetch(last_light, at, 0);
        if (VCT_RAYS) sum.deviation += weight * texelFetch(last_surface, at, 0).b;
        if (VCT_FOLLOWS != 0) {
            sum.now += weight * texelFetch(last_now, at, 0).rgb;
            float known = set.change_known != 0u ? weight : 0.0;
            if (known > 0.0) sum.change += known * texelFetch(last_change, at, 0).rgb;
        }
        weights += weight;
    }
    float w = weights > HISTORY_LEAST ? 1.0 / weights : 0.0, scale = set.scale * w;
    return history_sample(vec4(scale, scale, scale, w) * sum.light, scale * sum.now,
                          scale * sum.change, scale * sum.deviation);
}

float total(vec3 v)
{
    return v.r + v.g + v.b;
}

// Correlation of the noise of two frames of one rotation: see (1) of cones/temporal.c.
float correlation(vec3 before, vec3 after)
{
    float most = total(max(before, after));
    return most > 0.0 ? 1.0 - min(total(abs(after - before)) / most, 1.0) : 1.0;
}

// (1) of cones/temporal.c.
vec4 followed(vec4 history, vec3 before, vec3 after)
{
    float c = correlation(before, after), c2 = c * c;
    return vec4(max(after + c * (history.rgb - before), 0.0),
                history.w / (c2 + (1.0 - c2) * history.w));
}

// The variance of an unknown change, relative to that of one frame, adds to 1/w.
float less_certain(float w, vec3 before, vec3 after)
{
    float error = (1.0 - correlation(before, after)) / FRAME_NOISE;
    return w / (1.0 + error * error * w);
}

// The history after the change of light since the previous frame, how: VCT_FOLLOW_…. `change`: of
// one frame alone.
vec4 follow(history_sample history, vec3 now, bool moves, uint how, out vec3 change)
{
    change = history.change;
    if (how == VCT_FOLLOW_KNOWN) {
        change = mix(change, now - history.now, moves ? MOVED_SHARE : 1.0);
        return followed(history.light, history.now, max(history.now + change, 0.0));
    }
    vec4 light = history.light;
    vec3 expected = max(history.now + change, 0.0);
    if (how == VCT_FOLLOW_EXPECTED) light = followed(light, history.now, expected);
    change *= LATER_BOUNCE;
    return vec4(light.rgb, less_certain(light.w, history.now, expected));
}

vec3 position(ivec2 pixel, float z)
{
    return frame_world_position(frame_uv(uvec2(pixel)), z);
}
#include "techniques/vct/cones/deviation.glsl"

// Variance clamping: limits the history to mean ± set.clamp standard deviations of this frame's
// neighbours on the same surface.
vec3 clamped(vec3 history, ivec2 pixel, vec3 here, vec3 n, float tolerance_m)
{
    vec3 sum = vec3(0.0), squares = vec3(0.0);
    float count = 0.0;
    for (int y = -RADIUS; y <= RADIUS; y++)
        for (int x = -RADIUS; x <= RADIUS; x++) {
            ivec2 at = pixel + ivec2(x, y);
            if (any(lessThan(at, ivec2(0))) ||
                any(greaterThanEqual(at, ivec2(frame.width, frame.height))))
                continue;
            float z = texelFetch(depth, at, 0).r;
            if (z <= 0.0 ||
                dot(n, octahedral_decode(texelFetch(normal, at, 0).rg)) < HISTORY_LEAST_COSINE ||
                abs(dot(n, position(at, z) - here)) > tolerance_m)
                continue;
            vec3 value = texelFetch(now, at, 0).rgb;
            sum += value;
            squares += value * value;
            count += 1.0;
        }
    vec3 mean = sum / max(count, 1.0);
    vec3 spread = set.clamp * sqrt(max(squares / max(count, 1.0) - mean * mean, 0.0));
    return clamp(history, mean - spread, mean + spread);
}

void main()
{
    frame = frame_block;
    set = set_block;
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, ivec2(frame.width, frame.height)))) return;
    float z = texelFetch(depth, pixel, 0).r;
    vec3 mean = texelFetch(now, pixel, 0).rgb, known = vec3(0.0);
    vec2 stored = vec2(0.0);
    float frames = 0.0, deviation = 0.0;
    if (z > 0.0) {
        vec3 n = octahedral_decode(texelFetch(normal, pixel, 0).rg);
        float distance_m = frame_view_distance(z);
        vec4 moved = texelFetch(motion, pixel, 0);
        float distance_before = reproject_distance(moved, distance_m);
        history_sample history = NO_HISTORY;
        if (VCT_KNOWN != 0 && distance_before > 0.0)
            history =
                sample_history(reproject_place(moved, pixel, vec2(frame.width, frame.height),
                                               vec2(frame.jitter_step_x, frame.jitter_step_y)),
                               distance_before, n);
        if (VCT_CLAMP && history.light.w > 0.0)
            history.light.rgb =
                clamped(history.light.rgb, pixel, position(pixel, z), n,
                        HISTORY_TOLERANCE_PX * set.pixel * previous_scale(distance_m));
        bool moves = moved.xyz != vec3(0.0);
        vec4 old = vec4(history.light.rgb, min(history.light.w, set.most));
        float added = 1.0; // frames
        // Branches on uniforms alone would make lavapipe compile the shader in each frame.
        uint how = old.w > 0.0 ? set.follow : VCT_KEEP;
        if (VCT_FOLLOWS != 0 && how != VCT_KEEP) {
            history.light = old;
            old = follow(history, mean, moves, how, known);
            if (!moves) added = set.added;
        }
        if (VCT_RAYS) {
            deviation =
                VCT_KNOWN != 0
                    ? deviation_after(history.deviation, total(old.rgb), old.w, total(mean), added)
                    : spatial_deviation(pixel, position(pixel, z), n, distance_m, total(mean));
        }
        mean = (old.w * old.rgb + added * mean) / (old.w + added);
        frames = min(old.w + added, set.most);
        stored = vec2(distance_m, packed_normal(n));
    }
    imageStore(light, pixel, vec4(mean, frames));
    imageStore(surface, pixel, vec4(stored, deviation, deviation * inversesqrt(max(frames, 1.0))));
    if (VCT_FOLLOWS != 0) imageStore(change, pixel, vec4(clamp(known, -HALF_MAX, HALF_MAX), 0.0));
    if (!VCT_RAYS) imageStore(irradiance, pixel, vec4(mean, 1.0));
}
