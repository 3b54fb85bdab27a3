// Volumetric obscurance and ambient occlusion at a surface point by rays: the reference of the
// screen-space visibility techniques.
#pragma once

#include "trace/surface.h"

struct obscurance_settings {
    const struct trace_scene *scene;
    float radius_m;    // of the sphere; > 0
    bool sphere;       // full sphere, else the hemisphere above the shading normal
    float decay_per_m; // an occluder at the distance r has the opacity 1/(1 + decay · r)
    uint32_t seed;
};

struct obscurance_sums {
    double volume, ambient;
    int samples;
};

// Adds samples at a surface until there are `samples`. The sums do not depend on how samples are
// split over calls.
void obscurance_add(const struct obscurance_settings *settings, const struct surface *surface,
                    uint32_t pixel, int samples, struct obscurance_sums *sums);
