// The geometry of propagation: the faces of the neighbour cells as seen from the source cell's
// centre, the lobes that are sent on behind them, and what one step does to the coefficients. Pure
// functions, no state.
//
// Martin 2012, sec. 3.2.3 (eq. 3.3) and 4.2; Kaplanyan & Dachsbacher 2010. Coefficients are in the
// order of core/sh.h.
#pragma once

#include "core/sh.h"
#include "techniques/lpv/lpv_shared.h"

// The option `neighbours`: those that share a face with the source, or also an edge or a corner.
enum lpv_scheme { LPV_SIX, LPV_TWENTY_SIX };
// Where a re-projected lobe points: along the light's way to the face's centre, or along the face's
// normal.
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

// All neighbours of a scheme; returns how many. Their faces bound the neighbours and the source
// together, so that each direction leaves through one face: of six neighbours 30, all but the six
// shared with the source; of 26 neighbours 54.
int lpv_neighbours(enum lpv_scheme scheme, struct lpv_neighbour out[LPV_MAX_NEIGHBOURS]);
// Solid angle in sr of the rectangle [x0,x1] × [y0,y1] in the plane z = distance > 0, seen from the
// origin.
double lpv_rectangle_sr(double x0, double x1, double y0, double y1, double distance);

// The mean way of a step in cells, over all directions: of light that goes straight on.
double lpv_mean_path(enum lpv_scheme scheme);

// What one re-projected lobe of unit flux has: coefficient i is weight_i Y_i(axis). `along` is the
// weight of band 1, that of band 2 is `square` for 3z² − 1 and x² − y² and `product` for xy, yz and
// xz. Band 0 has the weight 1, which is what conserves flux.
struct lpv_lobe_weights {
    double along, square, product;
};
// `focus` is the mean cosine of the lobe, 0…1, and the weight of band 1; see lpv_math.c for band 2.
struct lpv_lobe_weights lpv_lobe_weights_of(enum lpv_scheme scheme, enum lpv_lobe lobe,
                                            double focus);
double lpv_lobe_weight(const struct lpv_lobe_weights *weights, int coefficient);

// What the shaders need of one step: faces that are alike, one of each, and the lobes' weights.
struct lpv_step {
    struct lpv_reprojection far_face, side_face,
        corner_face; // far faces
    struct lpv_lobe_weights lobe;
};
struct lpv_step lpv_step_of(enum lpv_scheme scheme, enum lpv_lobe lobe, double focus);
