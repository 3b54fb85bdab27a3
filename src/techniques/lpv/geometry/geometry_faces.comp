// Coverage masks to the geometry volume: the share of the light across each face that surfaces
// occlude. A line counts where no surface separates it from the centre of the source: light stands
// for the part of its cell that the centre sees, so that walls inside cells neither leak nor dim
// the light along them. A line must also be on the side of the receiver's centre.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#include "techniques/lpv/lpv_grid.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

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

const uint LINES = (1u << LPV_LINES * LPV_LINES) - 1u;

uint mask_at(ivec3 cell, int axis)
{
    if (!lpv_inside(cell)) return 0u;
    int at = 3 * lpv_index(cell) + axis;
    return static_masks[at] | moving_masks[at];
}

// Whether a surface lies between the centre of a cell and its line `along` of axis b, in the row
// `across` of axis c.
bool is_cut_off(ivec3 cell, int b, int along, int c, int across)
{
    bool above = 2 * along >= LPV_LINES;
    if (above) cell[b]++;
    uint mask = mask_at(cell, b), row = 0u;
    for (int i = 0; i < LPV_LINES; i++)
        row |= 1u << (c == (b + 1) % 3 ? i * LPV_LINES + across : across * LPV_LINES + i);
    // Places of the cell's half of the interval up to the line.
    uint count = uint(above ? 2 * along + 1 - LPV_LINES : LPV_LINES - 2 * along - 1) * LPV_PLACES /
                 uint(2 * LPV_LINES);
    uint places = ((1u << count) - 1u) << (above ? 0u : LPV_PLACES - count);
    return 2 * bitCount(mask & row) >= LPV_LINES &&
           (mask >> (LPV_LINES * LPV_LINES) & places) != 0u;
}

// Lines along an axis that a surface separates from the centre of the cell.
uint cut_off(ivec3 cell, int axis)
{
    int b = (axis + 1) % 3, c = (axis + 2) % 3;
    uint lines = 0u;
    for (int i = 0; i < LPV_LINES * LPV_LINES; i++) {
        ivec2 line = ivec2(i % LPV_LINES, i / LPV_LINES);
        if (is_cut_off(cell, b, line.x, c, line.y) || is_cut_off(cell, c, line.y, b, line.x))
            lines |= 1u << i;
    }
    return lines;
}

// Share of the lines of a cell's light that do not continue.
float occluded(uint from, uint free)
{
    return from == 0u ? 1.0 : 1.0 - float(bitCount(from & free)) / float(bitCount(from));
}

void main()
{
    ivec3 cell = ivec3(gl_GlobalInvocationID);
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
        if (crossed != 0u)
            word |= (bitCount(crossed) | uint(findLSB(places) + findMSB(places)) << 5)
                    << (10 * axis);
    }
    walls[lpv_index(cell)] = word;
    imageStore(geometry, cell, vec4(upwards, 0.0));
    imageStore(geometry, cell + ivec3(0, 0, lpv.dim), vec4(downwards, 0.0));
}
