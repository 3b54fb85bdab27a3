// The temporal filter: blends this frame with the reprojected history, see cones/temporal.c.
//
// A history pixel is weighted by its distance from the plane of the reprojected surface and by the
// difference of normals. The history stores depth and normal, so that the test holds for moving
// cameras and objects.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#define FRAME_CONSTANTS_BINDING 0
#include "frame/frame.glsl"
#include "frame/octahedral.glsl"
#include "techniques/common/reproject.glsl"
#include "techniques/vct/cones/cones_shared.h"

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 1, scalar) uniform vct_history
{
    vct_history_params set;
};
layout(set = 0, binding = 2) uniform sampler2D depth;
layout(set = 0, binding = 3) uniform sampler2D normal;
layout(set = 0, binding = 4) uniform sampler2D motion;
layout(set = 0, binding = 5) uniform sampler2D now;
layout(set = 0, binding = 6) uniform sampler2D last_light; // irradiance, accumulated frames
// Distance along the view axis, 0: none; packed normal.
layout(set = 0, binding = 7) uniform sampler2D last_surface;
layout(set = 0, binding = 8, rgba32f) uniform writeonly image2D light;
layout(set = 0, binding = 9, rg32f) uniform writeonly image2D surface;
layout(set = 0, binding = 10) uniform writeonly image2D irradiance;

const float LEAST_COSINE = 0.9; // of two normals of one surface: 26 degrees
const float TOLERANCE_PX = 4.0; // distance from the plane, in pixel widths at that depth
const float LEAST = 0.1;        // sum of the four tap weights below which history is rejected
const float NORMAL_STEPS = 4096.0;
const int RADIUS = 2; // of the neighbourhood of the clamp, px

// Octahedral, two times 12 bits as an integer that a float represents exactly.
float packed_normal(vec3 n)
{
    vec2 whole = round(clamp(octahedral_encode(n) * 0.5 + 0.5, 0.0, 1.0) * (NORMAL_STEPS - 1.0));
    return whole.x + NORMAL_STEPS * whole.y;
}

vec3 unpacked_normal(float bits)
{
    float y = floor(bits / NORMAL_STEPS);
    return octahedral_decode(vec2(bits - NORMAL_STEPS * y, y) / (NORMAL_STEPS - 1.0) * 2.0 - 1.0);
}

// Point relative to the previous camera.
vec3 previous_point(vec2 pixel, float distance_m)
{
    return distance_m * (set.forward + pixel.x * set.right + pixel.y * set.down);
}

float normal_similarity(vec3 a, vec3 b)
{
    return clamp((dot(a, b) - LEAST_COSINE) / (1.0 - LEAST_COSINE), 0.0, 1.0);
}

// Irradiance, accumulated frames; 0 frames: rejected.
vec4 sample_history(vec2 history_pixel, float distance_m, vec3 n)
{
    vec3 expected = previous_point(history_pixel, distance_m);
    float per_metre = 1.0 / (TOLERANCE_PX * set.pixel * distance_m), weights = 0.0;
    vec4 sum = vec4(0.0);
    for (int i = 0; i < 4; i++) {
        ivec2 at = reproject_tap(history_pixel, i);
        if (any(lessThan(at, ivec2(0))) ||
            any(greaterThanEqual(at, ivec2(frame.width, frame.height))))
            continue;
        vec2 stored = texelFetch(last_surface, at, 0).rg;
        if (stored.x <= 0.0) continue;
        vec3 stored_normal = unpacked_normal(stored.y);
        float plane_distance_m =
            abs(dot(stored_normal, previous_point(vec2(at), stored.x) - expected));
        float weight = reproject_share(history_pixel, i) *
                       max(1.0 - plane_distance_m * per_metre, 0.0) *
                       normal_similarity(n, stored_normal);
        sum += weight * texelFetch(last_light, at, 0);
        weights += weight;
    }
    return weights > LEAST ? sum / weights : vec4(0.0);
}

vec3 position(ivec2 pixel, float z)
{
    return frame_world_position(frame_uv(uvec2(pixel)), z);
}

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
                dot(n, octahedral_decode(texelFetch(normal, at, 0).rg)) < LEAST_COSINE ||
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
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, ivec2(frame.width, frame.height)))) return;
    float z = texelFetch(depth, pixel, 0).r;
    vec3 mean = texelFetch(now, pixel, 0).rgb;
    vec2 stored = vec2(0.0);
    float frames = 0.0;
    if (z > 0.0) {
        vec3 n = octahedral_decode(texelFetch(normal, pixel, 0).rg);
        float distance_m = frame_view_distance(z);
        vec4 moved = texelFetch(motion, pixel, 0);
        float distance_before = reproject_distance(moved, distance_m);
        vec4 history = vec4(0.0);
        if (set.known != 0u && distance_before > 0.0)
            history = sample_history(reproject_place(moved, pixel, vec2(frame.width, frame.height)),
                                     distance_before, n);
        history.rgb *= set.scale;
        if (set.clamp > 0.0 && history.w > 0.0)
            history.rgb = clamped(history.rgb, pixel, position(pixel, z), n,
                                  TOLERANCE_PX * set.pixel * distance_m);
        float weight = min(history.w, set.most);
        mean = (weight * history.rgb + mean) / (weight + 1.0);
        frames = min(weight + 1.0, set.most);
        stored = vec2(distance_m, packed_normal(n));
    }
    imageStore(light, pixel, vec4(mean, frames));
    imageStore(surface, pixel, vec4(stored, 0.0, 0.0));
    imageStore(irradiance, pixel, vec4(mean, 1.0));
}
