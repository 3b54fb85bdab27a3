// Placement of the grid in the scene, and the powers of two that keep its values in range. Pure
// functions, no state.
#pragma once

#include "core/vec.h"
#include "frame/frame_shared.h"
#include "techniques/lpv/lpv_shared.h"

#include <stdint.h>

// Cubic cells; cell (i, j, k) covers origin_m + cell_m · [i, i+1] × …. Every count is at least 1
// and at most the dimension.
struct lpv_grid {
    vec3s origin_m;
    float cell_m;
    int32_t cells[3];
    uint32_t open; // sides beyond which the scene continues: bits LPV_OPEN(axis, high)
};

// One grid over the bounds with `margin` (in cells) around them. The cell size is a power of
// 2^(1/16) m and the origin a multiple of it, so that the grid does not move when the bounds change
// a little. Larger scenes get larger cells. false: the bounds are empty, a point or not finite.
bool lpv_grid_fit(struct box3 bounds, int dim, float margin, struct lpv_grid *out);

// One of several cascades, with cells of cell_m, or the least that positions tell apart: covers the
// bounds along axes where they need at most `dim` cells, else the part around the camera. Moves by
// two cells at a time, one cell of the next coarser cascade.
void lpv_grid_around(struct box3 bounds, int dim, float margin, float cell_m, vec3s camera,
                     struct lpv_grid *out);
// The part more than `distance` cells before open sides; without bound at the others.
struct box3 lpv_grid_inside(const struct lpv_grid *grid, float distance);
bool lpv_grid_equal(const struct lpv_grid *a, const struct lpv_grid *b);

// Injection sums integers, so that order does not matter. A block of LPV_TEXELS² texels of a
// reflective shadow map, or a point on an emissive surface, adds at most 2^30 to a coefficient;
// sums of 64 bits cannot overflow.

struct lpv_scale {
    float fixed_from_flux; // integer per scaled lumen, a power of two
    // The grid's unit per scaled lumen, a power of two: all light together is less than 8192.
    float grid_from_flux;
};
struct lpv_lights {
    const struct rsm_face *faces;
    int face_count;
    uint32_t rsm_size;
    const struct frame_emitter *emitters;
    int emitter_count;
    vec3s sky_flux; // of a cell that only the sky lights
    int bounces;    // further ones; each adds at most the injected flux
};
// false: there is no light, or its flux is not finite.
bool lpv_scale_of(const struct lpv_lights *lights, struct lpv_scale *out);
