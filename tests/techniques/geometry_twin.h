// The geometry volume in plain C and double precision: each surfel is accumulated at each corner,
// each coverage line intersected with each triangle.
#pragma once

#include "techniques/lpv/lpv_grid.h"

struct geometry_twin {
    struct lpv_grid grid;
    int kind; // LPV_GEOMETRY_MAPS or LPV_GEOMETRY_SCENE
    // [z][y][x], cells[axis] + 1 along each axis. Maps: coefficients of the corner; scene: covered
    // fractions of the cell's low faces (−x, −y, −z).
    double (*volume)[4];
    double (*source)[4];    // maps: of the source being added
    unsigned char *covered; // scene: [corner][axis][line]
};

void geometry_twin_init(struct geometry_twin *twin, struct lpv_grid grid, int kind);
void geometry_twin_finish(struct geometry_twin *twin);
// A surfel of the current source; `across`: perpendicular area (m²) of its texel at its distance.
void geometry_twin_surfel(struct geometry_twin *twin, vec3s position, vec3s normal, vec3s to_viewer,
                          double across);
// Merges the source into the volume.
void geometry_twin_merge(struct geometry_twin *twin);
void geometry_twin_triangle(struct geometry_twin *twin, const vec3s corners[3]); // world space
// Texel of the volume.
const double *geometry_twin_at(const struct geometry_twin *twin, int x, int y, int z);
// Fraction of the light of a cell that reaches the neighbour at `offset`.
double geometry_twin_transmittance(const struct geometry_twin *twin, const int cell[3],
                                   const int offset[3], double occlusion);
