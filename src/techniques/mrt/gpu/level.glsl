// The level's uniform block and tables of texels, tiles and blocks. A shader defines the binding
// number of each table that it reads. With MRT_LEVEL_COPIED, `level` is a copy that main begins
// with: level = level_block (as FRAME_CONSTANTS_COPIED).
#ifndef AG_MRT_LEVEL_GLSL
#define AG_MRT_LEVEL_GLSL

#include "techniques/mrt/mrt_shared.h"

#ifdef MRT_LEVEL_COPIED
layout(set = 0, binding = 1, scalar) uniform mrt_level
{
    mrt_level_params level_block;
};
mrt_level_params level;
#else
layout(set = 0, binding = 1, scalar) uniform mrt_level
{
    mrt_level_params level;
};
#endif

#ifdef MRT_TEXELS_BINDING
layout(set = 0, binding = MRT_TEXELS_BINDING, scalar) readonly buffer mrt_texels
{
    mrt_texel texel_table[];
};
#endif

#ifdef MRT_TILES_BINDING
layout(set = 0, binding = MRT_TILES_BINDING, scalar) readonly buffer mrt_tiles
{
    mrt_gpu_tile tile_table[];
};
#endif

#ifdef MRT_BLOCKS_BINDING
layout(set = 0, binding = MRT_BLOCKS_BINDING, scalar) readonly buffer mrt_blocks
{
    mrt_gpu_block block_table[];
};

// Edges of an affine block in world space, a column for each axis.
mat3 edges_of_block(uint block)
{
    mat3 edges;
    for (int a = 0; a < 3; a++)
        edges[a] = block_table[block].corner[1 << a] - block_table[block].corner[0];
    return edges;
}
#endif

#ifdef MRT_OPENINGS_BINDING
layout(set = 0, binding = MRT_OPENINGS_BINDING, scalar) readonly buffer mrt_openings
{
    mrt_gpu_opening opening_table[];
};
#endif

#endif
