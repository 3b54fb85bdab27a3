// The grid of probes over the baked part of a scene, a probe in the middle of each cell.
#pragma once

#include "frame/frame_shared.h"
#include "techniques/radiosity/radiosity_map.h"

// Follows from the charts' triangles and the options alone. Without triangles: one probe.
struct frame_probes radiosity_probe_grid(const struct radiosity_map *map,
                                         const struct radiosity_options *options);

// At most so many, about, without probe_spacing.
static inline uint64_t radiosity_probes_most(const struct radiosity_options *options)
{
    enum { TEXELS_PER_PROBE = 32 };
    return (uint64_t)options->texels / TEXELS_PER_PROBE;
}

static inline uint32_t radiosity_probe_count(struct frame_probes grid)
{
    return (uint32_t)grid.count_x * (uint32_t)grid.count_y * (uint32_t)grid.count_z;
}

static inline vec3s radiosity_probe_center(struct frame_probes grid, uint32_t probe)
{
    const uint32_t row = (uint32_t)grid.count_x, layer = row * (uint32_t)grid.count_y;
    const vec3s cell =
        vec3_of((float)(probe % row), (float)(probe % layer / row), (float)(probe / layer));
    return glms_vec3_muladds(cell, grid.spacing_m, grid.first_m);
}
