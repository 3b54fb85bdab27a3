// Which places of a surface see each other past its triangles.
#pragma once

#include "scene/charts/surface.h"

struct sight_box;

// A hierarchy of boxes over the triangles.
struct sight {
    struct host *host;
    const struct surface *surface;
    uint32_t *order;         // [surface->count] along a space-filling curve
    struct sight_box *boxes; // children of box n: 2 n + 1 and 2 n + 2
    uint32_t levels;
};

struct sight_place {
    vec3s position, normal;
};

// sight_finish accepts zero.
bool sight_init(struct sight *out, struct host *host, const struct surface *surface);
void sight_finish(struct sight *sight);
// Places are compared a little above the surface, so that a curved one does not hide its own.
bool sight_is_free(const struct sight *sight, const struct sight_place *a,
                   const struct sight_place *b);
