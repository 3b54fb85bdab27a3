#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require

// Temporal antialiasing: see antialias.h. The MOVES variant reprojects, tests and clips the
// history; without it nothing has changed since the last frame, and the mean goes on.
//
// The history is that of pixel centres: jitter averages out in it, so that its lookup by motion
// adds no jitter. In the MOVES variant colors are compressed by 1/(1 + luma), as Karis 2014, so
// that a single bright sample neither widens the clipping nor dominates the mean.
#define FRAME_CONSTANTS_COPIED
#include "frame/frame.glsl"
#include "frame/composite/antialias_shared.h"
#include "frame/composite/exposure_shared.h"

layout(local_size_x = 8, local_size_y = 8) in;

layout(constant_id = ANTIALIAS_CONSTANT_MOVES) const bool MOVES = false;
layout(constant_id = ANTIALIAS_CONSTANT_DISPLAY) const bool WRITES_DISPLAY = false;
layout(constant_id = ANTIALIAS_CONSTANT_AGX) const bool DISPLAY_AGX = false;
layout(constant_id = ANTIALIAS_CONSTANT_LINEAR) const bool DISPLAY_LINEAR = false;

#include "frame/composite/display.glsl"

layout(set = 0, binding = 1) uniform sampler2D radiance_layer;
layout(set = 0, binding = 2) uniform sampler2D depth_layer;
layout(set = 0, binding = 3) uniform sampler2D motion_layer;
layout(set = 0, binding = 4) uniform sampler2D last_history;
layout(set = 0, binding = 5, rgba32f) uniform writeonly image2D history;
layout(set = 0, binding = 6, rgba16f) uniform writeonly image2D color_layer;
layout(set = 0, binding = 7, rgba8) uniform writeonly image2D display_layer;
layout(set = 0, binding = 8, scalar) readonly buffer exposure_state
{
    exposure_values state;
};

layout(push_constant, scalar) uniform push_block
{
    antialias_push push;
};

const uint COUNT_BITS = 127u;
const float NO_SURFACE_M = 1e30; // stands for the distance of a pixel without a surface
// Standard deviations about the mean of the neighbourhood that the history may have.
const float CLIP = 1.0;
// Relative difference of distances of one surface, beside the range within the neighbourhood.
const float SAME_SURFACE = 0.02;
const float LEAST = 0.1; // sum of the four bilinear weights below which the history is rejected
const int TILE = 10;     // pixels of a group and of its border

shared vec4 tile[TILE * TILE]; // compressed color in YCoCg; depth

ivec2 image_size()
{
    return ivec2(frame.width, frame.height);
}

vec3 finite(vec3 radiance)
{
    return mix(radiance, vec3(0.0), isnan(radiance));
}

float distance_of(float depth)
{
    return depth > 0.0 ? frame_view_distance(depth) : NO_SURFACE_M;
}

float packed_distance(float distance_m, uint count)
{
    return uintBitsToFloat((floatBitsToUint(distance_m) & ~COUNT_BITS) | count);
}

uint count_of(vec4 stored)
{
    return floatBitsToUint(stored.a) & COUNT_BITS;
}

// ---- colors

// Scaled radiance to about 1 at the white of the display.
float exposed_scale()
{
    return exposure_scale(state.ev) / frame.radiance_scale;
}

vec3 compressed(vec3 radiance, float scale)
{
    vec3 c = radiance * scale;
    float luma = max(dot(c, vec3(0.25, 0.5, 0.25)), 0.0);
    c /= 1.0 + luma;
    return vec3(dot(c, vec3(0.25, 0.5, 0.25)), 0.5 * (c.r - c.b), dot(c, vec3(-0.25, 0.5, -0.25)));
}

vec3 expanded(vec3 ycocg, float scale)
{
    float t = ycocg.x - ycocg.z;
    vec3 c = vec3(t + ycocg.y, ycocg.x + ycocg.z, t - ycocg.y);
    return max(c, 0.0) / (max(1.0 - ycocg.x, 1e-4) * scale);
}

// ---- the neighbourhood

