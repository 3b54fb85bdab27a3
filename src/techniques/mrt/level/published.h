// The probes of a published volume: a grid over all blocks. Each is moved out of solids, and has
// the depths by which lookups leave out those behind walls.
#pragma once

#include "scene/pose.h"

#include "techniques/common/probes/grid.h"
#include "techniques/common/probes/rays.h"
#include "techniques/mrt/level/block_map.h"

struct mrt_published {
    struct host *host;
    struct frame_probes grid;
    vec4s *place;                       // [probes] offset from the grid, in spacings; 1: valid
    uint16_t (*depth)[PROBE_DEPTHS][2]; // [probes]
};

// p: probes along an edge of a block. Dynamic instances are no walls.
bool mrt_published_init(struct mrt_published *out, struct host *host, const struct scene_pose *pose,
                        const struct mrt_block_map *map, int p);
void mrt_published_finish(struct mrt_published *published); // accepts zero
