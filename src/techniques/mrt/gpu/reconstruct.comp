// Indirect light at each texel: U_b b of its block, and U_r r for each opening of the block (Loos
// 2015, section 3.6.3, steps 3 and 5). With VALUES = 4, irradiance by normal.
//
// A group has texels of one wall, so that the coefficients are the same for all of them.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#define MRT_TILES_BINDING    2
#define MRT_BLOCKS_BINDING   3
#define MRT_OPENINGS_BINDING 4
#include "techniques/mrt/gpu/level.glsl"
#include "techniques/mrt/gpu/operators.glsl"

layout(local_size_x = MRT_LOCAL) in;

layout(constant_id = MRT_CONSTANT_VALUES) const uint VALUES = 1;
layout(constant_id = MRT_CONSTANT_CLUTTER) const bool CLUTTER = false;

layout(set = 0, binding = 5, scalar) readonly buffer mrt_b
{
    vec4 b_table[]; // [block][colour][quad]
};
layout(set = 0, binding = 6, scalar) readonly buffer mrt_r
{
    vec4 r_table[]; // [opening][colour][quad]
};
layout(set = 0, binding = 7) readonly buffer mrt_u_b
{
    uint u_b[]; // [row][value][k_b]
};
layout(set = 0, binding = 8) readonly buffer mrt_u_r
{
    uint u_r[]; // [response row][value][k_r]
};
layout(set = 0, binding = 9, scalar) writeonly buffer mrt_irradiance
{
    vec3 irradiance_table[]; // [texel][value]
};

shared vec4 coefficients[3 * MRT_MAX_QUADS];

// All invocations of the group call these two together.
void share_b(uint block)
{
    uint i = gl_LocalInvocationIndex;
    if (i < 3u * QUADS_B) coefficients[i] = b_table[block * 3u * QUADS_B + i];
    barrier();
}

void share_r(uint opening)
{
    uint i = gl_LocalInvocationIndex;
    barrier();
    if (i < 3u * QUADS_R) coefficients[i] = r_table[opening * 3u * QUADS_R + i];
    barrier();
}

void add_basis(uint row, inout vec3 sum[4])
{
    for (uint v = 0u; v < VALUES; v++)
        for (uint q = 0u; q < QUADS_B; q++) {
            vec4 weights = MRT_QUAD(u_b, (row * VALUES + v) * QUADS_B + q);
            for (uint c = 0u; c < 3u; c++) sum[v][c] += dot(weights, coefficients[c * QUADS_B + q]);
        }
}

// Clutter with few faces has few coefficients.
void add_response(uint row, uint used, inout vec3 sum[4])
{
    uint quads = CLUTTER ? used : QUADS_R;
    for (uint q = 0u; q < quads; q++)
        for (uint v = 0u; v < VALUES; v++) {
            vec4 weights = MRT_QUAD(u_r, (row * VALUES + v) * QUADS_R + q);
            for (uint c = 0u; c < 3u; c++) sum[v][c] += dot(weights, coefficients[c * QUADS_R + q]);
        }
}

void main()
{
    mrt_gpu_tile tile = tile_table[gl_WorkGroupID.y];
    uint i = gl_GlobalInvocationID.x;
    bool inside = i < level.texels_of_tile;
    vec3 sum[4] = { vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0) };
    share_b(tile.block);
    if (inside) add_basis(tile.basis_row + i, sum);
    uint first = block_table[tile.block].first_opening;
    for (uint k = 0u; k < block_table[tile.block].openings; k++) {
        share_r(first + k);
        mrt_gpu_opening opening = opening_table[first + k];
        if (inside) add_response(opening.response + tile.response_row + i, opening.quads, sum);
    }
    if (!inside) return;
    for (uint v = 0u; v < VALUES; v++)
        irradiance_table[(tile.first_texel + i) * VALUES + v] = sum[v];
}
