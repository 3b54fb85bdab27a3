// The scale of a frame's radiometric images.
#pragma once

#include "scene/pose.h"

struct scale_input {
    const struct world_light *lights;
    int light_count;
    vec3s sky;          // cd/m²
    float max_emissive; // cd/m²
    vec3s emitted_flux; // of all emissive surfaces, lumen
    struct box3 bounds; // of the scene
};

// A power of two. Twice as much of everything halves it exactly; no light at all gives 1.
float frame_scale(const struct scale_input *in);
// What exposure meters where no surface in sight is lit, cd/m²: see docs/units.md. 0 without light.
float frame_unlit_luminance(const struct scale_input *in);
