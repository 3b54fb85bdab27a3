// The CIE 1931 standard observer and linear Rec. 709.
#pragma once

#include "core/vec.h"

// Colour-matching functions x̄, ȳ, z̄ at a wavelength, by the multi-lobe fit of Wyman, Sloan &
// Shirley 2013, "Simple Analytic Approximations to the CIE XYZ Color Matching Functions", eq. 4.
vec3s cie_match(float wavelength_nm);
// Linear Rec. 709 of the luminance Y ≥ 0. Colours outside of the gamut are desaturated towards
// white until no component is negative: luminance() of the result is Y.
vec3s cie_rec709_from_xyz(vec3s xyz);
