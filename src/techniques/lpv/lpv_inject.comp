// Injection: every texel of every reflective shadow map is a virtual point light with the intensity
// I(ω) = Φ/π (n·ω)₊ lumen/sr (Martin 2012, sec. 3.2.1; flux Φ, so the 1/π), added to the cell half a cell along its
// normal as coefficients of two bands.
//
// Sums are whole numbers, so that no order of the invocations changes a bit: each coefficient has 64 bits in two words.
// The carry out of the low word is added to the high one; modulo 2^64 the total is exact whatever the order. One
// invocation takes a block of LPV_TEXELS² texels and adds once per run of texels that meet in one cell.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#include "core/sh.glsl"
#include "frame/frame_shared.h"
#include "frame/octahedral.glsl"
#include "frame/rsm/rsm.glsl"
#include "techniques/lpv/lpv_grid.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 1, scalar) readonly buffer rsm_faces
{
    rsm_face faces[];
};
layout(set = 0, binding = 2) uniform sampler2DArray rsm_depth;
layout(set = 0, binding = 3) uniform sampler2DArray rsm_normal;
layout(set = 0, binding = 4) uniform sampler2DArray rsm_flux;
// [cell][colour][coefficient][low, high]
layout(set = 0, binding = 5, scalar) buffer lpv_sums
{
    uint words[];
};

const int NO_CELL = -1;
const float LARGEST = 1073741824.0; // 2^30, what lpv_scale_of promises not to exceed

void add(int at, float value)
{
    int whole = int(roundEven(clamp(value * lpv.fixed_from_flux, -LARGEST, LARGEST)));
    if (whole == 0) return;
    uint low = uint(whole);
    uint before = atomicAdd(words[at], low);
    uint carry;
    uaddCarry(before, low, carry);
    uint high = (whole < 0 ? 0xffffffffu : 0u) + carry;
    if (high != 0u) atomicAdd(words[at + 1], high);
}

void add_lobe(int at, vec4 lobe)
{
    for (int i = 0; i < 4; i++) add(at + 2 * i, lobe[i]);
}

void main()
{
    int layer = int(gl_GlobalInvocationID.z);
    ivec2 first = ivec2(gl_GlobalInvocationID.xy) * LPV_TEXELS;
    ivec2 last = min(first + LPV_TEXELS, ivec2(lpv.rsm_size));
    rsm_face face = faces[layer];

    int cell = NO_CELL;
    vec4 red = vec4(0.0), green = vec4(0.0), blue = vec4(0.0);
    // One turn more than there are texels, to put the last run down.
    for (int i = 0; i <= LPV_TEXELS * LPV_TEXELS; i++) {
        ivec2 texel = first + ivec2(i % LPV_TEXELS, i / LPV_TEXELS);
        int next = NO_CELL;
        rsm_texel light;
        if (all(lessThan(texel, last))) {
            light = rsm_fetch(face, texel, layer, lpv.rsm_size, rsm_depth, rsm_normal, rsm_flux);
            ivec3 at = ivec3(floor(lpv_cells_from_world(light.position) + 0.5 * light.normal));
            if (light.valid && lpv_inside(at)) next = lpv_index(at);
        }
        if (next != cell) {
            if (cell != NO_CELL) {
                add_lobe(24 * cell, red);
                add_lobe(24 * cell + 8, green);
                add_lobe(24 * cell + 16, blue);
            }
            red = green = blue = vec4(0.0);
            cell = next;
        }
        if (next != NO_CELL) {
            vec4 lobe = sh4_clamped_cosine(light.normal) / SH_COSINE_0;
            red += light.flux.r * lobe;
            green += light.flux.g * lobe;
            blue += light.flux.b * lobe;
        }
    }
}