void load_tile(float scale)
{
    ivec2 first = ivec2(gl_WorkGroupID.xy) * 8 - 1;
    for (uint i = gl_LocalInvocationIndex; i < uint(TILE * TILE); i += 64u) {
        ivec2 at = clamp(first + ivec2(i % TILE, i / TILE), ivec2(0), image_size() - 1);
        vec3 radiance = finite(texelFetch(radiance_layer, at, 0).rgb);
        tile[i] = vec4(compressed(radiance, scale), texelFetch(depth_layer, at, 0).r);
    }
    barrier();
}

struct neighbourhood {
    vec3 low, high;  // compressed: what the history may have
    ivec2 nearest;   // offset of the nearest surface
    float near, far; // depths: the largest, and the least
};

neighbourhood neighbourhood_of(ivec2 local)
{
    neighbourhood n = neighbourhood(vec3(1e30), vec3(-1e30), ivec2(0), -1.0, 2.0);
    vec3 mean = vec3(0.0), squares = vec3(0.0);
    for (int y = 0; y < 3; y++)
        for (int x = 0; x < 3; x++) {
            vec4 value = tile[(local.y + y) * TILE + local.x + x];
            mean += value.rgb;
            squares += value.rgb * value.rgb;
            n.low = min(n.low, value.rgb);
            n.high = max(n.high, value.rgb);
            n.nearest = value.a > n.near ? ivec2(x, y) - 1 : n.nearest;
            n.near = max(n.near, value.a);
            n.far = min(n.far, value.a);
        }
    mean /= 9.0;
    vec3 deviation = CLIP * sqrt(max(squares / 9.0 - mean * mean, 0.0));
    n.low = max(n.low, mean - deviation);
    n.high = min(n.high, mean + deviation);
    return n;
}

// ---- the history

// Movement of a pixel without a surface, by the rotation of the camera.
vec2 motion_of_sky(ivec2 pixel)
{
    vec2 uv = frame_uv(uvec2(pixel));
    vec4 before = frame.previous_clip_from_world * vec4(frame_view_ray(uv), 0.0);
    return before.w > 1e-6 ? uv - (0.5 + 0.5 * before.xy / before.w) : vec2(0.0);
}

vec4 cubic_weights(float t)
{
    float t2 = t * t, t3 = t2 * t; // Catmull-Rom
    return vec4(-0.5 * t3 + t2 - 0.5 * t, 1.5 * t3 - 2.5 * t2 + 1.0, -1.5 * t3 + 2.0 * t2 + 0.5 * t,
                0.5 * t3 - 0.5 * t2);
}

vec4 history_texel(ivec2 at)
{
    return texelFetch(last_history, clamp(at, ivec2(0), image_size() - 1), 0);
}

vec3 cubic_history(ivec2 base, vec2 between, float scale)
{
    vec4 wx = cubic_weights(between.x), wy = cubic_weights(between.y);
    vec3 sum = vec3(0.0);
    for (int y = 0; y < 4; y++)
        for (int x = 0; x < 4; x++)
            sum += wx[x] * wy[y] * compressed(history_texel(base + ivec2(x, y) - 1).rgb, scale);
    return sum;
}

// Whether a pixel of the history shows the surface that is expected at a distance.
bool is_same(ivec2 at, float stored_m, float expected_m, float tolerance)
{
    float low = min(stored_m, expected_m), high = max(stored_m, expected_m);
    return high <= low * (1.0 + tolerance) && all(greaterThanEqual(at, ivec2(0))) &&
           all(lessThan(at, image_size()));
}

struct sampled_history {
    vec3 color;  // compressed
    float count; // 0: rejected
};

