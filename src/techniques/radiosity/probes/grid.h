// The grid of probes over the baked part of a scene, a probe in the middle of each cell.
#pragma once

#include "techniques/common/probes/grid.h"
#include "techniques/radiosity/radiosity_map.h"

// Follows from the charts' triangles and the options alone. Without triangles: one probe.
struct frame_probes radiosity_probe_grid(const struct radiosity_map *map,
                                         const struct radiosity_options *options);

// Approximate maximum of probes without probe_spacing.
static inline uint64_t radiosity_probes_most(const struct radiosity_options *options)
{
    enum { TEXELS_PER_PROBE = 32 };
    return (uint64_t)options->texels / TEXELS_PER_PROBE;
}
