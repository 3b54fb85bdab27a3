// Quadrature over the sphere, exact for polynomials up to degree 15: eight Gauss–Legendre nodes in
// z (Abramowitz & Stegun, table 25.4) times sixteen equal steps in φ.
#pragma once

#include <math.h>

enum { QUADRATURE_NODES = 8, QUADRATURE_STEPS = 16, QUADRATURE_POINTS = 128 };

static const double GAUSS_NODES[4] = { 0.183434642495650, 0.525532409916329, 0.796666477413627,
                                       0.960289856497536 };
static const double GAUSS_WEIGHTS[4] = { 0.362683783378362, 0.313706645877887, 0.222381034453374,
                                         0.101228536290376 };

static inline double gauss_node(int i)
{
    return i < 4 ? -GAUSS_NODES[3 - i] : GAUSS_NODES[i - 4];
}

static inline double gauss_weight(int i)
{
    return i < 4 ? GAUSS_WEIGHTS[3 - i] : GAUSS_WEIGHTS[i - 4];
}

// Direction and solid angle of point p, for z in [low, high] ([−1, 1] for the whole sphere).
static inline double quadrature_point(int p, double low, double high, double direction[3])
{
    static const double pi = 3.14159265358979323846;
    int node = p / QUADRATURE_STEPS, step = p % QUADRATURE_STEPS;
    double z = 0.5 * (low + high) + 0.5 * (high - low) * gauss_node(node);
    double phi = 2.0 * pi * step / QUADRATURE_STEPS, r = sqrt(1.0 - z * z);
    direction[0] = r * cos(phi);
    direction[1] = r * sin(phi);
    direction[2] = z;
    return gauss_weight(node) * 0.5 * (high - low) * 2.0 * pi / QUADRATURE_STEPS;
}
