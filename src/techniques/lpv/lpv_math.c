// Faces of neighbour cells, their solid angles in closed form, and the re-projected lobes.
//
// Differs from Martin 2012, eq. 3.3 in the weight: Ω/4π and a lobe of unit peak keep a quarter of
// the flux per step. Here the flux through a face is Φ = Ω I(ω) and the re-projected lobe has the
// flux Φ (clamped cosine: Φ/π (cosθ)₊); since the solid angles sum to 4π, a step conserves flux.
// The width of the lobe is a parameter (docs/notes/lpv.md).
#include "techniques/lpv/lpv_math.h"

#include <math.h>
#include <stdlib.h>

// Rectangle [0,x] × [0,y]: ∫∫ d / (u² + v² + d²)^(3/2) du dv. atan2 is also correct for d → 0.
static double corner_sr(double x, double y, double distance)
{
    return atan2(x * y, distance * sqrt(x * x + y * y + distance * distance));
}

double lpv_rectangle_sr(double x0, double x1, double y0, double y1, double distance)
{
    return corner_sr(x1, y1, distance) - corner_sr(x0, y1, distance) - corner_sr(x1, y0, distance) +
           corner_sr(x0, y0, distance);
}

// Face of the cell at `offset` with the normal ±axis, in cells from the source's centre.
static struct lpv_face face_of(const int offset[3], int axis, int side)
{
    const int b = (axis + 1) % 3, c = (axis + 2) % 3;
    const double distance = fabs((double)offset[axis] + 0.5 * (double)side);
    vec3s centre = vec3_of((float)offset[0], (float)offset[1], (float)offset[2]);
    centre.raw[axis] += 0.5f * (float)side;
    vec3s normal = vec3_of(0, 0, 0);
    normal.raw[axis] = (float)side;
    return (struct lpv_face){
        .direction = glms_vec3_normalize(centre),
        .normal = normal,
        .solid_angle_sr = lpv_rectangle_sr(offset[b] - 0.5, offset[b] + 0.5, offset[c] - 0.5,
                                           offset[c] + 0.5, distance),
    };
}

// Whether a face receives light. Six neighbours: all but the face shared with the source; 26: the
// outer faces of the 3 × 3 × 3 cells.
static bool is_outer(enum lpv_scheme scheme, const int offset[3], int axis, int side)
{
    return scheme == LPV_SIX ? offset[axis] != -side : offset[axis] == side;
}

static struct lpv_neighbour neighbour_of(enum lpv_scheme scheme, const int offset[3])
{
    struct lpv_neighbour out = { .offset = { offset[0], offset[1], offset[2] } };
    for (int axis = 0; axis < 3; axis++)
        for (int side = -1; side <= 1; side += 2)
            if (is_outer(scheme, offset, axis, side))
                out.faces[out.face_count++] = face_of(offset, axis, side);
    return out;
}

int lpv_neighbours(enum lpv_scheme scheme, struct lpv_neighbour out[LPV_MAX_NEIGHBOURS])
{
    int count = 0;
    for (int i = 0; i < 27; i++) {
        const int offset[3] = { i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1 };
        const int steps = abs(offset[0]) + abs(offset[1]) + abs(offset[2]);
        if (steps == 0 || (scheme == LPV_SIX && steps > 1)) continue;
        out[count++] = neighbour_of(scheme, offset);
    }
    return count;
}

// Light of direction (x, y, z) needs |x| + |y| + |z| steps per cell of path with six neighbours,
// max(|x|, |y|, |z|) with 26. Means over the sphere: 3/2 (a step is Cauchy's mean chord of a cube,
// 4 V/S), and 3√2/π atan(1/√2) = 0.831, an integral over one face of a cube times six.
double lpv_mean_path(enum lpv_scheme scheme)
{
    const double root = sqrt(2.0);
    return scheme == LPV_SIX ? 2.0 / 3.0 : GLM_PI / (3.0 * root * atan(1.0 / root));
}

