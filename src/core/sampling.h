// Warps of the unit square with their densities. Every sample_x has a density pdf_x that integrates to 1
// over its domain (solid angle in sr for directions, area in m² or unit area for surfaces).
#pragma once

#include "core/vec.h"

vec3s sample_sphere(vec2s u);                           // uniform, pdf 1/(4π)
float pdf_sphere(void);
vec3s sample_hemisphere_cosine(vec2s u);                // around +z, pdf cosθ/π
float pdf_hemisphere_cosine(float cos_theta);
vec3s sample_hemisphere_uniform(vec2s u);               // around +z, pdf 1/(2π)
float pdf_hemisphere_uniform(void);
vec3s sample_cone_uniform(vec2s u, float cos_max);      // around +z
float pdf_cone_uniform(float cos_max);
vec2s sample_disk(vec2s u);                             // concentric (Shirley & Chiu 1997), unit disk
vec2s sample_triangle(vec2s u);                         // barycentric b1, b2, uniform by area
