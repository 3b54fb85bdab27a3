// The geometry of propagation: faces of the neighbour cells seen from the source cell's centre, the
// re-projected lobes, and the coefficients of one step. Pure functions, no state.
//
// Martin 2012, sec. 3.2.3 (eq. 3.3) and 4.2; Kaplanyan & Dachsbacher 2010. Coefficients are in the
// order of core/sh.h.
#pragma once

#include "core/sh.h"
#include "techniques/lpv/lpv_shared.h"

// The option `neighbours`: cells that share a face with the source, or also an edge or a corner.
enum lpv_scheme { LPV_SIX, LPV_TWENTY_SIX };
// Axis of a re-projected lobe: the direction to the face's centre, or the face's normal.
enum lpv_lobe { LPV_LOBE_PROPAGATION, LPV_LOBE_NORMAL };

#define LPV_MAX_NEIGHBOURS 26
#define LPV_MAX_FACES      5 // of a neighbour

struct lpv_face {
    vec3s direction; // unit, from the source cell's centre to the face's centre
    vec3s normal;    // unit, out of the neighbour cell
    double solid_angle_sr;
};
struct lpv_neighbour {
    int offset[3]; // from the source, cells
    int face_count;
    struct lpv_face faces[LPV_MAX_FACES];
};

// All neighbours of a scheme; returns their number. Their faces bound the union of neighbours and
// source, so that each direction leaves through one face: 30 faces of six neighbours (the six
// shared with the source are omitted), 54 of 26 neighbours.
int lpv_neighbours(enum lpv_scheme scheme, struct lpv_neighbour out[LPV_MAX_NEIGHBOURS]);
// Solid angle in sr of the rectangle [x0,x1] × [y0,y1] in the plane z = distance > 0, seen from the
// origin.
double lpv_rectangle_sr(double x0, double x1, double y0, double y1, double distance);

// Mean path of light in a step, over all directions, in cells; light travels in straight lines.
double lpv_mean_path(enum lpv_scheme scheme);

// The light that a step sends across one side of a cell, by bands around the side's normal.
struct lpv_crossing {
    double band_1, band_2; // of the flux; 1 each: a clamped cosine
    double injected_1; // band 1 of the light that a lit wall sends across the side; 2/3: Lambert
};
struct lpv_crossing lpv_crossing_of(enum lpv_scheme scheme);
struct lpv_crossing lpv_closed_crossing(void);  // of lpv_closure.glsl
struct lpv_crossing lpv_product_crossing(void); // of lpv_product.glsl

// A re-projected lobe of unit flux: coefficient i is weight_i Y_i(axis). `along`: weight of band 1;
// band 2: `square` for 3z² − 1 and x² − y², `product` for xy, yz and xz. Band 0 has the weight 1,
// which conserves flux.
struct lpv_lobe_weights {
    double along, square, product;
};
// `focus`: mean cosine of the lobe, 0…1, which is the weight of band 1; band 2 in lpv_math.c.
// `filter`: share of band 2 that is removed (filtered spherical harmonics, McClarren & Hauck 2010).
struct lpv_lobe_weights lpv_lobe_weights_of(enum lpv_scheme scheme, enum lpv_lobe lobe,
                                            double focus, double filter);
// Weights for the moments after a step of lpv_product.glsl.
struct lpv_lobe_weights lpv_product_lobe(double focus);

// Shader parameters of one step: one face of each class, and the lobes' weights.
struct lpv_step {
    struct lpv_reprojection far_face;
    struct lpv_reprojection side_face;   // six neighbours: side faces; 26: faces next to an edge
    struct lpv_reprojection corner_face; // 26 neighbours: faces at a corner
    struct lpv_lobe_weights lobe;
};
struct lpv_step lpv_step_of(enum lpv_scheme scheme, enum lpv_lobe lobe, double focus,
                            double filter);
