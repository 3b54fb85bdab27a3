// Light of emitters and the sky at probes outside of all blocks, on a grid over the scene. Surfaces
// that belong to no room take it.
#pragma once

#include "techniques/common/probes/grid.h"
#include "techniques/mrt/level/block_map.h"
#include "techniques/mrt/level/probes.h"

// Values are premultiplied by `open`.
struct mrt_outdoor_probe {
    struct mrt_area_light_probe light;
    // 0: in a block, in a solid or without a view of the sky; 1: outdoors.
    float open;
};

struct mrt_outdoors {
    struct host *host;
    struct frame_probes grid;
    struct mrt_outdoor_probe *probes; // [z][y][x]; NULL: all places are enclosed
};

struct trace_scene;
bool mrt_outdoors_init(struct host *host, const struct mrt_block_map *map, struct box3 bounds,
                       const struct trace_scene *scene, struct mrt_outdoors *out);
void mrt_outdoors_finish(struct mrt_outdoors *outdoors); // accepts zero
