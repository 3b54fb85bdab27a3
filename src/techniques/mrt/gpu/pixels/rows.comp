// The tables of pixels' lookups (rows.glsl), from those of the level. Once for a level.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require

#define MRT_BLOCKS_BINDING     3
#define MRT_CELLS_BINDING      4
#define MRT_CANDIDATES_BINDING 5
#include "techniques/common/light_map/table.glsl"
#include "techniques/mrt/gpu/locate.glsl"

layout(local_size_x = MRT_LOCAL) in;

layout(push_constant, scalar) uniform push_block
{
    mrt_rows_push push;
};
layout(set = 0, binding = 6, rgba32ui) uniform writeonly uimage2D block_rows;
layout(set = 0, binding = 7, rgba32ui) uniform writeonly uimage2D cell_rows;

void store(uint block, uint row, uvec4 words)
{
    imageStore(block_rows, light_map_at(block * MRT_BLOCK_ROWS + row), words);
}

void store_block(uint block)
{
    uint first = 0u, faces = 0u;
    for (uint a = 0u; a < 3u; a++)
        store(block, MRT_ROW_INVERSE + a,
              uvec4(floatBitsToUint(block_table[block].inverse[a]),
                    floatBitsToUint(block_table[block].middle[a])));
    for (int f = 5; f >= 0; f--) {
        int tile = block_table[block].tile[f];
        if (tile >= 0) first = uint(tile);
        if (tile >= 0) faces |= 1u << f;
        if (block_table[block].neighbor[f] >= 0) faces |= MRT_ROW_OPENING << f;
    }
    store(block, MRT_ROW_FACES, uvec4(first, faces, 0u, 0u));
}

// Edges of the block between it and the middle of a cell of the lookup grid, less than 0 inside.
// Returns whether the block is in the cell.
bool is_in_cell(uint block, uint cell, out float distance)
{
    uint x = uint(level.cells_x), y = uint(level.cells_y);
    vec3 at = vec3(cell % x, cell / x % y, cell / (x * y)) + 0.5;
    vec3 way = level.grid_origin_m + at / level.cells_per_m - block_table[block].middle;
    bool inside = true;
    distance = -1.0;
    for (uint a = 0u; a < 3u; a++) {
        vec3 row = block_table[block].inverse[a];
        float half_size = 0.5 / level.cells_per_m * dot(abs(row), vec3(1.0));
        float beyond = abs(dot(row, way)) - 0.5;
        inside = inside && beyond <= half_size;
        distance = max(distance, beyond);
    }
    return inside;
}

// The blocks in a cell, those that have most of it first.
void store_cell(uint cell)
{
    uvec2 list = cell_table[cell];
    uvec4 blocks = uvec4(MRT_NO_BLOCK);
    vec4 distances = vec4(1e30);
    for (uint k = 0u; k < list.y; k++) {
        uint block = candidate_table[list.x + k];
        float distance;
        if (!is_in_cell(block, cell, distance)) continue;
        for (int i = 0; i < 4; i++) {
            if (distance >= distances[i]) continue;
            uint next = blocks[i];
            float of_next = distances[i];
            blocks[i] = block;
            distances[i] = distance;
            block = next;
            distance = of_next;
        }
    }
    imageStore(cell_rows, light_map_at(cell), blocks);
}

void main()
{
    uint i = gl_GlobalInvocationID.x;
    if (i < push.blocks)
        store_block(i);
    else if (i - push.blocks < push.cells)
        store_cell(i - push.blocks);
}
