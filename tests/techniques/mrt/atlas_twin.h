// The light map of a level in plain C.
#pragma once

#include "techniques/mrt/level/atlas.h"

// Fills an atlas (width × height × channels) from values at the texels of the level.
void mrt_atlas_fill(const struct mrt_atlas *atlas, const float *values, int channels, float *out);
// Coordinates in the atlas, in texels (centres at ½), of a point of a wall.
vec2s mrt_atlas_place(const struct mrt_atlas *atlas, int tile, float s, float t);
// Bilinear lookup in one channel at such coordinates.
float mrt_atlas_look_up(const struct mrt_atlas *atlas, const float *filled, int channels,
                        int channel, vec2s place);
