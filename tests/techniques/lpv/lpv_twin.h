// Light propagation volumes in plain C and double precision, as in the paper: one grid per
// propagation step, one loop iteration per face. Two or three bands, six or 26 neighbours.
#pragma once

#include "techniques/lpv/lpv_grid.h"
#include "techniques/lpv/lpv_math.h"
#include "techniques/lpv/lpv_state.h"

struct geometry_twin;

// Weight of one of nine coefficients.
double lpv_lobe_weight(const struct lpv_lobe_weights *weights, int coefficient);

struct twin {
    struct lpv_grid grid;
    int bands;
    enum lpv_scheme scheme;
    double (*light)[9];                   // of this step, [z][y][x]
    double (*accumulated)[9];             // of all steps so far, including the injected light
    double injected_1;                    // band 1 of injected light: that of struct lpv_crossing
    const struct geometry_twin *geometry; // occluders; NULL: none
    double occlusion;                     // the option
    uint32_t closure;                     // LPV_…_CLOSURE
    struct lpv_lobe_weights closed_lobe;  // of a step of it
};

void twin_init(struct twin *twin, struct lpv_grid grid, int bands, enum lpv_scheme scheme);
// The scheme of the options of a rendered frame; the positive closure takes the frame's focus.
void twin_init_as(struct twin *twin, const struct lpv *lpv);
void twin_finish(struct twin *twin);
size_t twin_cells(const struct twin *twin);
// A virtual point light of `flux` (lumen); outside the grid it is dropped.
void twin_inject(struct twin *twin, vec3s position, vec3s normal, double flux);
// A step, with the options lobe, focus, filter.
void twin_propagate(struct twin *twin, const struct lpv_options *how);
// Steps from the injected light to the accumulated light.
void twin_accumulate(struct twin *twin, const struct lpv_options *how);
double twin_flux(const struct twin *twin); // of this step, lumen
// Irradiance (lux) at a surface point, with the options offset, window, damping, reconstruction.
double twin_irradiance(const struct twin *twin, vec3s position, vec3s normal,
                       const struct lpv_options *how);
