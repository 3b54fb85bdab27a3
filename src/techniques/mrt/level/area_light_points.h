// Direct light of area lights at points, by uniform rays and samples of the emitters.
#pragma once

#include "techniques/mrt/level/probes.h"
#include "trace/texels/light.h"

struct mrt_area_light_points {
    size_t count;
    const vec3s *position;              // world
    struct mrt_area_light_probe *light; // result, 0 before
    bool *solid;                        // result: inside a solid
};

// rays: a power of two. false: out of memory.
bool mrt_area_light_points(struct host *host, const struct trace_scene *scene, int rays,
                           const struct mrt_area_light_points *points);
