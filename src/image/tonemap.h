// From scene radiance to display values: exposure, then a tone curve. The GLSL twin is
// tonemap.glsl.
#pragma once

#include "image/image.h"

// Factor on radiance in cd/m² for an exposure value at ISO 100: 1 / (1.2 · 2^EV) (ISO 12232,
// saturation based).
float exposure_scale(float ev);

enum tonemap_curve { TONEMAP_NEUTRAL, TONEMAP_AGX, TONEMAP_LINEAR, TONEMAP_COUNT };

// Linear display values in 0…1 of an exposed colour; negative values and NaN count as 0.
//
// Keeps hue, and colours below 0.8 but for 0.04 of reflection (Khronos 2024, "PBR Neutral Tone
// Mapper Specification").
vec3s tonemap_pbr_neutral(vec3s exposed);
// 16.5 stops, from 10 below middle grey; bright colours go to white (AgX, by T. Sobotka, in the
// form by E. Chow that Blender 4 has, without its mix of chroma angles).
vec3s tonemap_agx(vec3s exposed);
// LINEAR: values above 1 are cut off.
vec3s tonemap(enum tonemap_curve curve, vec3s exposed);
// out: display-linear 0…1, same size, 3 channels. in has 3 or 4 channels, cd/m².
bool image_tonemap(struct image *out, struct host *host, const struct image *in, float ev,
                   enum tonemap_curve curve);
