// Holes in the wall between two blocks, such as doors, found by rays through it.
#pragma once

#include "techniques/mrt/level/block.h"

// From this share of a face on, it is an opening; below it, it is a wall with holes. With less of
// it, holes are cracks.
#define MRT_LEAST_OPENING 0.5f
#define MRT_LEAST_HOLE    0.05f

// Whether a surface is between `from` and `from + way`, in the scene.
typedef bool (*mrt_is_blocked)(const void *scene, vec3s from, vec3s way);

// The shares of a cube's face that surfaces near to it leave open. Returns their mean.
float mrt_find_holes(const struct mrt_block *block, int face, mrt_is_blocked is_blocked,
                     const void *scene, struct mrt_holes *out);
