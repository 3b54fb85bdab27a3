// The closure of lpv_product.glsl in plain C and double precision. Coefficients are in the order of
// core/sh.h.
#pragma once

#include "core/vec.h"

struct lpv_lobe_weights;

// Adds the light that a step moves by `offset`, which may be 0.
void product_send(const double light[9], const int offset[3],
                  const struct lpv_lobe_weights *weights, double transmittance, double to[9]);
// ∫ I (−n·ω)₊ dω.
double product_irradiance(const double light[9], vec3s normal);