// Over the faces of all neighbours beyond the side +z, of direction cosine c: flux_l = Σ Ω/4π
// (2l + 1) P_l(c), and the sum of 3 c² Ω/4π.
static void sum_of_side(enum lpv_scheme scheme, double flux[3], double *square)
{
    enum { Z = 2 };
    struct lpv_neighbour neighbours[LPV_MAX_NEIGHBOURS];
    const int count = lpv_neighbours(scheme, neighbours);
    flux[0] = flux[1] = flux[2] = *square = 0.0;
    for (int n = 0; n < count; n++)
        for (int f = 0; f < neighbours[n].face_count && neighbours[n].offset[Z] == 1; f++) {
            const struct lpv_face *face = &neighbours[n].faces[f];
            const double c = (double)face->direction.raw[Z];
            const double share = face->solid_angle_sr / (4.0 * GLM_PI);
            flux[0] += share;
            flux[1] += 3.0 * share * c;
            flux[2] += 5.0 * share * (1.5 * c * c - 0.5);
            *square += 3.0 * share * c * c;
        }
}

// A clamped cosine has the bands 1/4, 1/2 and 5/16 (of ∫ I dω, ∫ I c dω, ∫ I P2 dω).
//
// injected_1: above a lit wall all layers hold the same light, φ in band 0 and J in band 1, and
// none returns: flux_0 φ = flux_1 J. A layer receives from the one below flux_0 φ + flux_1 J in
// band 0 and flux_1/3 φ + square J in band 1. A wall that injects the same light loses none of it.
struct lpv_crossing lpv_crossing_of(enum lpv_scheme scheme)
{
    double flux[3], square;
    sum_of_side(scheme, flux, &square);
    return (struct lpv_crossing){
        .band_1 = 0.5 * flux[1] / flux[0],
        .band_2 = 0.8 * flux[2] / flux[0],
        .injected_1 = 0.5 * (flux[1] / (3.0 * flux[0]) + square / flux[1]),
    };
}

// The flux across a side is that of a clamped cosine. A hemisphere of the flux φ above a lit wall
// loses φ/3 upwards, with the moment 2/9 φ, and receives as much from the wall: a clamped cosine.
struct lpv_crossing lpv_closed_crossing(void)
{
    return (struct lpv_crossing){ 1.0, 1.0, 2.0 / 3.0 };
}

// A hemisphere above a lit wall is uniform over 0…1 along the normal: light that crosses the side
// of a cell has the moments of a clamped cosine.
struct lpv_crossing lpv_product_crossing(void)
{
    return (struct lpv_crossing){ 1.0, 1.0, 2.0 / 3.0 };
}

// Quadrature of the squares of x² − y² and xy with the faces as nodes and their solid angles as
// weights: 1 each if it were exact. By the symmetry of the cube these two determine band 2.
static void quadrature_of_band_2(enum lpv_scheme scheme, double *square, double *product)
{
    enum { XY = 4, XX_YY = 8 };
    struct lpv_neighbour neighbours[LPV_MAX_NEIGHBOURS];
    const int count = lpv_neighbours(scheme, neighbours);
    *square = *product = 0.0;
    for (int n = 0; n < count; n++)
        for (int f = 0; f < neighbours[n].face_count; f++) {
            const struct lpv_face *face = &neighbours[n].faces[f];
            float basis[9];
            sh_eval(3, face->direction, basis);
            *square += face->solid_angle_sr * (double)(basis[XX_YY] * basis[XX_YY]);
            *product += face->solid_angle_sr * (double)(basis[XY] * basis[XY]);
        }
}

// Band 2 of the lobe (cosθ)₊ⁿ of mean cosine g = (n+1)/(n+2), relative to band 0, is the mean of
// the Legendre polynomial P2: n/(n+3) = (2g − 1)/(2 − g). n = 1 is the clamped cosine with g = 2/3
// and the paper's 1/4; g = 1 preserves every direction. Lobes wider than a hemisphere have none.
static double band_2_of(double focus)
{
    return fmax(2.0 * focus - 1.0, 0.0) / (2.0 - focus);
}

