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
    struct mrt_delta_source *sources; // as of the opening
    int count;
};

// The opening of a block that light enters by, its response, and the blocks that send it.
struct mrt_entered_opening {
    int block, face;
    const struct matrix_f32 *u_r;
    const int *sources;
    int source_count;
};

// mrt_delta_entry_finish accepts zero.
bool mrt_delta_entry_init(struct mrt_delta_entry *out, struct host *host,
                          const struct mrt_clutter_rays *rays,
                          const struct mrt_entered_opening *opening);
void mrt_delta_entry_finish(struct mrt_delta_entry *entry);
