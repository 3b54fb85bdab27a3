// How much of an opening the texels of a block see: light that enters a block is that of a cube's
// operators, and is scaled to the block's proportions.
#pragma once

#include "techniques/mrt/dictionary/shape.h"

// For each texel of a closed cube, the form factor of a face in the block over that in the cube;
// 1 on the face itself.
void mrt_opening_ratios(const struct mrt_shape *closed, mat3s block_from_cell, int face,
                        float *ratios);
