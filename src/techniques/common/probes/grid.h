// Grids of probes in the world: x fastest, then y, then z.
#pragma once

#include "core/host.h"
#include "core/vec.h"
#include "frame/frame_shared.h"

// Cells that cover a box, a probe in the middle of each.
struct frame_probes probe_grid_over(struct box3 box, float spacing_m);
struct frame_probes probe_grid_of_one(void);
// Around surfaces; of an empty or flat box: one probe. spacing_m 0: about `most` probes, at most.
struct frame_probes probe_grid_around(struct box3 box, float spacing_m, uint64_t most);

static inline uint32_t probe_grid_count(struct frame_probes grid)
{
    return (uint32_t)grid.count_x * (uint32_t)grid.count_y * (uint32_t)grid.count_z;
}

static inline vec3s probe_grid_point(struct frame_probes grid, uint32_t probe)
{
    const uint32_t row = (uint32_t)grid.count_x, layer = row * (uint32_t)grid.count_y;
    const vec3s cell =
        vec3_of((float)(probe % row), (float)(probe % layer / row), (float)(probe / layer));
    return glms_vec3_muladds(cell, grid.spacing_m, grid.first_m);
}

// Offset from the grid, in spacings, of a place in the world; w as given, and 0 without an offset.
static inline vec4s probe_offset(struct frame_probes grid, uint32_t probe, vec4s place)
{
    const vec3s way = glms_vec3_sub(vec3_xyz(place), probe_grid_point(grid, probe));
    if (!(place.w > 0.0f)) return vec4_of(vec3_of(0, 0, 0), 0.0f);
    return vec4_of(glms_vec3_divs(way, grid.spacing_m), 1.0f);
}

// For each probe the nearest valid one, in steps along the axes; itself where none is. The caller
// frees it. place: w is 0 where a probe is not valid.
uint32_t *probe_owners(struct host *host, struct frame_probes grid, const vec4s *place);
