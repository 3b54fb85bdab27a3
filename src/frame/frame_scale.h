// The scale of a frame's radiometric images.
#pragma once

#include "scene/pose.h"

struct scale_input {
    const struct world_light *lights;
    int light_count;
    vec3s sky;          // mean of the environment, cd/m²
    float max_emissive; // cd/m²
    vec3s emitted_flux; // of all emissive surfaces, lumen
    float painted;      // largest painted irradiance, lux
    struct box3 bounds; // of the scene
};

// A power of two; twice the light halves it exactly. 1 without light.
float frame_scale(const struct scale_input *in);
// Metered luminance if no visible surface is lit, cd/m² (docs/units.md). 0 without light.
float frame_fallback_luminance(const struct scale_input *in);
