// How much of a sphere's volume round a surface is open, and how much of the sky above it: what the
// techniques that look into the depth buffer estimate, by rays.
#pragma once

#include "trace/surface.h"

struct obscurance_rules {
    const struct trace_scene *scene;
    float radius_m;    // of the sphere; > 0
    bool sphere;       // the whole sphere, else the hemisphere above the shading normal
    float decay_per_m; // what is met at the distance r hides 1/(1 + decay · r) of the sky behind it
    uint32_t seed;
};

struct obscurance_sums {
    double volume, ambient;
    int samples;
};

// Adds samples up to `samples` of them at pixel `pixel`, a surface: the same arguments give the
// same sums, however they are spread over calls.
void obscurance_add(const struct obscurance_rules *rules, const struct surface *surface,
                    uint32_t pixel, int samples, struct obscurance_sums *sums);
