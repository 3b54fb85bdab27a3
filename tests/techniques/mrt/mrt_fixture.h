// Operators and transfer of the cubes of the block dictionary, for tests. Failures end the test.
#pragma once

#include "techniques/mrt/dictionary/cube_operators.h"
#include "techniques/mrt/dictionary/transfer.h"

// Built once per resolution and kept; 16384 rays, 4 probes along an edge.
const struct mrt_cube_operators *mrt_fixture_cube(int resolution);
const struct mrt_rays *mrt_fixture_rays(int resolution, enum mrt_measure measure);
// Direct light of the prior: texels × lights. Finish it.
struct matrix_f64 mrt_fixture_direct(const struct mrt_shape *shape);
// The whole chain for one shape. Finish both.
void mrt_fixture_transfer(const struct mrt_shape *shape, int k_b, bool enrich, struct matrix_f64 *f,
                          struct mrt_transfer *out);
