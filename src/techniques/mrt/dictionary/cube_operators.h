// Gather operators of the closed cube. Rays inside a cube do not change where it has openings, they
// only leave through them: the operators of every cube of the dictionary are rows and columns of
// these.
#pragma once

#include "core/linalg.h"

#include "techniques/mrt/dictionary/rays.h"
#include "techniques/mrt/dictionary/shape.h"

struct mrt_cube_operators {
    struct mrt_shape cube;
    int probes;              // along an edge
    struct mrt_rays rays[3]; // by enum mrt_measure
    // Rows per texel or probe: 1, 4 and 9. Columns: texels.
    struct matrix_f32 by_measure[3];
};

bool mrt_cube_operators_init(struct host *host, int resolution, int probes, int rays,
                             struct mrt_cube_operators *out);
void mrt_cube_operators_finish(struct host *host, struct mrt_cube_operators *operators);

// Independent tasks that fill the operators: each writes its own rows.
size_t mrt_cube_operators_tasks(const struct mrt_cube_operators *operators);
void mrt_cube_operators_run(struct mrt_cube_operators *operators, size_t task);

// Centre of probe i, in x, then y, then z.
vec3s mrt_probe_position(int probes, int i);

// The operator of a cube with openings: a contiguous copy.
bool mrt_cube_operator_of(struct host *host, const struct mrt_cube_operators *closed,
                          enum mrt_measure measure, const struct mrt_shape *shape,
                          struct matrix_f64 *out);
