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

struct mrt_gather_input {
    const struct mrt_block_map *map;
    const struct matrix_f32 *const *l_imp; // of each block, in its frame
    int resolution;                        // of walls
    const struct mrt_clutter *clutter;
    const struct trace_scene *objects;
    int rays;                // of a face, at least
    int depth;               // openings that a ray passes at most
    const atomic_bool *stop; // as of mrt_delta_input
};

// The same bits for any number of threads. mrt_gather_faces_finish accepts zero.
bool mrt_gather_faces_init(struct mrt_gather_faces *out, struct host *host,
                           const struct mrt_gather_input *input, int block);
void mrt_gather_faces_finish(struct mrt_gather_faces *gather);
