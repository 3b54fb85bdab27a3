// Light of emitters and the sky at points, by uniform rays and samples of the emitters.
#pragma once

#include "techniques/mrt/level/probes.h"
#include "trace/texels/light.h"

struct mrt_unbounced_points {
    size_t count;
    const vec3s *position;             // world
    struct mrt_unbounced_probe *light; // result, 0 before
    bool *solid;                       // result: inside a solid
};

// rays: a power of two. false: out of memory.
bool mrt_unbounced_points(struct host *host, const struct trace_scene *scene, int rays,
                          const struct mrt_unbounced_points *points);
