// Injection: every texel of every reflective shadow map is a virtual point light of the intensity
// I(ω) = Φ/π (n·ω)₊ lumen/sr (Martin 2012, sec. 3.2.1; flux Φ, therefore 1/π). It is added to the
// cell half a cell along its normal, as coefficients of two or three bands. One invocation takes a
// block of LPV_TEXELS² texels and adds once per run of texels in the same cell.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#include "core/sh.glsl"
#include "frame/frame_shared.h"
#include "frame/octahedral.glsl"
#include "frame/rsm/rsm.glsl"
#include "techniques/lpv/lpv_grid.glsl"
#include "techniques/lpv/lpv_light.glsl"
#define LPV_WALLS_BINDING 6
#include "techniques/lpv/lpv_lookup.glsl"
#define LPV_SUMS_BINDING 5
#include "techniques/lpv/lpv_sums.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 1, scalar) readonly buffer rsm_faces
{
    rsm_face faces[];
};
layout(set = 0, binding = 2) uniform sampler2DArray rsm_depth;
layout(set = 0, binding = 3) uniform sampler2DArray rsm_normal;
layout(set = 0, binding = 4) uniform sampler2DArray rsm_flux;

void main()
{
    int layer = int(gl_GlobalInvocationID.z);
    ivec2 first = ivec2(gl_GlobalInvocationID.xy) * LPV_TEXELS;
    ivec2 last = min(first + LPV_TEXELS, ivec2(lpv.rsm_size));
    rsm_face face = faces[layer];

    int cell = LPV_NO_CELL;
    vec3 sum[9];
    for (int k = 0; k < 9; k++) sum[k] = vec3(0.0);
    // One iteration more than there are texels, to flush the last run.
    for (int i = 0; i <= LPV_TEXELS * LPV_TEXELS; i++) {
        ivec2 texel = first + ivec2(i % LPV_TEXELS, i / LPV_TEXELS);
        int next = LPV_NO_CELL;
        rsm_texel light;
        if (all(lessThan(texel, last))) {
            light = rsm_fetch(face, texel, layer, lpv.rsm_size, rsm_depth, rsm_normal, rsm_flux);
            if (light.valid) next = lpv_injection_cell(light.position, light.normal);
        }
        if (next != cell) {
            lpv_add(cell, sum);
            for (int k = 0; k < 9; k++) sum[k] = vec3(0.0);
            cell = next;
        }
        if (next != LPV_NO_CELL) {
            float lobe[9];
            lpv_unit_lobe(light.normal, lobe);
            for (int k = 0; k < 9; k++) sum[k] += light.flux * lobe[k];
        }
    }
}
