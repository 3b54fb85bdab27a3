// The gathering pass (Hong 2015, sec. 4.2), separable: one dispatch sums cones along rows, a second
// one along columns. Sums stop at discontinuities. After both, each pixel has the whole cone set.
//
// Differs from the paper: the two nearest pixels of each sub-image, one on either side, are
// interpolated linearly, which leaves no pattern of the block size. If a discontinuity excludes
// one of the two, the other gets the full weight.
//
// Each invocation computes four adjacent pixels, which reuse its fetches.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require

#include "core/half.glsl"
#include "frame/frame_shared.h"
#include "frame/octahedral.glsl"
#include "techniques/vct/vct_constants.h"
#include "techniques/vct/cones/cones_shared.h"
#include "techniques/vct/cones/cone_sums.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(constant_id = VCT_CONSTANT_COLUMNS) const bool COLUMNS = false;
// Side of a block of pixels; 0: set.interleave. With a constant one the weights of pixels are, too.
layout(constant_id = VCT_CONSTANT_INTERLEAVE) const int INTERLEAVE = 0;
// At full resolution the column pass writes irradiance.
layout(constant_id = VCT_CONSTANT_EACH_PIXEL) const bool EACH_PIXEL = true;

layout(set = 0, binding = 2, scalar) uniform vct_cones
{
    vct_cone_params set_block;
};
vct_cone_params set; // a copy that main begins with, as FRAME_CONSTANTS_COPIED
layout(set = 0, binding = 3) uniform sampler2D edges;
layout(set = 0, binding = 4) uniform sampler2D red;
layout(set = 0, binding = 5) uniform sampler2D green;
layout(set = 0, binding = 6) uniform sampler2D blue;
layout(set = 0, binding = 7) uniform sampler2D normal;
layout(set = 0, binding = 8, rgba16f) uniform writeonly image2D red_sum;
layout(set = 0, binding = 9, rgba16f) uniform writeonly image2D green_sum;
layout(set = 0, binding = 10, rgba16f) uniform writeonly image2D blue_sum;
// Alpha: fraction of the cone set.
layout(set = 0, binding = 11, rgba16f) uniform writeonly image2D irradiance;

const int ROW = VCT_GATHER_ROW, REACH = VCT_MAX_INTERLEAVE - 1;

struct sums {
    vec4 red, green, blue;
};

// Bit i: a discontinuity or the image border between fetched pixels i and i + 1.
uint ends_of(ivec2 first, ivec2 axis, int here, int count)
{
    uint ends = 0u;
    for (int i = 0; i < ROW + 2 * REACH - 1; i++) {
        int at = here + i - REACH;
        bool inside = at >= 0 && at < count - 1;
        uint bits =
            inside ? uint(texelFetch(edges, first + (i - REACH) * axis, 0).r * 255.0 + 0.5) : 3u;
        ends |= (bits & (COLUMNS ? 2u : 1u)) != 0u ? 1u << i : 0u;
    }
    return ends;
}

// Pixels without a discontinuity before and after fetched pixel `at`, n − 1 at most.
ivec2 reach_of(uint ends, int at, int n)
{
    int before = at - 1 - findMSB(ends & ((1u << at) - 1u));
    int after = findLSB(ends >> at | 1u << (n - 1));
    return ivec2(min(before, n - 1), after);
}

// Interpolation weight of the pixel `step` after (negative: before) the one with this reach.
float weight_of(int step, ivec2 reach, int n)
{
    int other = n - abs(step);
    bool included = step < 0 ? -step <= reach.x : step <= reach.y;
    bool includes_other = step < 0 ? other <= reach.y : other <= reach.x;
    return !included || other <= 0        ? 0.0
           : step == 0 || !includes_other ? 1.0
                                          : float(other) / float(n);
}

void store_irradiance(ivec2 pixel, sums s)
{
    vec3 n = octahedral_decode(texelFetch(normal, pixel, 0).rg);
    vct_cone_sums v =
        vct_cone_sums(mat3(s.red.xyz, s.green.xyz, s.blue.xyz), vec3(s.red.w, s.green.w, s.blue.w));
    // A whole cone set has n·(Σ d) of about ½, the mean of |n·d| over the sphere.
    imageStore(irradiance, pixel,
               vec4(vct_irradiance(v, n, set.gain), clamp(2.0 * dot(n, v.direction), 0.0, 1.0)));
}

void store_sums(ivec2 pixel, sums s)
{
    imageStore(red_sum, pixel, clamp(s.red, -HALF_MAX, HALF_MAX));
    imageStore(green_sum, pixel, clamp(s.green, -HALF_MAX, HALF_MAX));
    imageStore(blue_sum, pixel, clamp(s.blue, -HALF_MAX, HALF_MAX));
}

void main()
{
    set = set_block;
    // Mesa 22.3 evaluates COLUMNS ? ivec2(…) : ivec2(…) to the second operand when COLUMNS is a
    // specialization constant.
    ivec2 axis = ivec2(COLUMNS ? 0 : 1, COLUMNS ? 1 : 0);
    ivec2 size = ivec2(set.width, set.height);
    ivec2 first = ivec2(gl_GlobalInvocationID.xy) * (ivec2(1) + axis * (ROW - 1));
    if (any(greaterThanEqual(first, size))) return;
    int n = INTERLEAVE > 0 ? INTERLEAVE : int(set.interleave), here = COLUMNS ? first.y : first.x,
        count = COLUMNS ? size.y : size.x;
    uint ends = ends_of(first, axis, here, count);
    ivec2 reach[ROW];
    sums s[ROW];
    for (int o = 0; o < ROW; o++) {
        reach[o] = reach_of(ends, o + REACH, n);
        s[o] = sums(vec4(0.0), vec4(0.0), vec4(0.0));
    }
    [[unroll]] for (int i = REACH + 1 - n; i < ROW + REACH - 1 + n; i++)
    {
        ivec2 from = clamp(first + (i - REACH) * axis, ivec2(0), size - 1);
        vec4 r = texelFetch(red, from, 0), g = texelFetch(green, from, 0),
             b = texelFetch(blue, from, 0);
        [[unroll]] for (int o = 0; o < ROW; o++)
        {
            float weight = weight_of(i - REACH - o, reach[o], n);
            s[o].red += weight * r;
            s[o].green += weight * g;
            s[o].blue += weight * b;
        }
    }
    for (int o = 0; o < ROW; o++) {
        ivec2 pixel = first + o * axis;
        if (any(greaterThanEqual(pixel, size))) continue;
        if (COLUMNS && EACH_PIXEL)
            store_irradiance(pixel, s[o]);
        else
            store_sums(pixel, s[o]);
    }
}
