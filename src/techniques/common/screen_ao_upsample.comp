// Writes an estimate to the frame's visibility: a copy, or a depth-aware bilinear upsampling from
// half resolution.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#include "techniques/common/screen_ao.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 1) uniform sampler2D source; // visibility, depth
layout(set = 0, binding = 2) uniform sampler2D depth;
layout(set = 0, binding = 3, r8) uniform writeonly image2D visibility;

const float EDGE = 4.0;          // weight 0 at a quarter of a radius
const float MIN_WEIGHT = 1.0e-3; // of each neighbour's weight, so that their sum is never 0

float upsampled(ivec2 pixel)
{
    float here = texelFetch(depth, pixel, 0).r;
    if (here <= 0.0) return 1.0;
    float radius_px = screen_radius_px(view.radius_m, here);
    float per_depth = EDGE * screen_radii_per_depth(view.scale, radius_px, here);
    ivec2 last = ivec2(view.work_width, view.work_height) - 1;
    ivec2 first = pixel / SCREEN_AO_STEP;
    vec2 fraction = vec2(pixel - first * SCREEN_AO_STEP) / float(SCREEN_AO_STEP);
    float sum = 0.0, weights = 0.0;
    for (int i = 0; i < 4; i++) {
        ivec2 corner = ivec2(i & 1, i >> 1);
        vec2 share = mix(1.0 - fraction, fraction, equal(corner, ivec2(1)));
        vec2 value = texelFetch(source, min(first + corner, last), 0).rg;
        float w = share.x * share.y * max(1.0 - abs(value.y - here) * per_depth, MIN_WEIGHT);
        sum += w * value.x;
        weights += w;
    }
    return sum / weights;
}

void main()
{
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, ivec2(view.width, view.height)))) return;
    float result = SCREEN_AO_STEP == 1 ? texelFetch(source, pixel, 0).r : upsampled(pixel);
    imageStore(visibility, pixel, vec4(result));
}
