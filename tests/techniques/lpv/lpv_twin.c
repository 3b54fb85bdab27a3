#include "techniques/lpv/lpv_twin.h"

#include "core/sh.h"
#include "techniques/lpv/geometry_twin.h"
#include "techniques/lpv/lpv_twin_closed.h"
#include "techniques/lpv/lpv_twin_product.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

size_t twin_cells(const struct twin *twin)
{
    return (size_t)twin->grid.cells[0] * (size_t)twin->grid.cells[1] * (size_t)twin->grid.cells[2];
}

void twin_init(struct twin *twin, struct lpv_grid grid, int bands, enum lpv_scheme scheme)
{
    twin->grid = grid;
    twin->bands = bands;
    twin->scheme = scheme;
    twin->geometry = NULL;
    twin->closure = LPV_NO_CLOSURE;
    twin->injected_1 = lpv_crossing_of(scheme).injected_1;
    twin->light = calloc(twin_cells(twin), sizeof *twin->light);
    twin->accumulated = calloc(twin_cells(twin), sizeof *twin->accumulated);
}

void twin_init_as(struct twin *twin, const struct lpv *lpv)
{
    twin_init(twin, lpv->cascades[0].grid, lpv->options.bands,
              (enum lpv_scheme)lpv->options.neighbours);
    const struct lpv_params *params = &lpv->cascades[0].params;
    twin->closure = lpv_closure_of(&lpv->options);
    twin->closed_lobe =
        (struct lpv_lobe_weights){ (double)params->lobe_along, (double)params->lobe_square,
                                   (double)params->lobe_product };
    if (twin->closure == LPV_BEAM_CLOSURE) twin->injected_1 = lpv_closed_crossing().injected_1;
    if (twin->closure == LPV_PRODUCT_CLOSURE) twin->injected_1 = lpv_product_crossing().injected_1;
}

void twin_finish(struct twin *twin)
{
    free(twin->light);
    free(twin->accumulated);
}

// −1 outside.
double lpv_lobe_weight(const struct lpv_lobe_weights *weights, int coefficient)
{
    if (coefficient == 0) return 1.0;
    if (coefficient < 4) return weights->along;
    return coefficient == 6 || coefficient == 8 ? weights->square : weights->product;
}

static int index_of(const struct twin *twin, const int cell[3])
{
    const int32_t *cells = twin->grid.cells;
    for (int axis = 0; axis < 3; axis++)
        if (cell[axis] < 0 || cell[axis] >= cells[axis]) return -1;
    return (cell[2] * cells[1] + cell[1]) * cells[0] + cell[0];
}

void twin_inject(struct twin *twin, vec3s position, vec3s normal, double flux)
{
    int cell[3];
    for (int axis = 0; axis < 3; axis++)
        cell[axis] =
            (int)floorf((position.raw[axis] - twin->grid.origin_m.raw[axis]) / twin->grid.cell_m +
                        0.5f * normal.raw[axis]);
    const int at = index_of(twin, cell);
    if (at < 0) return;
    const double band[3] = { 1.0, twin->injected_1, 0.25 };
    float basis[9];
    sh_eval(twin->bands, normal, basis);
    for (int i = 0; i < SH_COUNT(twin->bands); i++) {
        const double coefficient = flux * band[i == 0 ? 0 : i < 4 ? 1 : 2] * (double)basis[i];
        twin->light[at][i] += coefficient;
        twin->accumulated[at][i] += coefficient;
    }
}

// Martin 2012, sec. 3.2.3 and 4.2: the flux through each face of a neighbour becomes a lobe in the
// neighbour, scaled by the transmittance.
static void send(const struct twin *twin, const double *light, double transmittance,
                 const struct lpv_neighbour *neighbour, enum lpv_lobe lobe,
                 const struct lpv_lobe_weights *weights, double *to)
{
    for (int f = 0; f < neighbour->face_count; f++) {
        const struct lpv_face *face = &neighbour->faces[f];
        float basis[9], sent[9];
        sh_eval(twin->bands, face->direction, basis);
        sh_eval(twin->bands, lobe == LPV_LOBE_NORMAL ? face->normal : face->direction, sent);
        double intensity = 0.0;
        for (int i = 0; i < SH_COUNT(twin->bands); i++) intensity += light[i] * (double)basis[i];
        for (int i = 0; i < SH_COUNT(twin->bands); i++)
            to[i] += transmittance * face->solid_angle_sr * intensity *
                     lpv_lobe_weight(weights, i) * (double)sent[i];
    }
}