// The history at a place in pixels, with centres at whole numbers, of a surface at an expected
// distance: bicubic where all four pixels about it show this surface, else of those that do.
sampled_history sample_history(vec2 place, float expected_m, float tolerance, float scale)
{
    if (place == floor(place)) { // a static surface
        vec4 stored = history_texel(ivec2(place));
        bool same = is_same(ivec2(place), stored.a, expected_m, tolerance);
        return sampled_history(compressed(stored.rgb, scale), same ? float(count_of(stored)) : 0.0);
    }
    ivec2 base = ivec2(floor(place));
    vec2 between = place - vec2(base);
    vec3 sum = vec3(0.0);
    float weights = 0.0, count = 0.0;
    for (int i = 0; i < 4; i++) {
        ivec2 corner = ivec2(i & 1, i >> 1), at = base + corner;
        vec2 share = mix(1.0 - between, between, equal(corner, ivec2(1)));
        vec4 stored = history_texel(at);
        float weight = is_same(at, stored.a, expected_m, tolerance) ? share.x * share.y : 0.0;
        sum += weight * compressed(stored.rgb, scale);
        count += weight * float(count_of(stored));
        weights += weight;
    }
    if (weights < LEAST) return sampled_history(vec3(0.0), 0.0);
    vec3 color = sum / weights;
    if (weights > 0.999 && any(greaterThan(between, vec2(1e-4))))
        color = cubic_history(base, between, scale);
    return sampled_history(color, count / weights);
}

// The history of a pixel, clipped; place: in pixels.
sampled_history clipped_history(ivec2 pixel, neighbourhood n, float distance_m, float scale)
{
    ivec2 nearest = clamp(pixel + n.nearest, ivec2(0), image_size() - 1);
    vec4 moved = texelFetch(motion_layer, nearest, 0);
    if (n.near <= 0.0) moved = vec4(motion_of_sky(pixel), 0.0, 0.0);
    float expected_m = distance_m * (1.0 + moved.z);
    float tolerance = SAME_SURFACE + (n.far > 0.0 ? distance_of(n.far) / distance_m - 1.0 : 0.0);
    // At a silhouette before the background, all distances from the nearest on are expected.
    if (n.near > 0.0 && n.far <= 0.0) tolerance = NO_SURFACE_M;
    sampled_history h = sampled_history(vec3(0.0), 0.0);
    if (expected_m > 0.0)
        h = sample_history(vec2(pixel) - moved.xy * vec2(image_size()), expected_m, tolerance,
                           scale * frame.previous_scale_ratio);
    h.color = clamp(h.color, n.low, n.high);
    return h;
}

// ---- results

void write(ivec2 pixel, vec3 mean, float alpha)
{
    vec3 radiance = min(mean, vec3(HALF_MAX));
    imageStore(history, pixel, vec4(mean, alpha));
    imageStore(color_layer, pixel, vec4(radiance, 1.0));
    if (WRITES_DISPLAY)
        imageStore(display_layer, pixel, display_encoded(display_tone_mapped(radiance, state.ev)));
}

float nearest_distance(ivec2 pixel)
{
    float near = 0.0;
    for (int i = 0; i < 9; i++) {
        ivec2 at = clamp(pixel + ivec2(i % 3, i / 3) - 1, ivec2(0), image_size() - 1);
        near = max(near, texelFetch(depth_layer, at, 0).r);
    }
    return distance_of(near);
}

// The plain mean.
void accumulate(ivec2 pixel)
{
    vec3 now = finite(texelFetch(radiance_layer, pixel, 0).rgb);
    vec4 stored = texelFetch(last_history, pixel, 0);
    uint count = min(count_of(stored), push.most);
    if (count > 0u) {
        vec3 mean = stored.rgb * frame.previous_scale_ratio;
        mean += (now - mean) / float(count + 1u);
        write(pixel, mean, packed_distance(stored.a, count + 1u));
    } else {
        write(pixel, now, packed_distance(nearest_distance(pixel), 1u));
    }
}

void follow(ivec2 pixel, float scale)
{
    neighbourhood n = neighbourhood_of(ivec2(gl_LocalInvocationID.xy));
    float distance_m = distance_of(n.near);
    sampled_history h = clipped_history(pixel, n, distance_m, scale);
    float count = min(floor(h.count + 0.5), float(push.most));
    ivec2 local = ivec2(gl_LocalInvocationID.xy) + 1;
    vec3 now = tile[local.y * TILE + local.x].rgb;
    vec3 mean = mix(h.color, now, 1.0 / (count + 1.0));
    write(pixel, expanded(mean, scale), packed_distance(distance_m, uint(count) + 1u));
}

void main()
{
    frame = frame_block;
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    float scale = exposed_scale();
    if (MOVES) load_tile(scale);
    if (any(greaterThanEqual(pixel, image_size()))) return;
    if (MOVES)
        follow(pixel, scale);
    else
        accumulate(pixel);
}
