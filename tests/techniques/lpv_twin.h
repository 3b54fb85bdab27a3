// Light propagation volumes in plain C, in double precision, step by step as the paper tells it: the light of each step
// is a grid of its own, and goes through the faces one by one.
#pragma once

#include "techniques/lpv/lpv_grid.h"
#include "techniques/lpv/lpv_math.h"

struct twin {
    struct lpv_grid grid;
    double (*light)[4];       // of this step, [z][y][x]
    double (*accumulated)[4]; // of all steps so far, the injected light among it
};

void twin_init(struct twin *twin, struct lpv_grid grid);
void twin_finish(struct twin *twin);
size_t twin_cells(const struct twin *twin);
// A virtual point light of `flux` (lumen); outside the grid it is dropped.
void twin_inject(struct twin *twin, vec3s position, vec3s normal, double flux);
void twin_propagate(struct twin *twin, enum lpv_lobe lobe, float mean_cosine);
double twin_flux(const struct twin *twin); // of this step, lumen
// Irradiance (lux) at a surface point, looked up `offset` cells along its normal, band 1 weighted with `window`.
double twin_irradiance(const struct twin *twin, vec3s position, vec3s normal, float offset, float window);
