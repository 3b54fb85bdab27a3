// Stages of the bake that tubes have in place of those of cubes.
#pragma once

#include "techniques/mrt/dictionary/bake_stages.h"

// The whole F, from its rows for the representatives (tube_symmetry.h). The caller finishes it.
bool mrt_tube_operator(const struct bake_task *task, int shape, struct matrix_f64 *out);
// U_vec and U_bvol.
bool mrt_tube_directions(struct bake_plan *plan, const struct mrt_bake_job *job, int shape);
// The right bend from the left one: two stages, before and after that of directions.
bool mrt_tube_mirror_modes(struct bake_plan *plan, const struct mrt_bake_job *job);
bool mrt_tube_mirror_directions(struct bake_plan *plan, const struct mrt_bake_job *job);
