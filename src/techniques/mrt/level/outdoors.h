// Light of emitters and the sky at probes outside of all blocks, on a grid over the scene. Surfaces
// that belong to no room take it.
#pragma once

#include "techniques/mrt/level/block_map.h"
#include "techniques/mrt/level/probes.h"

// Values are premultiplied by `open`.
struct mrt_outdoor_probe {
    struct mrt_unbounced_probe light;
    // 0: in a block, in a solid or without a view of the sky; 1: outdoors.
    float open;
};

struct mrt_outdoor_grid {
    vec3s first_m;   // of point (0, 0, 0), world
    float spacing_m; // between neighbouring points, along each axis of the world
    int count[3];
};

struct mrt_outdoors {
    struct host *host;
    struct mrt_outdoor_grid grid;
    struct mrt_outdoor_probe
        *probes; // [count[2]][count[1]][count[0]]; NULL: all places are enclosed
};

struct trace_scene;
bool mrt_outdoors_init(struct host *host, const struct mrt_block_map *map, struct box3 bounds,
                       const struct trace_scene *scene, struct mrt_outdoors *out);
void mrt_outdoors_finish(struct mrt_outdoors *outdoors); // accepts zero
