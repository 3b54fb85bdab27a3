// Integer sums to coefficients: intensity in the grid's unit (scaled lumen/sr × a power of two).
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#include "core/sh.glsl"
#include "techniques/lpv/lpv_grid.glsl"
#include "techniques/lpv/lpv_light.glsl"

layout(local_size_x = LPV_CELLS_LOCAL) in;

layout(set = 0, binding = 1, scalar) readonly buffer lpv_sums
{
    uint words[];
};
layout(set = 0, binding = 2) uniform writeonly image3D injected;

// A 64-bit two's complement integer, negated first where negative: as floats the halves of −1 would
// cancel.
float value_at(int at)
{
    uint low = words[at], high = words[at + 1];
    bool negative = (high & 0x80000000u) != 0u;
    if (negative) {
        low = ~low + 1u;
        high = ~high + (low == 0u ? 1u : 0u);
    }
    float value = float(high) * 4294967296.0 + float(low);
    return (negative ? -value : value) * lpv.grid_from_fixed;
}

void main()
{
    ivec3 cell = lpv_cell_of_invocation(1);
    if (!lpv_inside(cell)) return;
    int at = 2 * LPV_VALUES * lpv_index(cell);
    for (int i = 0; i < LPV_SLABS; i++, at += 8)
        lpv_store_slab(injected, cell, i,
                       vec4(value_at(at), value_at(at + 2), value_at(at + 4), value_at(at + 6)));
}
