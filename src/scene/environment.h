// Light from outside of the scene, which arrives where a ray meets no surface: a uniform sky.
#pragma once

#include "core/sh.h"
#include "core/vec.h"

#include <math.h>

struct environment {
    vec3s sky; // radiance from all directions, cd/m²
};

// From a direction: a unit vector in world space, away from the scene. cd/m².
static inline vec3s environment_radiance(const struct environment *environment, vec3s direction)
{
    (void)direction;
    return environment->sky;
}

// Over all directions, cd/m²: for light that was baked for a uniform sky.
static inline vec3s environment_mean(const struct environment *environment)
{
    return environment->sky;
}

// Coefficients of the radiance by colour, cd/m² (core/sh.h). bands: at most SH_MAX_BANDS.
static inline void environment_sh(const struct environment *environment, int bands,
                                  float out[3][SH_MAX_COUNT])
{
    for (int c = 0; c < 3; c++) {
        for (int i = 1; i < SH_COUNT(bands); i++) out[c][i] = 0.0f;
        out[c][0] = environment->sky.raw[c] * sqrtf(4.0f * GLM_PIf);
    }
}
