// From scene radiance to display values: exposure, then the Khronos PBR Neutral tone mapper
// (Khronos 2024, "PBR Neutral Tone Mapper Specification"). The GLSL twin is tonemap.glsl.
#pragma once

#include "image/image.h"

// Factor on radiance in cd/m² for an exposure value at ISO 100: 1 / (1.2 · 2^EV) (ISO 12232,
// saturation based).
float exposure_scale(float ev);
vec3s tonemap_pbr_neutral(vec3s exposed);
// out: display-linear 0…1, same size, 3 channels. in has 3 or 4 channels, cd/m².
bool image_tonemap(struct image *out, struct host *host, const struct image *in, float ev);
