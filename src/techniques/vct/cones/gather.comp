// Half of the gathering stage (Hong 2015, sec. 4.2): each pixel adds up what the pixels beside it
// in a row (or, then, a column) have traced, as far as one surface reaches. After rows and columns
// each has the light of all cones.
//
// Of the pixels that trace the same part of the cones the two next to a pixel, before and after it,
// are interpolated: each sub-image is magnified bilinearly, and no lattice of the blocks' size is
// left. Where the surface ends on one side the other stands for both.
//
// One invocation does four pixels in a row: they share what they read.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#include "core/half.glsl"
#include "frame/frame_shared.h"
#include "frame/octahedral.glsl"
#include "techniques/vct/vct_constants.h"
#include "techniques/vct/cones/cones_shared.h"
#include "techniques/vct/cones/cone_sums.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(constant_id = VCT_CONSTANT_COLUMNS) const bool COLUMNS = false;
layout(constant_id = VCT_CONSTANT_EACH_PIXEL) const
    bool EACH_PIXEL = true; // pixel of the frame traces cones: columns write irradiance

layout(set = 0, binding = 2, scalar) uniform vct_cones
{
    vct_cone_params set;
};
layout(set = 0, binding = 3) uniform sampler2D edges;
layout(set = 0, binding = 4) uniform sampler2D red;
layout(set = 0, binding = 5) uniform sampler2D green;
layout(set = 0, binding = 6) uniform sampler2D blue;
layout(set = 0, binding = 7) uniform sampler2D normal;
layout(set = 0, binding = 8, rgba16f) uniform writeonly image2D red_sum;
layout(set = 0, binding = 9, rgba16f) uniform writeonly image2D green_sum;
layout(set = 0, binding = 10, rgba16f) uniform writeonly image2D blue_sum;
layout(set = 0, binding = 11,
       rgba16f) uniform writeonly image2D irradiance; // alpha: share of the cones

const int ROW = VCT_GATHER_ROW, REACH = VCT_MAX_INTERLEAVE - 1;

struct sums {
    vec4 red, green, blue;
};

// Bit i: between the pixels i and i + 1 of those that are read a surface ends, or the picture.
uint ends_of(ivec2 first, ivec2 along, int here, int count)
{
    uint ends = 0u;
    for (int i = 0; i < ROW + 2 * REACH - 1; i++) {
        int at = here + i - REACH;
        bool inside = at >= 0 && at < count - 1;
        uint bits =
            inside ? uint(texelFetch(edges, first + (i - REACH) * along, 0).r * 255.0 + 0.5) : 3u;
        ends |= (bits & (COLUMNS ? 2u : 1u)) != 0u ? 1u << i : 0u;
    }
    return ends;
}

// How far the surface of pixel `at` of those reaches before and after it, n − 1 pixels at most.
ivec2 reach_of(uint ends, int at, int n)
{
    int before = at - 1 - findMSB(ends & ((1u << at) - 1u));
    int after = findLSB(ends >> at | 1u << (n - 1));
    return ivec2(min(before, n - 1), after);
}

// Weight of the pixel `step` after (negative: before) one whose surface has that reach.
float weight_of(int step, ivec2 reach, int n)
{
    int other = n - abs(step);
    bool has = step < 0 ? -step <= reach.x : step <= reach.y;
    bool has_other = step < 0 ? other <= reach.y : other <= reach.x;
    return !has || other <= 0 ? 0.0 : step == 0 || !has_other ? 1.0 : float(other) / float(n);
}

void finish(ivec2 pixel, sums s)
{
    vec3 n = octahedral_decode(texelFetch(normal, pixel, 0).rg);
    vct_cone_sums v =
        vct_cone_sums(mat3(s.red.xyz, s.green.xyz, s.blue.xyz), vec3(s.red.w, s.green.w, s.blue.w));
    // A whole set has the mean of |n·d| over the sphere, a half.
    imageStore(
        irradiance, pixel,
        vec4(vct_irradiance(v, n, set.gain), clamp(2.0 * dot(n, v.direction_index), 0.0, 1.0)));
}

void keep(ivec2 pixel, sums s)
{
    imageStore(red_sum, pixel, clamp(s.red, -HALF_MAX, HALF_MAX));
    imageStore(green_sum, pixel, clamp(s.green, -HALF_MAX, HALF_MAX));
    imageStore(blue_sum, pixel, clamp(s.blue, -HALF_MAX, HALF_MAX));
}

void main()
{
    // Not COLUMNS ? ivec2(…) : ivec2(…): a vector chosen by a specialisation constant comes out as
    // the second one on Mesa 22.3.
    ivec2 along = ivec2(COLUMNS ? 0 : 1, COLUMNS ? 1 : 0);
    ivec2 size = ivec2(set.width, set.height);
    ivec2 first = ivec2(gl_GlobalInvocationID.xy) * (ivec2(1) + along * (ROW - 1));
    if (any(greaterThanEqual(first, size))) return;
    int n = int(set.interleave), here = COLUMNS ? first.y : first.x,
        count = COLUMNS ? size.y : size.x;
    uint ends = ends_of(first, along, here, count);
    ivec2 reach[ROW];
    sums s[ROW];
    for (int o = 0; o < ROW; o++) {
        reach[o] = reach_of(ends, o + REACH, n);
        s[o] = sums(vec4(0.0), vec4(0.0), vec4(0.0));
    }
    for (int i = REACH + 1 - n; i < ROW + REACH - 1 + n; i++) {
        ivec2 from = clamp(first + (i - REACH) * along, ivec2(0), size - 1);
        vec4 r = texelFetch(red, from, 0), g = texelFetch(green, from, 0),
             b = texelFetch(blue, from, 0);
        for (int o = 0; o < ROW; o++) {
            float weight = weight_of(i - REACH - o, reach[o], n);
            s[o].red += weight * r;
            s[o].green += weight * g;
            s[o].blue += weight * b;
        }
    }
    for (int o = 0; o < ROW; o++) {
        ivec2 pixel = first + o * along;
        if (any(greaterThanEqual(pixel, size))) continue;
        if (COLUMNS && EACH_PIXEL)
            finish(pixel, s[o]);
        else
            keep(pixel, s[o]);
    }
}
