// Light of walls on faces of clutter (Loos 2015, section 5.3.3), as the mean irradiance of each
// face: the coefficients c of the next bounce.
#pragma once

#include "techniques/mrt/clutter/delta.h"

// Irradiance of the faces of a block, of b of a source block.
struct mrt_gathered {
    int source;
    struct matrix_f32 of_b; // faces × k_b
};

struct mrt_gather_faces {
    struct host *host;
    struct mrt_gathered *from; // ascending sources
    int count;
    struct matrix_f32 of_c; // faces × all faces
};

// mrt_gather_faces_finish accepts zero. A face has at least as many rays as a texel.
bool mrt_gather_faces_init(struct mrt_gather_faces *out, struct host *host,
                           const struct mrt_clutter_rays *rays, int block);
void mrt_gather_faces_finish(struct mrt_gather_faces *gather);
