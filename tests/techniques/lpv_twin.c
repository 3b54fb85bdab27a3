#include "techniques/lpv_twin.h"

#include "core/sh.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

size_t twin_cells(const struct twin *twin)
{
    return (size_t)twin->grid.cells[0] * (size_t)twin->grid.cells[1] * (size_t)twin->grid.cells[2];
}

void twin_init(struct twin *twin, struct lpv_grid grid)
{
    twin->grid = grid;
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
    float zonal[2], lobe[4];
    zh_clamped_cosine(2, zonal);
    zh_rotate(2, zonal, normal, lobe);
    for (int i = 0; i < 4; i++) {
        twin->light[at][i] += flux / GLM_PI * (double)lobe[i];
        twin->accumulated[at][i] += flux / GLM_PI * (double)lobe[i];
    }
}

// Martin 2012, sec. 3.2.3: the flux through each face of each neighbour becomes a lobe in the
// neighbour.
static void send(const struct twin *twin, double (*next)[4], const double light[4],
                 const int cell[3], enum lpv_lobe lobe, float mean_cosine)
{
    for (int direction = 0; direction < LPV_DIRECTIONS; direction++) {
        int to[3] = { cell[0], cell[1], cell[2] };
        to[direction / 2] += direction % 2 == 0 ? 1 : -1;
        const int at = index_of(twin, to);
        if (at < 0) continue;
        struct lpv_face faces[LPV_FACES];
        lpv_faces(direction, faces);
        for (int f = 0; f < LPV_FACES; f++) {
            float basis[4], sent[4];
            sh_eval(2, faces[f].direction, basis);
            double intensity = 0.0;
            for (int i = 0; i < 4; i++) intensity += light[i] * (double)basis[i];
            lpv_lobe_coefficients(lobe == LPV_LOBE_NORMAL ? faces[f].normal : faces[f].direction,
                                  mean_cosine, sent);
            for (int i = 0; i < 4; i++)
                next[at][i] += faces[f].solid_angle_sr * intensity * (double)sent[i];
        }
    }
}

void twin_propagate(struct twin *twin, enum lpv_lobe lobe, float mean_cosine)
{
    const size_t count = twin_cells(twin);
    double(*next)[4] = calloc(count, sizeof *next);
    const int32_t *cells = twin->grid.cells;
    for (int z = 0; z < cells[2]; z++)
        for (int y = 0; y < cells[1]; y++)
            for (int x = 0; x < cells[0]; x++) {
                const int cell[3] = { x, y, z };
                send(twin, next, twin->light[index_of(twin, cell)], cell, lobe, mean_cosine);
            }
    for (size_t i = 0; i < count; i++)
        for (int k = 0; k < 4; k++) twin->accumulated[i][k] += next[i][k];
    free(twin->light);
    twin->light = next;
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
    float zonal[2], lobe[4];
    zh_clamped_cosine(2, zonal);
    zh_rotate(2, zonal, glms_vec3_negate(normal), lobe);
    for (int i = 1; i < 4; i++) lobe[i] *= window;
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
        for (int i = 0; i < 4; i++) sum += weight * twin->accumulated[index][i] * (double)lobe[i];
    }
    const double area = (double)twin->grid.cell_m * (double)twin->grid.cell_m;
    return fmax(sum * 2.0 / 3.0 / area, 0.0);
}
