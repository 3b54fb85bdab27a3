// Operators of probes of the dictionary, rotated to the blocks of a level.
#pragma once

#include "core/linalg.h"
#include "core/vec.h"

#include "techniques/mrt/dictionary/shape.h"

// `from` and `out`: 9 rows of SH for each of p³ probes. out(to_from ω) at to_from x = from(ω) at x.
struct mrt_probe_turn {
    const struct mrt_shape *from, *to;
    mat3s to_from;
};
bool mrt_turn_probes(struct host *host, int p, const struct mrt_probe_turn *turn,
                     const struct matrix_f32 *from, struct matrix_f32 *out);
