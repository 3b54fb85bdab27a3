// Cells of the hemispheres of texels in which further rays are cast: those through which reflectors
// or an edge of the sky are seen, such as a window. Scouts find them: rays that a group of texels
// shares, and whose light does not count. The choice of cells is therefore independent of the rays
// that carry light, and the mean of the light is right.
#pragma once

#include "techniques/mrt/light/reflectors.h"

struct mrt_texel_list {
    struct mrt_geometry_texel *at;
    size_t count;
    int row; // texels along an edge of a square of neighbours, one square after another; 0: none
};

struct mrt_ray_cells {
    struct host *host;
    size_t row, groups; // of the list
    uint32_t side;      // cells along an edge of the unit square (texel_cells); 0: none
    uint32_t most;      // further rays of a texel
    uint8_t *seen;      // [groups][side²], of enum seen
};

// rays: of each texel, a power of two, 16 at least. Without neighbours or reflectors there are no
// cells. false: out of memory.
bool mrt_ray_cells_init(const struct trace_scene *scene, const struct mrt_reflectors *reflectors,
                        const struct mrt_texel_list *texels, int rays, struct mrt_ray_cells *out);
void mrt_ray_cells_finish(struct mrt_ray_cells *cells); // accepts zero

enum { MRT_MOST_CELLS = 256 };
// Further rays of each cell of a texel. Returns their sum, `most` at most.
uint32_t mrt_ray_cells_of(const struct mrt_ray_cells *cells, size_t texel,
                          uint8_t further[MRT_MOST_CELLS]);
