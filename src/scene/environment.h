// Light from outside of the scene, which arrives where a ray meets no surface: a uniform sky and an
// image of all directions (environment_map.h), which may turn about the vertical.
#pragma once

#include "core/sh.h"
#include "core/vec.h"

struct environment_map;
struct world_light;

struct environment {
    vec3s sky;                         // uniform radiance, cd/m²
    const struct environment_map *map; // its light is added to the sky's; NULL: none
    float strength;                    // factor of the map's radiance
    float rotation_rad;                // of the map about +y, counterclockwise from above
};

vec3s environment_map_light(const struct environment *environment, vec3s direction);

// From a direction: a unit vector in world space, away from the scene. cd/m².
static inline vec3s environment_radiance(const struct environment *environment, vec3s direction)
{
    if (!environment->map) return environment->sky;
    return glms_vec3_add(environment->sky, environment_map_light(environment, direction));
}

// Mean over all directions, cd/m².
vec3s environment_mean(const struct environment *environment);
bool environment_is_black(const struct environment *environment); // its sun apart

// Hash of the light from all directions.
uint64_t environment_key(const struct environment *environment);

// The same without the uniform sky; 0: there is no map.
uint64_t environment_map_use_key(const struct environment *environment);

// Coefficients of the radiance by colour, cd/m² (core/sh.h). bands: at most SH_MAX_BANDS.
void environment_sh(const struct environment *environment, int bands, float out[3][SH_MAX_COUNT]);

// Patches of the sphere: squares of an octahedral map about +y, in world space. Light that was
// baked by patch keeps its visibility under any environment.
enum { ENVIRONMENT_PATCH_SIDE = 8, ENVIRONMENT_PATCHES = 64 };
int environment_patch_of(vec3s direction); // of any length but 0
// Mean radiance of each patch, cd/m².
void environment_patches(const struct environment *environment, vec3s out[ENVIRONMENT_PATCHES]);

// The sun that was found in the map. False: there is none.
bool environment_sun_light(const struct environment *environment, struct world_light *out);

// From world space to the map's.
static inline vec3s environment_map_direction(const struct environment *environment, vec3s d)
{
    const float c = cosf(environment->rotation_rad), s = sinf(environment->rotation_rad);
    return vec3_of(c * d.x - s * d.z, d.y, s * d.x + c * d.z);
}
static inline vec3s environment_world_direction(const struct environment *environment, vec3s d)
{
    const float c = cosf(environment->rotation_rad), s = sinf(environment->rotation_rad);
    return vec3_of(c * d.x + s * d.z, d.y, c * d.z - s * d.x);
}
