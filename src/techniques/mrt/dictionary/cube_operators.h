// Gather operators of the closed cube. Rays inside a cube do not change where it has openings, they
// only leave through them: the operators of every cube of the dictionary are rows and columns of
// these.
#pragma once

#include "core/linalg.h"

#include "techniques/mrt/dictionary/rays.h"
#include "techniques/mrt/dictionary/shape.h"

struct mrt_cube_operators {
    // Rows per texel or probe: 1, 4 and 9, by enum mrt_measure. Columns: texels.
    struct matrix_f32 by_measure[3];
};

// The point of row block i of a measure: a texel, or a probe in x, then y, then z of the cell;
// probes of a tube are in left, up and along (tube_inside).
struct mrt_point mrt_gather_point(const struct mrt_shape *shape, int probes,
                                  enum mrt_measure measure, int i);

// The operator of a cube with openings: a contiguous copy.
bool mrt_cube_operator_of(struct host *host, const struct mrt_cube_operators *closed,
                          enum mrt_measure measure, const struct mrt_shape *shape,
                          struct matrix_f64 *out);
