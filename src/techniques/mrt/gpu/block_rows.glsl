// Rows of affine blocks in images, of which a driver on a processor loads 16 bytes at once.
// MRT_BLOCK_ROWS_BINDING and MRT_CELL_ROWS_BINDING are the includer's.
#ifndef AG_MRT_BLOCK_ROWS_GLSL
#define AG_MRT_BLOCK_ROWS_GLSL

#include "techniques/common/light_map/table.glsl"
#include "techniques/mrt/mrt_shared.h"

// [block][MRT_BLOCK_ROWS]: rows of the warp's inverse, each with a component of the block's middle;
// the block's first tile, and masks of its faces.
layout(set = 0, binding = MRT_BLOCK_ROWS_BINDING, rgba32ui) uniform readonly uimage2D block_rows;

uvec4 block_row(uint block, uint row)
{
    return imageLoad(block_rows, light_map_at(block * MRT_BLOCK_ROWS + row));
}

// [cell of the lookup grid]: four blocks in it, or MRT_NO_BLOCK.
layout(set = 0, binding = MRT_CELL_ROWS_BINDING, rgba32ui) uniform readonly uimage2D cell_rows;

// A block, the rows of its inverse, and the place of a point in the cell.
struct mrt_rows {
    uint block;
    vec3 inverse[3];
    vec3 cell;
};

mrt_rows rows_of(uint block, vec3 world)
{
    mrt_rows rows;
    rows.block = block;
    vec3 middle;
    for (uint a = 0u; a < 3u; a++) {
        vec4 row = uintBitsToFloat(block_row(block, MRT_ROW_INVERSE + a));
        rows.inverse[a] = row.xyz;
        middle[a] = row.w;
    }
    for (int a = 0; a < 3; a++) rows.cell[a] = dot(rows.inverse[a], world - middle);
    return rows;
}

// The block that a point is in. False: it is in none.
bool find_rows(vec3 world, out mrt_rows rows)
{
    ivec3 cells = ivec3(level.cells_x, level.cells_y, level.cells_z);
    vec3 at = (world - level.grid_origin_m) * level.cells_per_m;
    ivec3 i = clamp(ivec3(at), ivec3(0), cells - 1);
    uvec4 list = imageLoad(cell_rows, light_map_at(uint((i.z * cells.y + i.y) * cells.x + i.x)));
    bool found;
    do {
        rows = rows_of(list.x == MRT_NO_BLOCK ? 0u : list.x, world);
        found = list.x != MRT_NO_BLOCK && all(lessThanEqual(abs(rows.cell), vec3(0.5)));
        list = uvec4(list.yzw, MRT_NO_BLOCK);
    } while (!found && list.x != MRT_NO_BLOCK);
    return found && all(greaterThanEqual(at, vec3(0.0))) && all(lessThan(at, vec3(cells)));
}

// Edges of the cell from the rows of its inverse, times a factor in common.
mat3 edges_by_rows(vec3 inverse[3])
{
    return mat3(cross(inverse[1], inverse[2]), cross(inverse[2], inverse[0]),
                cross(inverse[0], inverse[1]));
}

// x: the block's first tile; y: bit f is set where face f is a wall, MRT_ROW_OPENING << f with a
// block beyond.
uvec2 faces_by_rows(uint block)
{
    return block_row(block, MRT_ROW_FACES).xy;
}

bool is_wall(uvec2 faces, int face)
{
    return (faces.y & 1u << face) != 0u;
}

bool is_opening(uvec2 faces, int face)
{
    return (faces.y & MRT_ROW_OPENING << face) != 0u;
}

// The first texel of a wall's tile (level/atlas.c). In floats: software drivers have no vector
// division of integers.
vec2 tile_of(uvec2 faces, int face)
{
    float tile = float(faces.x) + float(bitCount(faces.y & (1u << face) - 1u));
    float edge = float(level.resolution + 2u), columns = float(level.map_width) / edge;
    float row = floor((tile + 0.5) / columns);
    return edge * vec2(tile - row * columns, row) + 1.0;
}

#endif
