#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require

// Bounds of the heights in each block of a sun's shadow map, by which most receivers are known to
// be lit or in shadow without the test (shadow_block.glsl). A receiver belongs to the block of the
// texel at or below it: the inner texels of the test's stencils are 9×9, each with its neighbours.
//
// Heights are bounded relative to a plane, so that slanted surfaces are known to be lit. Where they
// are far from it, a lower bound remains, below which every receiver is in shadow.
#include "core/shared.h"
#include "frame/shadow/shadow_limits.glsl"
#include "frame/shadow/shadow_plane.glsl"
#include "frame/shadow/shadow_shared.h"

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 0) uniform sampler2DArray shadow_sun_depths;
layout(set = 0, binding = 1, rgba16f) uniform writeonly image2DArray shadow_blocks;

layout(push_constant, scalar) uniform push_block
{
    shadow_blocks_push push;
};

// Heights in twelve texels of a row, from the one before the block's first.
struct block_row {
    vec4 low, middle, high;
};

struct block_bounds {
    shadow_plane plane;
    float deviation; // from the plane, of heights and of what the test extrapolates
    float occluder;  // least height of an occluder, whatever the receiver's position
};

float height_at(ivec2 texel)
{
    return texelFetch(shadow_sun_depths, ivec3(texel, push.layer), 0).r * push.depth_texels;
}

void read_rows(ivec2 first, out block_row lower, out block_row upper)
{
    vec2 to_uv = 1.0 / vec2(textureSize(shadow_sun_depths, 0).xy);
    vec4 quads[6];
    for (int i = 0; i < 6; i++) {
        vec2 corner = vec2(first + ivec2(2 * i + 1, 1));
        quads[i] = textureGather(shadow_sun_depths, vec3(corner * to_uv, float(push.layer))) *
                   push.depth_texels;
    }
    // A gather has the upper row first.
    lower = block_row(vec4(quads[0].wz, quads[1].wz), vec4(quads[2].wz, quads[3].wz),
                      vec4(quads[4].wz, quads[5].wz));
    upper = block_row(vec4(quads[0].xy, quads[1].xy), vec4(quads[2].xy, quads[3].xy),
                      vec4(quads[4].xy, quads[5].xy));
}

float largest(vec4 v)
{
    return max(max(v.x, v.y), max(v.z, v.w));
}

// Along one axis, from the rises to both neighbours: the error of the plane's slope, and what the
// test subtracts from the texel's height at most.
void bound_axis(vec4 before, vec4 after, float slope, inout vec4 error, inout vec4 drop)
{
    vec4 steepest_before = 1.0 + 2.0 * abs(after), steepest_after = 1.0 + 2.0 * abs(before);
    before = clamp(before, -steepest_before, steepest_before);
    after = clamp(after, -steepest_after, steepest_after);
    error += max(abs(before + slope), abs(after - slope));
    drop += max(max(before, 0.0) + SHADOW_SLOPE_TOLERANCE * abs(before),
                max(after, 0.0) + SHADOW_SLOPE_TOLERANCE * abs(after));
}

// Four texels of a row with their neighbours. at: of the first, from the block's first texel.
void bound_texels(vec4 h, vec4 left, vec4 right, vec4 down, vec4 up, vec2 at,
                  inout block_bounds bounds)
{
    vec2 slope = bounds.plane.slope;
    vec4 expected = bounds.plane.height + slope.x * (at.x + vec4(0, 1, 2, 3)) + slope.y * at.y;
    vec4 error = abs(h - expected);
    vec4 drop = vec4(SHADOW_TOLERANCE);
    bound_axis(left - h, right - h, slope.x, error, drop);
    bound_axis(down - h, up - h, slope.y, error, drop);
    bounds.deviation = max(bounds.deviation, largest(error));
    bounds.occluder = min(bounds.occluder, -largest(drop - h));
}

void bound_row(block_row down, block_row row, block_row up, float y, inout block_bounds bounds)
{
    bound_texels(vec4(row.low.yzw, row.middle.x), row.low, vec4(row.low.zw, row.middle.xy),
                 vec4(down.low.yzw, down.middle.x), vec4(up.low.yzw, up.middle.x), vec2(0, y),
                 bounds);
    bound_texels(vec4(row.middle.yzw, row.high.x), row.middle, vec4(row.middle.zw, row.high.xy),
                 vec4(down.middle.yzw, down.high.x), vec4(up.middle.yzw, up.high.x), vec2(4, y),
                 bounds);
    // The ninth and three of the eight again.
    bound_texels(vec4(row.middle.zw, row.high.xy), vec4(row.middle.yzw, row.high.x),
                 vec4(row.middle.w, row.high.xyz), vec4(down.middle.zw, down.high.xy),
                 vec4(up.middle.zw, up.high.xy), vec2(5, y), bounds);
}

// Through the middle texel, with the slopes of the lines through it, rounded as stored.
vec4 plane_at(ivec2 first)
{
    ivec2 middle = first + SHADOW_BLOCK / 2;
    const int side = SHADOW_BLOCK / 2 - 1;
    vec2 slope = vec2(height_at(middle + ivec2(side, 0)) - height_at(middle - ivec2(side, 0)),
                      height_at(middle + ivec2(0, side)) - height_at(middle - ivec2(0, side))) /
                 float(2 * side);
    float height = height_at(middle) - dot(slope, vec2(SHADOW_BLOCK / 2));
    return shadow_plane_texel(shadow_plane(height, slope, true));
}

block_bounds bounds_of(ivec2 first, shadow_plane plane)
{
    block_bounds bounds = block_bounds(plane, 0.0, 1e30);
    block_row a, b, c, d;
    read_rows(first - 1, a, b);
    for (int y = 0; y <= SHADOW_BLOCK; y += 2) {
        read_rows(first + ivec2(-1, y + 1), c, d);
        bound_row(a, b, c, float(y), bounds);
        bound_row(b, c, d, float(y + 1), bounds);
        a = c;
        b = d;
    }
    return bounds;
}

void main()
{
    ivec2 block = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(block, imageSize(shadow_blocks).xy))) return;
    vec4 texel = plane_at(SHADOW_BLOCK * block);
    block_bounds b = bounds_of(SHADOW_BLOCK * block, shadow_plane_of(texel));
    // Rounding errors of heights, and of positions up to 8192 texels.
    float slack = push.depth_texels / 1048576.0 + (1.0 + shadow_steepness(b.plane)) / 256.0;
    if (!(b.deviation + slack < shadow_deviation(b.plane)))
        texel = shadow_plane_texel(shadow_plane(b.occluder - slack, vec2(0.0), false));
    imageStore(shadow_blocks, ivec3(block, push.layer), texel);
}