static double transmittance_of(const struct twin *twin, const int cell[3], const int offset[3])
{
    if (!twin->geometry) return 1.0;
    return geometry_twin_transmittance(twin->geometry, cell, offset, twin->occlusion);
}

void twin_propagate(struct twin *twin, const struct lpv_options *how)
{
    const int count = (int)twin_cells(twin);
    const int32_t *cells = twin->grid.cells;
    const enum lpv_lobe lobe = (enum lpv_lobe)how->lobe;
    const struct lpv_lobe_weights weights =
        lpv_lobe_weights_of(twin->scheme, lobe, (double)how->focus, (double)how->filter);
    struct lpv_neighbour neighbours[LPV_MAX_NEIGHBOURS];
    const int neighbour_count = lpv_neighbours(twin->scheme, neighbours);
    double(*next)[9] = calloc((size_t)count, sizeof *next);
    for (int i = 0; i < count; i++) {
        const int cell[3] = { i % cells[0], i / cells[0] % cells[1], i / cells[0] / cells[1] };
        if (twin->closure == LPV_PRODUCT_CLOSURE)
            product_send(twin->light[i], (const int[3]){ 0 }, &twin->closed_lobe, 1.0, next[i]);
        for (int n = 0; n < neighbour_count; n++) {
            int to[3];
            for (int axis = 0; axis < 3; axis++) to[axis] = cell[axis] + neighbours[n].offset[axis];
            const int at = index_of(twin, to);
            if (at < 0) continue;
            const double transmittance = transmittance_of(twin, cell, neighbours[n].offset);
            if (twin->closure == LPV_BEAM_CLOSURE)
                closed_send(twin->light[i], neighbours[n].offset, twin->closed_lobe.along,
                            transmittance, next[at]);
            else if (twin->closure == LPV_PRODUCT_CLOSURE)
                product_send(twin->light[i], neighbours[n].offset, &twin->closed_lobe,
                             transmittance, next[at]);
            else
                send(twin, twin->light[i], transmittance, &neighbours[n], lobe, &weights, next[at]);
        }
    }
    for (int i = 0; i < count; i++)
        for (int k = 0; k < 9; k++) twin->accumulated[i][k] += next[i][k];
    free(twin->light);
    twin->light = next;
}

// A step of the positive closure is not the sum of the steps of two lights: A = S + T(A).
static void accumulate_closed(struct twin *twin, const struct lpv_options *how)
{
    const size_t bytes = twin_cells(twin) * sizeof *twin->light;
    double(*injected)[9] = malloc(bytes);
    memcpy(injected, twin->light, bytes);
    for (int step = 0; step < how->steps; step++) {
        twin_propagate(twin, how);
        for (size_t i = 0; i < twin_cells(twin); i++)
            for (int k = 0; k < 9; k++) twin->light[i][k] += injected[i][k];
    }
    memcpy(twin->accumulated, twin->light, bytes);
    free(injected);
}

void twin_accumulate(struct twin *twin, const struct lpv_options *how)
{
    if (twin->closure != LPV_NO_CLOSURE) {
        accumulate_closed(twin, how);
        return;
    }
    for (int step = 0; step < how->steps; step++) twin_propagate(twin, how);
}

double twin_flux(const struct twin *twin)
{
    double sum = 0.0;
    for (size_t i = 0; i < twin_cells(twin); i++) sum += twin->light[i][0];
    return sum * sqrt(4.0 * GLM_PI);
}

// Filter taps around a position along one axis, clamped to the border.
struct taps {
    int cell[4];
    double weight[4];
};

