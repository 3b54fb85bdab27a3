// The visible sky at the places of a light map (mirror.glsl): an image of half floats, one layer
// for each side. It has irradiance and vector irradiance under a sky of radiance 1/π, 1 and the
// normal where a place sees all of its hemisphere.
#pragma once

#include "gpu/gpu.h"

struct charts;
struct chart_seams;

// Rows of the places beside seams: [places][CHART_SEAM_ENTRIES] of a bake, checked.
struct light_map_seam_rows {
    const uint32_t *texel;
    const float *weight;
};

// nearest_valid: [side_texel_count] as of charts_fill. sky: [side_texel_count][4] irradiance and
// vector irradiance under a sky of radiance 1.
bool light_map_upload_visible_sky(struct host *host, struct gpu *gpu, const struct charts *charts,
                                  const struct chart_seams *seams,
                                  const struct light_map_seam_rows *rows,
                                  const uint32_t *nearest_valid, const float *sky, gpu_image *out);
