// Walls of blocks, as tiles with coordinates (s, t) in [0, 1]²: the faces of a cube that are no
// openings (cube.h), or the one wall of a tube, with s around it and t along. A tube's wall counts
// as face 0.
#pragma once

#include "techniques/mrt/dictionary/shape.h"
#include "techniques/mrt/level/block.h"

static inline bool mrt_block_is_tube(const struct mrt_block *block)
{
    return block->kind != MRT_BLOCK_CUBE;
}

static inline enum tube_bend mrt_block_bend(const struct mrt_block *block)
{
    return (enum tube_bend)((int)block->kind - MRT_BLOCK_STRAIGHT);
}

static inline bool mrt_block_has_wall(const struct mrt_block *block, int face)
{
    return mrt_block_is_tube(block) ? face == 0 : !mrt_block_is_open(block, face);
}

int mrt_block_walls(const struct mrt_block *block);
// The shape of the dictionary in the frame of the block's cell, `resolution` texels along an edge
// of a wall.
struct mrt_shape mrt_block_shape(const struct mrt_block *block, int resolution);

// A point of a wall in the cell, and the derivatives by s and t.
struct mrt_wall_place {
    vec3s position, by_s, by_t;
};
struct mrt_wall_place mrt_wall_place(const struct mrt_block *block, int face, float s, float t);
// The point inside the block from which the wall is seen along its normal: on the middle plane of
// a cube, on the axis of a tube.
vec3s mrt_wall_middle(const struct mrt_block *block, int face, float s, float t);
// The middle of the way through the block, in the scene.
vec3s mrt_block_middle(const struct mrt_block *block);
// Area in the scene by that of [0, 1]² there.
float mrt_wall_area(const struct mrt_block *block, int face, float s, float t);
// Towards the inside, in the scene; unit.
vec3s mrt_wall_normal(const struct mrt_block *block, int face, float s, float t);
// The first axis of the frame of mrt_point, in the scene; unit.
vec3s mrt_wall_across(const struct mrt_block *block, int face, float s, float t);

// Responses to light that enters by an opening are the same for all blocks of a level whose shape
// and opening are equal: for a cube by its face, for a tube by its bend and its end.
static inline int mrt_response_of(const struct mrt_block *block, int face)
{
    return mrt_block_is_tube(block) ? 2 * (int)mrt_block_bend(block) + (face != CUBE_BACK) : face;
}
enum { MRT_RESPONSES = CUBE_FACES };
