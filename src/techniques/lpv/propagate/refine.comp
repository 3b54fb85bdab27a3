// Start of a finer cascade's steps: the light of the next coarser one, which comes from further
// away than the steps reach. k steps keep the part of it that is older than k steps, T^k A, and
// replace the nearer light by S + TS + … + T^(k−1)S.
//
// Radiance is I · (w a)/a³ in cells of side a (apply.comp), so equal radiance has intensities
// ∝ a².
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#include "core/sh.glsl"
#include "techniques/lpv/lpv_grid.glsl"
#include "techniques/lpv/lpv_light.glsl"
#define LPV_WALLS_BINDING 3 // of the coarser cascade
#include "techniques/lpv/lpv_lookup.glsl"

layout(local_size_x = LPV_CELLS_LOCAL) in;

layout(push_constant, scalar) uniform push_block
{
    lpv_refine_push push;
};
layout(set = 0, binding = 1) uniform sampler3D coarser;
layout(set = 0, binding = 2) uniform writeonly image3D refined;

void main()
{
    ivec3 cell = lpv_cell_of_invocation(1);
    if (!lpv_inside(cell)) return;
    vec4 slabs[7];
    ivec3 cells = ivec3(push.cells_x, push.cells_y, push.cells_z);
    vec3 centre = push.first + push.ratio * (vec3(cell) + 0.5);
    vec3 at = lpv_visible(lpv_lookup_at(centre, centre, vec3(0.0), centre, cells), cells);
    lpv_sample_slabs(coarser, at, cells, slabs);
    for (int i = 0; i < 7; i++) slabs[i] *= push.ratio * push.ratio;
    lpv_store_slabs(refined, cell, slabs);
}
