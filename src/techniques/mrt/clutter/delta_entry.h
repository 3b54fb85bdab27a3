// Changes of the light that enters a block by an opening, from clutter beyond it: walls that the
// clutter occludes (ΔT_b→r), and its own light (T_c→r).
//
// r-coefficients are those of the irradiance E that the response U_r has at the walls of a closed
// cube: U_r is orthonormal, so r = U_rᵀ E, with E by rays from these walls through the opening.
// Clutter of the block itself is left to the share of rays that it lets pass (delta.h).
#pragma once

#include "core/linalg.h"
#include "trace/trace.h"

#include "techniques/mrt/clutter/delta.h"

struct mrt_delta_source {
    int block;
    bool hidden;         // clutter hides some of its walls
    struct matrix_f32 b; // k_r × k_b: T_b→r, with clutter
    struct matrix_f32 c; // k_r × faces of the block: T_c→r
};

struct mrt_delta_entry {
    struct host *host;
    struct mrt_delta_source *sources; // as input->sources
    int count;
};

struct mrt_delta_entry_input {
    const struct mrt_block_map *map;
    const struct matrix_f32 *const *l_imp; // of each block, in its frame
    int resolution;                        // of walls
    const struct mrt_clutter *clutter;
    const struct trace_scene *objects;
    int rays, depth;              // of a texel, a power of two; openings that a ray passes at most
    int block, face;              // of the opening
    const struct matrix_f32 *u_r; // of its response
    const int *sources;           // blocks that send light to it
    int source_count;
    const atomic_bool *stop; // as of mrt_delta_input
};

// The same bits for any number of threads. mrt_delta_entry_finish accepts zero.
bool mrt_delta_entry_init(struct mrt_delta_entry *out, struct host *host,
                          const struct mrt_delta_entry_input *input);
void mrt_delta_entry_finish(struct mrt_delta_entry *entry);
