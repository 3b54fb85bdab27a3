// Light from outside of the scene, which arrives where a ray meets no surface: a uniform sky.
#pragma once

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

// Coefficients of the radiance (core/sh.h).
static inline void environment_sh9(const struct environment *environment, vec3s coefficients[9])
{
    for (int i = 1; i < 9; i++) coefficients[i] = vec3_of(0, 0, 0);
    coefficients[0] = glms_vec3_scale(environment->sky, sqrtf(4.0f * GLM_PIf));
}
