// The geometry volume to the transmittance between neighbours (geometry_transmittance.glsl),
// precomputed for all steps.
#version 460
#extension GL_EXT_control_flow_attributes : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#include "core/sh.glsl"
#include "techniques/lpv/lpv_grid.glsl"
#define LPV_GEOMETRY_BINDING 1
#include "techniques/lpv/geometry/geometry.glsl"
#define LPV_TRANSMITTANCE_BINDING 2
#define LPV_TRANSMITTANCE_ACCESS  writeonly
#include "techniques/lpv/geometry/geometry_transmittance.glsl"

layout(local_size_x = LPV_CELLS_LOCAL) in;

float transmittance(ivec3 cell, ivec3 offset)
{
    return lpv_inside(cell + offset) ? lpv_transmittance_of(cell, offset) : 0.0;
}

uint along_axis(ivec3 cell, int axis)
{
    float low = cell[axis] > 0 ? lpv_transmittance_along(cell, axis, -1) : 0.0;
    bool inside = cell[axis] + 1 < lpv_cells()[axis];
    float high = inside ? lpv_transmittance_along(cell, axis, 1) : 0.0;
    return packUnorm4x8(vec4(low, high, 0.0, 0.0));
}

uint in_column(ivec3 cell, ivec2 step)
{
    return packUnorm4x8(vec4(transmittance(cell, ivec3(step, -1)),
                             transmittance(cell, ivec3(step, 0)),
                             transmittance(cell, ivec3(step, 1)), 0.0));
}

void main()
{
    ivec3 cell = lpv_cell_of_invocation(1);
    if (!lpv_inside(cell)) return;
    int first = LPV_TRANSMITTANCE_WORDS * lpv_index(cell);
    [[unroll]] for (int i = 0; i < LPV_TRANSMITTANCE_WORDS; i++) transmittance_words[first + i] =
        LPV_NEIGHBOURS == 26 ? in_column(cell, ivec2(i % 3, i / 3) - 1) : along_axis(cell, i);
}