static struct taps taps_of(double at, int cells, enum lpv_reconstruction reconstruction)
{
    struct taps out;
    const double first = floor(at - 0.5), f = at - 0.5 - first;
    for (int i = 0; i < 4; i++) {
        out.cell[i] = (int)fmin(fmax(first + i - 1, 0.0), cells - 1.0);
        // Distance d from the cell's centre: a tent, or the cubic B-spline.
        const double d = fabs(f + 1.0 - i);
        const double near = 2.0 / 3.0 - d * d + 0.5 * d * d * d, far = pow(2.0 - d, 3.0) / 6.0;
        out.weight[i] = reconstruction == LPV_LINEAR ? fmax(1.0 - d, 0.0) : d < 1.0 ? near : far;
    }
    return out;
}

static void filter(const struct twin *twin, const double at[3],
                   enum lpv_reconstruction reconstruction, double light[9])
{
    struct taps taps[3];
    for (int axis = 0; axis < 3; axis++)
        taps[axis] = taps_of(at[axis], twin->grid.cells[axis], reconstruction);
    for (int tap = 0; tap < 64; tap++) {
        double weight = 1.0;
        int cell[3];
        for (int axis = 0; axis < 3; axis++) {
            const int i = tap >> 2 * axis & 3;
            cell[axis] = taps[axis].cell[i];
            weight *= taps[axis].weight[i];
        }
        for (int i = 0; i < SH_COUNT(twin->bands); i++)
            light[i] += weight * twin->accumulated[index_of(twin, cell)][i];
    }
}

// ∫ I (−n·ω)₊ dω at a position in cells, not negative; `lobe` is the weighted cosine.
static double gather(const struct twin *twin, const double at[3], vec3s normal,
                     enum lpv_reconstruction reconstruction, const float lobe[9])
{
    double light[9] = { 0 }, sum = 0.0;
    filter(twin, at, reconstruction, light);
    if (twin->closure == LPV_BEAM_CLOSURE) return closed_irradiance(light, normal);
    if (twin->closure == LPV_PRODUCT_CLOSURE) return product_irradiance(light, normal);
    for (int i = 0; i < SH_COUNT(twin->bands); i++) sum += light[i] * (double)lobe[i];
    return fmax(sum, 0.0);
}

double twin_irradiance(const struct twin *twin, vec3s position, vec3s normal,
                       const struct lpv_options *how)
{
    double here[3], further[3];
    for (int axis = 0; axis < 3; axis++) {
        here[axis] = (double)(position.raw[axis] - twin->grid.origin_m.raw[axis]) /
                         (double)twin->grid.cell_m +
                     (double)(how->offset * normal.raw[axis]);
        further[axis] = here[axis] + (double)normal.raw[axis];
    }
    float zonal[3], lobe[9];
    zh_clamped_cosine(twin->bands, zonal);
    zh_rotate(twin->bands, zonal, glms_vec3_negate(normal), lobe);
    const struct lpv_crossing crossing = lpv_crossing_of(twin->scheme);
    const double staircase = twin->scheme == LPV_SIX
                                 ? (double)(fabsf(normal.x) + fabsf(normal.y) + fabsf(normal.z))
                                 : 1.0;
    for (int i = 1; i < SH_COUNT(twin->bands); i++)
        lobe[i] *= how->window * (float)(i < 4 ? crossing.band_1 / staircase : crossing.band_2);
    const enum lpv_reconstruction reconstruction = (enum lpv_reconstruction)how->reconstruction;
    const double first = gather(twin, here, normal, reconstruction, lobe);
    const double loss = fmax(first - gather(twin, further, normal, reconstruction, lobe), 0.0);
    const double damped = fmax(first - (double)how->damping * loss, 0.0);
    const double area = (double)twin->grid.cell_m * (double)twin->grid.cell_m;
    const double path = twin->closure == LPV_PRODUCT_CLOSURE ? 1.0 : lpv_mean_path(twin->scheme);
    return damped * path / area;
}
