#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require

// Reduces the sums of all work groups to the luminance floor (pass 0) and the exposure value
// (pass 1): the GPU twin of auto_exposure in image/tonemap.c. Luminance is clamped from below to
// DARK_SHARE of the log-average of lit pixels.
#include "frame/frame.glsl"
#include "frame/composite/exposure_shared.h"
#include "frame/composite/exposure_reduce.glsl"

layout(local_size_x = EXPOSURE_THREADS) in;

layout(set = 0, binding = 1, scalar) buffer exposure_state
{
    exposure_values state;
};
layout(set = 0, binding = 2, scalar) readonly buffer exposure_sums
{
    vec2 sums[];
};

layout(push_constant, scalar) uniform push_block
{
    exposure_push push;
};

const float DARK_SHARE = 0.25;
const float MIDDLE_GREY = 0.18;
const float EV_LIMIT = 100.0;

void main()
{
    vec2 sum = vec2(0.0);
    for (uint i = gl_LocalInvocationID.x; i < push.groups; i += EXPOSURE_THREADS) sum += sums[i];
    sum = sum_of_group(sum);
    if (gl_LocalInvocationID.x != 0) return;
    float mean_log2 = sum.x / max(sum.y, 1.0);
    if (push.pass_index == 0) {
        state.lit = sum.y > 0.0 ? 1 : 0;
        state.floor_log2 = mean_log2 + log2(DARK_SHARE);
        return;
    }
    if (state.lit == 0) mean_log2 = log2(max(push.fallback, 1e-30));
    // exposure_scale(ev) · mean = middle grey, with the mean in physical units.
    float ev = mean_log2 - log2(frame.radiance_scale) - log2(1.2 * MIDDLE_GREY);
    state.ev = state.lit != 0 || push.fallback > 0.0 ? clamp(ev, -EV_LIMIT, EV_LIMIT) : 0.0;
}
