// Dictionaries for tests of levels, without the cost of a bake. Failures end the test. Free them
// with mrt_dictionary_finish.
#pragma once

#include "techniques/mrt/dictionary/dictionary.h"

// Random matrices of these sizes: for algebra and times.
struct mrt_dictionary mrt_random_operators(enum mrt_maze maze, int resolution, int k_b, int k_rlf,
                                           int k_r, uint32_t seed);
// A coarse dictionary without reduction: b is the radiosity at the texels, lightfield coefficients
// are its samples, r is the irradiance. U_b is 0.
struct mrt_dictionary mrt_unreduced_operators(void);
