// A filter of light by paths, where Open Image Denoise is absent.
//
// Each texel becomes a mean of texels of its chart's side, weighted by distance, normal, distance
// from its plane, and by how far their light differs beyond its noise (non-local means, Buades,
// Coll & Morel 2005, on patches of 3 × 3 texels; with the variance of the paths, as in Rousselle,
// Knaus & Zwicker 2012): the filter vanishes with the noise. Direct light of punctual lights has no
// noise and is not filtered.
#pragma once

#include "lightmap/lightmap.h"

// light, out: [side_texel_count][LIGHTMAP_COLUMNS], a LIGHTMAP_REST. Texels without open points,
// and the last columns, are copied. False without memory.
bool lightmap_filter(const struct charts *charts, const float *light, float *out);
