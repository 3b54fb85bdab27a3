// The geometry of propagation: the faces of a neighbour cell as seen from the source cell's centre, and what one step
// does to the coefficients. Pure functions, no state.
//
// Martin 2012, sec. 3.2.3 (eq. 3.3); Kaplanyan & Dachsbacher 2010. Two bands, order Y00, y, z, x (core/sh.h).
#pragma once

#include "core/vec.h"

#define LPV_DIRECTIONS 6 // +x −x +y −y +z −z
#define LPV_FACES 5      // of a neighbour: all but the one shared with the source

// Where a re-projected lobe points: along the light's way to the face's centre, or along the face's normal.
enum lpv_lobe { LPV_LOBE_PROPAGATION, LPV_LOBE_NORMAL };

struct lpv_face {
    vec3s direction; // unit, from the source cell's centre to the face's centre
    vec3s normal;    // unit, out of the neighbour cell
    double solid_angle_sr;
};

vec3s lpv_direction(int direction); // unit, from the source to the neighbour
// The five faces of the neighbour in `direction`, the far face first.
void lpv_faces(int direction, struct lpv_face out[LPV_FACES]);
// Solid angle in sr of the rectangle [x0,x1] × [y0,y1] in the plane z = distance > 0, seen from the origin.
double lpv_rectangle_sr(double x0, double x1, double y0, double y1, double distance);

// Coefficients (unit flux) of the lobe Φ/4π (1 + 3 g cosθ) around `axis`, g its mean cosine. g = 2/3 is the two-band
// projection of the clamped cosine, Φ/π (cosθ)₊.
void lpv_lobe_coefficients(vec3s axis, float mean_cosine, float out[4]);

// One step into one neighbour, Σ_f lobe_f Ω_f Y(ω_f)ᵀ, is a 4 × 4 matrix. The cube's symmetry leaves five numbers: for
// light that moves along the axis a with sign s = ±1 (c0: band 0, ca: along a, cp: across a)
//     c0' = keep c0 + s drive ca,   ca' = s aim c0 + along ca,   cp' = across cp.
struct lpv_step {
    float keep, drive, aim, along, across;
};
struct lpv_step lpv_step_of(enum lpv_lobe lobe, float mean_cosine);
// The whole matrix by the sum over faces, row-major; what lpv_step_of condenses.
void lpv_step_matrix(int direction, enum lpv_lobe lobe, float mean_cosine, double out[4][4]);
