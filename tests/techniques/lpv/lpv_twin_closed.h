// The positive closure of lpv_closure.glsl in plain C and double precision: hemispheres, isotropic
// light and beams, each with its own moments. Coefficients are in the order of core/sh.h.
#pragma once

#include "core/vec.h"

// Adds the light that a step sends across the side towards `offset`.
void closed_send(const double light[9], const int offset[3], double focus, double transmittance,
                 double to[9]);
// ∫ I (−n·ω)₊ dω for six neighbours, as of a step's flux across a side.
double closed_irradiance(const double light[9], vec3s normal);