// Stability: no wave grows. A step maps the coefficients c of the wave exp(i k·x) to G A E B c: B
// the fluxes through the faces over √Ω, E the faces' phases (unitary), A the polynomials at the
// lobes' axes times √Ω, G the weights. B Bᵀ is the quadrature of products of two coefficients:
// exact up to degree 3 by the cube's symmetry, and in band 2 diagonal with the two numbers q of
// quadrature_of_band_2. With D = √q, 1 for the lower bands, B D⁻¹ has the norm 1, and the step
// grows at most by the norm of D G A. For lobes along the directions A = Bᵀ and D G A has the norm
// of q G: weights divided by q give 1, g and the band 2 above, all at most 1, and light of every
// direction is scaled alike. For lobes along the normals, six directions of weight 4π/6, x² − y²
// counts 5/2 times and xy not at all: √(5/2 q) G ≤ 1 bounds the weight.
struct lpv_lobe_weights lpv_lobe_weights_of(enum lpv_scheme scheme, enum lpv_lobe lobe,
                                            double focus, double filter)
{
    const double band_2 = (1.0 - filter) * band_2_of(focus);
    double square, product;
    quadrature_of_band_2(scheme, &square, &product);
    if (lobe == LPV_LOBE_PROPAGATION)
        return (struct lpv_lobe_weights){ focus, band_2 / square, band_2 / product };
    return (struct lpv_lobe_weights){ focus, fmin(band_2, sqrt(0.4 / square)), 0.0 };
}

struct lpv_lobe_weights lpv_product_lobe(double focus)
{
    const double band_2 = band_2_of(focus);
    return (struct lpv_lobe_weights){ focus, band_2, band_2 };
}

static struct lpv_reprojection reprojection_of(struct lpv_face face, int p_axis, int q_axis,
                                               enum lpv_lobe lobe)
{
    const double y0 = sqrt(1.0 / (4.0 * GLM_PI)), y1 = sqrt(3.0 / (4.0 * GLM_PI)),
                 xy = sqrt(15.0 / (4.0 * GLM_PI)), solid_angle = face.solid_angle_sr;
    const double p = (double)face.direction.raw[p_axis], q = (double)face.direction.raw[q_axis];
    const vec3s axis = lobe == LPV_LOBE_NORMAL ? face.normal : face.direction;
    return (struct lpv_reprojection){
        .flux_0 = (float)(solid_angle * y0),
        .flux_p = (float)(solid_angle * y1 * p),
        .flux_q = (float)(solid_angle * y1 * q),
        .flux_pp = (float)(solid_angle * p * p),
        .flux_qq = (float)(solid_angle * q * q),
        .flux_product_pq = (float)(solid_angle * xy * p * q),
        .flux_product_qq = (float)(solid_angle * xy * q * q),
        .lobe_p = axis.raw[p_axis],
        .lobe_q = axis.raw[q_axis],
    };
}

struct lpv_step lpv_step_of(enum lpv_scheme scheme, enum lpv_lobe lobe, double focus, double filter)
{
    enum { X, Y };
    const int ahead[3] = { 1, 0, 0 }, edge[3] = { 1, 1, 0 }, corner[3] = { 1, 1, 1 };
    const struct lpv_face beside = scheme == LPV_SIX ? face_of(ahead, Y, 1) : face_of(edge, X, 1);
    return (struct lpv_step){
        .far_face = reprojection_of(face_of(ahead, X, 1), X, Y, lobe),
        .side_face = reprojection_of(beside, X, Y, lobe),
        .corner_face = reprojection_of(face_of(corner, X, 1), X, Y, lobe),
        .lobe = lpv_lobe_weights_of(scheme, lobe, focus, filter),
    };
}
