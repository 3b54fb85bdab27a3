// Injection of emissive surfaces: each point of the frame's list is a virtual light like a texel of
// a reflective shadow map (as in the Cornell box of Martin 2012), added to the same sums.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#include "core/sh.glsl"
#include "frame/frame_shared.h"
#include "techniques/lpv/lpv_grid.glsl"
#include "techniques/lpv/lpv_light.glsl"
#define LPV_WALLS_BINDING 3
#include "techniques/lpv/lpv_lookup.glsl"
#define LPV_SUMS_BINDING 2
#include "techniques/lpv/lpv_sums.glsl"

layout(local_size_x = LPV_EMITTERS_LOCAL) in;

layout(set = 0, binding = 1, scalar) readonly buffer frame_emitters
{
    frame_emitter emitters[];
};

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i >= lpv.emitter_count) return;
    frame_emitter light = emitters[i];
    float lobe[9];
    vec3 sum[9];
    lpv_unit_lobe(light.normal, lobe);
    for (int k = 0; k < 9; k++) sum[k] = light.flux * lobe[k];
    lpv_add(lpv_injection_cell(light.position, light.normal), sum);
}
