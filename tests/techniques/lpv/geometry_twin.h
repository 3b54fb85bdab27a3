// The geometry volume in plain C and double precision: each surfel is accumulated at each corner,
// each coverage line intersected with each triangle.
#pragma once

#include "techniques/lpv/lpv_grid.h"

struct geometry_twin {
    struct lpv_grid grid;
    int kind; // LPV_GEOMETRY_MAPS or LPV_GEOMETRY_SCENE
    // [z][y][x], cells[axis] + 1 along each axis.
    double (*volume)[4];    // maps: coefficients of the corner
    double (*source)[4];    // maps: of the source being added
    unsigned char *covered; // scene: [cell][axis][line] of the low faces
    unsigned char *places;  // scene: [cell][axis][LPV_PLACES] of surfaces between two centres
};

void geometry_twin_init(struct geometry_twin *twin, struct lpv_grid grid, int kind);
void geometry_twin_finish(struct geometry_twin *twin);
// A surfel of the current source; `across`: perpendicular area (m²) of its texel at its distance.
void geometry_twin_surfel(struct geometry_twin *twin, vec3s position, vec3s normal, vec3s to_viewer,
                          double across);
// Merges the source into the volume.
void geometry_twin_merge(struct geometry_twin *twin);
void geometry_twin_triangle(struct geometry_twin *twin, const vec3s corners[3]); // world space
// Maps: texel of the volume.
const double *geometry_twin_at(const struct geometry_twin *twin, int x, int y, int z);
// Scene: occluded share of the light of a cell that moves to the next one on the side ±1.
double geometry_twin_occluded(const struct geometry_twin *twin, const int cell[3], int axis,
                              int side);
// Fraction of the light of a cell that reaches the neighbour at `offset`.
double geometry_twin_transmittance(const struct geometry_twin *twin, const int cell[3],
                                   const int offset[3], double occlusion);
