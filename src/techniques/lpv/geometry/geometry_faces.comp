// Coverage masks to the geometry volume: the share of the light across each face that surfaces
// occlude. A line counts where no surface separates it from the centre of the source: light stands
// for the part of its cell that the centre sees, so that walls inside cells neither leak nor dim
// the light along them. A line must also be on the side of the receiver's centre.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#include "techniques/lpv/lpv_grid.glsl"

layout(local_size_x = LPV_CELLS_LOCAL) in;

layout(set = 0, binding = 1, scalar) readonly buffer lpv_static_coverage
{
    uint static_masks[]; // [cell][axis]
};
layout(set = 0, binding = 2, scalar) readonly buffer lpv_moving_coverage
{
    uint moving_masks[];
};
layout(set = 0, binding = 3, rgba16f) uniform writeonly image3D geometry;
layout(set = 0, binding = 4, scalar) writeonly buffer lpv_walls
{
    uint walls[]; // [cell]: lpv_lookup.glsl
};

#if LPV_LINES != 4
#error "sets of lines have four bits"
#endif
const uint LINES = (1u << LPV_LINES * LPV_LINES) - 1u;

uint mask_at(ivec3 cell, int axis)
{
    if (!lpv_inside(cell)) return 0u;
    int at = 3 * lpv_index(cell) + axis;
    return static_masks[at] | moving_masks[at];
}

// ---- Sets of lines, four bits by a coordinate of the line. Bit 4 y + x of a mask is line (x, y).

// Rows of constant x with at least half of their lines crossed.
uint crossed_along_y(uint mask)
{
    uint a = mask, b = mask >> 4, c = mask >> 8, d = mask >> 12;
    return ((a & b) | (c & d) | ((a | b) & (c | d))) & 15u;
}

// Rows of constant y.
uint crossed_along_x(uint mask)
{
    uint a = mask, b = mask >> 1, c = mask >> 2, d = mask >> 3;
    uint rows = ((a & b) | (c & d) | ((a | b) & (c | d))) & 0x1111u;
    return (rows | rows >> 3 | rows >> 6 | rows >> 9) & 15u;
}

// All lines of four values of x, of y.
uint lines_of_x(uint set)
{
    return set * 0x1111u;
}

uint lines_of_y(uint set)
{
    uint first = (set & 1u) | (set & 2u) << 3 | (set & 4u) << 6 | (set & 8u) << 9;
    return first * 15u;
}

// Coordinates 0 … 3 of the lines along the axis of two faces, of the low and the high side of a
// cell, that a surface on one of the faces separates from the cell's centre. Lines are 1/8 and 3/8
// of a cell from the centre, places count from the lower centre.
uint behind_low(uint mask)
{
    uint places = mask >> (LPV_LINES * LPV_LINES);
    const uint FAR = LPV_PLACES - 3u * LPV_PLACES / 8u, NEAR = LPV_PLACES - LPV_PLACES / 8u;
    return (places >> FAR != 0u ? 1u : 0u) | (places >> NEAR != 0u ? 2u : 0u);
}

uint behind_high(uint mask)
{
    uint places = mask >> (LPV_LINES * LPV_LINES);
    const uint FAR = 3u * LPV_PLACES / 8u, NEAR = LPV_PLACES / 8u;
    return ((places & ((1u << NEAR) - 1u)) != 0u ? 4u : 0u) |
           ((places & ((1u << FAR) - 1u)) != 0u ? 8u : 0u);
}

// Lines along an axis that a surface separates from the centre of a cell. Masks of the faces across
// the next axis, whose x is that of the one after, and across the one after, whose y is the next.
// A surface separates a line where it crosses half of the row that passes the line.
uint cut_off(ivec3 cell, int axis)
{
    int b = (axis + 1) % 3, c = (axis + 2) % 3;
    ivec3 above_b = cell, above_c = cell;
    above_b[b]++;
    above_c[c]++;
    uint low_b = mask_at(cell, b), high_b = mask_at(above_b, b);
    uint low_c = mask_at(cell, c), high_c = mask_at(above_c, c);
    return (lines_of_x(behind_low(low_b)) & lines_of_y(crossed_along_y(low_b))) |
           (lines_of_x(behind_high(high_b)) & lines_of_y(crossed_along_y(high_b))) |
           (lines_of_y(behind_low(low_c)) & lines_of_x(crossed_along_x(low_c))) |
           (lines_of_y(behind_high(high_c)) & lines_of_x(crossed_along_x(high_c)));
}

// Share of the lines of a cell's light that do not continue.
float occluded(uint from, uint free)
{
    return from == 0u ? 1.0 : float(bitCount(from & ~free)) / float(bitCount(from));
}

// Bits of lpv_lookup.glsl. Lines that are not on the side of a centre may pass beside a building:
// surfaces close the side of a centre where they cross all of its lines.
uint wall_bits(uint there, uint here, uint crossed, uint places)
{
    uint closed = ((there & ~crossed) == 0u ? 1u : 0u) | ((here & ~crossed) == 0u ? 2u : 0u);
    uint place = uint(findLSB(places) + findMSB(places)) / 2u;
    return min(uint(bitCount(crossed)), LPV_MOST_LINES) | closed << 4 | place << 6;
}

void main()
{
    ivec3 cell = lpv_cell_of_invocation(1);
    if (!lpv_inside(cell)) return;
    vec3 upwards = vec3(0.0), downwards = vec3(0.0);
    uint word = 0u;
    for (int axis = 0; axis < 3; axis++) {
        uint mask = mask_at(cell, axis);
        uint crossed = mask & LINES, places = mask >> (LPV_LINES * LPV_LINES);
        ivec3 below = cell;
        below[axis]--;
        uint here = LINES & ~cut_off(cell, axis), there = LINES & ~cut_off(below, axis);
        upwards[axis] = occluded(there, here & ~crossed);
        downwards[axis] = occluded(here, there & ~crossed);
        if (crossed != 0u) word |= wall_bits(there, here, crossed, places) << (10 * axis);
    }
    walls[lpv_index(cell)] = word;
    imageStore(geometry, cell, vec4(upwards, 0.0));
    imageStore(geometry, cell + ivec3(0, 0, lpv.dim), vec4(downwards, 0.0));
}
