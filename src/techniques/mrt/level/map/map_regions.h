// Enclosed regions of a scene: points under a roof and between walls, such as rooms, however small
// they are in it.
#pragma once

#include "scene/view/raycast.h"

struct mrt_region {
    struct box3 bounds; // to the walls that its points see
    size_t first, count;
};

struct mrt_regions {
    struct host *host;
    vec3s *points; // of the first region, then of the second one, …
    struct mrt_region *regions;
    int count;
};

// On a grid of some 65000 points over the bounds. false: out of memory.
bool mrt_regions_find(struct host *host, const struct raycast *raycast, struct box3 bounds,
                      struct mrt_regions *out);
void mrt_regions_finish(struct mrt_regions *regions); // accepts zero
