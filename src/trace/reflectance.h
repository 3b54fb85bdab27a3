// Reflectance of a surface for light that bounces, of all incident directions alike.
#pragma once

#include "trace/surface.h"

// The share of diffuse light that the surface's diffuse base and its specular lobes send on, 0…1
// per channel: brdf_bounce_reflectance (frame/brdf.glsl). 0 where unlit.
vec3s surface_reflectance(const struct surface *surface);
// The same of a material that is lit.
vec3s bsdf_reflectance(const struct bsdf_material *material);
