// Rows of affine blocks in images, of which a driver on a processor loads 16 bytes at once.
// MRT_BLOCK_ROWS_BINDING is the includer's.
#ifndef AG_MRT_BLOCK_ROWS_GLSL
#define AG_MRT_BLOCK_ROWS_GLSL

#include "techniques/common/light_map/table.glsl"
#include "techniques/mrt/mrt_shared.h"

// [block][MRT_BLOCK_ROWS]: rows of the warp's inverse, each with a component of the block's middle;
// edges of the cell; the places of tiles in the light map by face, y above x, and two masks.
layout(set = 0, binding = MRT_BLOCK_ROWS_BINDING, rgba32ui) uniform readonly uimage2D block_rows;

uvec4 block_row(uint block, uint row)
{
    return imageLoad(block_rows, light_map_at(block * MRT_BLOCK_ROWS + row));
}

// Rows of the inverse, and the place of a point in the cell.
vec3 cell_by_rows(uint block, vec3 world, out vec3 inverse[3])
{
    vec3 middle, cell;
    for (uint a = 0u; a < 3u; a++) {
        vec4 row = uintBitsToFloat(block_row(block, MRT_ROW_INVERSE + a));
        inverse[a] = row.xyz;
        middle[a] = row.w;
    }
    for (int a = 0; a < 3; a++) cell[a] = dot(inverse[a], world - middle);
    return cell;
}

mat3 edges_by_rows(uint block)
{
    mat3 edges;
    for (uint a = 0u; a < 3u; a++)
        edges[a] = uintBitsToFloat(block_row(block, MRT_ROW_EDGES + a).xyz);
    return edges;
}

// Masks of faces: bit f is set where face f is a wall, MRT_ROW_OPENING << f with a block beyond.
uint faces_by_rows(uint block)
{
    return block_row(block, MRT_ROW_TILES + 1u).z;
}

// The first texel of a face's tile.
vec2 tile_by_rows(uint block, int face)
{
    uint word = block_row(block, MRT_ROW_TILES + (face < 4 ? 0u : 1u))[face & 3];
    return vec2(word & 0xffffu, word >> 16);
}

bool is_wall(uint faces, int face)
{
    return (faces & 1u << face) != 0u;
}

bool is_opening(uint faces, int face)
{
    return (faces & MRT_ROW_OPENING << face) != 0u;
}

#endif
