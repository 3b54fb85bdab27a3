// Texels of a light map: their data in a bake, which is untrusted, and their table (texels.glsl).
#pragma once

#include "techniques/common/light_map/table.h"

struct tensors;

struct light_map_texels {
    const struct charts *charts;
    const float *point;       // [texels][4] position (m), share that is not inside geometry
    const float *reflectance; // [texels][4], the last the mean cosine of shading normals
    const float *sky;         // [texels][4] irradiance and vector irradiance: radiance 1
    // [texels][3][4] the same of emissive surfaces by colour, lux. NULL: emission.h adds it.
    const float *emitted;
    const float *fluence; // [texels] of the sky: radiance 1. NULL: not needed
    // [texels][3] mean shading normals, which receive first-order light. NULL: the surface's
    // normal, times the mean cosine.
    const float *shading;
    const float *roughness; // [texels] of the material; NULL: not needed
};
// Points and sky; the caller finds `reflectance` and `emitted`.
bool light_map_find_texels(struct light_map_texels *out, struct host *host,
                           const struct charts *charts, const struct tensors *bake);
// Area of the part of a texel that is not inside geometry, m².
float light_map_texel_area(const struct light_map_texels *texels, uint32_t texel);
// [texels] nearest valid texel of each (charts_fill): hidden ones have no area. Owned by the
// caller.
uint32_t *light_map_nearest_valid(const struct light_map_texels *texels, struct host *host);
bool light_map_upload_texels(const struct light_map_texels *texels, struct host *host,
                             struct gpu *gpu, gpu_image *out);
// The table of the shares of the environment's patches, of the tensor LIGHT_MAP_SKY_SHARES.
bool light_map_upload_sky(const struct light_map_texels *texels, struct host *host, struct gpu *gpu,
                          const struct tensors *bake, gpu_image *out);
