// The geometry volume in plain C, in double precision: surfels put to corners one by one and lines
// held against every triangle.
#pragma once

#include "techniques/lpv/lpv_grid.h"

struct geometry_twin {
    struct lpv_grid grid;
    int kind; // LPV_GEOMETRY_MAPS or LPV_GEOMETRY_SCENE
    // [z][y][x], cells[axis] + 1 of them each way: of the corner there coefficients, or of the
    // faces that begin there and are towards −x, −y, −z of the cell there the covered shares.
    double (*volume)[4];
    double (*source)[4];    // maps: of the source being added
    unsigned char *crossed; // scene: [corner][axis][line]
};

void geometry_twin_init(struct geometry_twin *twin, struct lpv_grid grid, int kind);
void geometry_twin_finish(struct geometry_twin *twin);
// A surfel of the current source: `across` is the area (m²) of its texel at its place, seen along
// `to_eye`.
void geometry_twin_surfel(struct geometry_twin *twin, vec3s position, vec3s normal, vec3s to_eye,
                          double across);
// Takes the source into the volume.
void geometry_twin_merge(struct geometry_twin *twin);
void geometry_twin_triangle(struct geometry_twin *twin, const vec3s corners[3]); // world space
const double *geometry_twin_at(const struct geometry_twin *twin, int x, int y,
                               int z); // of the volume
// The share of the light from a cell that reaches the neighbour at `offset`.
double geometry_twin_passing(const struct geometry_twin *twin, const int cell[3],
                             const int offset[3], double occlusion);
