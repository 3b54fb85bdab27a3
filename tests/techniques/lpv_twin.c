#include "techniques/lpv_twin.h"

#include "core/sh.h"
#include "techniques/geometry_twin.h"

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
    twin->steps = 0;
    twin->geometry = NULL;
    twin->light = calloc(twin_cells(twin), sizeof *twin->light);
    twin->accumulated = calloc(twin_cells(twin), sizeof *twin->accumulated);
}

void twin_finish(struct twin *twin)
{
    free(twin->light);
    free(twin->accumulated);
}

// −1 outside.
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
    float zonal[3], lobe[9];
    zh_clamped_cosine(twin->bands, zonal);
    zh_rotate(twin->bands, zonal, normal, lobe);
    for (int i = 0; i < SH_COUNT(twin->bands); i++) {
        twin->light[at][i] += flux / GLM_PI * (double)lobe[i];
        twin->accumulated[at][i] += flux / GLM_PI * (double)lobe[i];
    }
}

// Martin 2012, sec. 3.2.3 and 4.2: the flux through each face of a neighbour becomes a lobe in the
// neighbour, of which `share` gets there.
static void send(const struct twin *twin, const double *light, double share,
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
            to[i] += share * face->solid_angle_sr * intensity * lpv_lobe_weight(weights, i) *
                     (double)sent[i];
    }
}

static double passing(const struct twin *twin, const int cell[3], const int offset[3])
{
    if (!twin->geometry || twin->steps == 0) return 1.0;
    return geometry_twin_passing(twin->geometry, cell, offset, twin->blocking);
}

void twin_propagate(struct twin *twin, enum lpv_lobe lobe, double focus)
{
    const int count = (int)twin_cells(twin);
    const int32_t *cells = twin->grid.cells;
    const struct lpv_lobe_weights weights = lpv_lobe_weights_of(twin->scheme, lobe, focus);
    struct lpv_neighbour neighbours[LPV_MAX_NEIGHBOURS];
    const int neighbour_count = lpv_neighbours(twin->scheme, neighbours);
    double(*next)[9] = calloc((size_t)count, sizeof *next);
    for (int i = 0; i < count; i++) {
        const int cell[3] = { i % cells[0], i / cells[0] % cells[1], i / cells[0] / cells[1] };
        for (int n = 0; n < neighbour_count; n++) {
            int to[3];
            for (int axis = 0; axis < 3; axis++) to[axis] = cell[axis] + neighbours[n].offset[axis];
            const int at = index_of(twin, to);
            if (at < 0) continue;
            const double share = passing(twin, cell, neighbours[n].offset);
            send(twin, twin->light[i], share, &neighbours[n], lobe, &weights, next[at]);
        }
    }
    for (int i = 0; i < count; i++)
        for (int k = 0; k < 9; k++) twin->accumulated[i][k] += next[i][k];
    free(twin->light);
    twin->light = next;
    twin->steps++;
}

double twin_flux(const struct twin *twin)
{
    double sum = 0.0;
    for (size_t i = 0; i < twin_cells(twin); i++) sum += twin->light[i][0];
    return sum * sqrt(4.0 * GLM_PI);
}

double twin_irradiance(const struct twin *twin, vec3s position, vec3s normal, float offset,
                       float window)
{
    double at[3];
    int low[3];
    for (int axis = 0; axis < 3; axis++) {
        const double cells = (double)twin->grid.cells[axis];
        const double p = (double)(position.raw[axis] - twin->grid.origin_m.raw[axis]) /
                             (double)twin->grid.cell_m +
                         (double)(offset * normal.raw[axis]);
        at[axis] = fmin(fmax(p - 0.5, 0.0), cells - 1.0);
        low[axis] = (int)fmin(floor(at[axis]), fmax(cells - 2.0, 0.0));
        at[axis] -= (double)low[axis];
    }
    float zonal[3], lobe[9];
    zh_clamped_cosine(twin->bands, zonal);
    zh_rotate(twin->bands, zonal, glms_vec3_negate(normal), lobe);
    for (int i = 1; i < SH_COUNT(twin->bands); i++) lobe[i] *= window;
    double sum = 0.0;
    for (int corner = 0; corner < 8; corner++) {
        double weight = 1.0;
        int cell[3];
        for (int axis = 0; axis < 3; axis++) {
            const int up = corner >> axis & 1;
            weight *= up ? at[axis] : 1.0 - at[axis];
            cell[axis] = low[axis] + up;
        }
        const int index = index_of(twin, cell);
        if (index < 0 || weight == 0.0) continue;
        for (int i = 0; i < SH_COUNT(twin->bands); i++)
            sum += weight * twin->accumulated[index][i] * (double)lobe[i];
    }
    const double area = (double)twin->grid.cell_m * (double)twin->grid.cell_m;
    return fmax(sum * lpv_mean_way(twin->scheme) / area, 0.0);
}
