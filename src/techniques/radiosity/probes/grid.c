#include "techniques/radiosity/probes/grid.h"

struct frame_probes radiosity_probe_grid(const struct radiosity_map *map,
                                         const struct radiosity_options *options)
{
    return probe_grid_around(charts_bounds(&map->charts), options->probe_spacing,
                             radiosity_probes_most(options));
}
