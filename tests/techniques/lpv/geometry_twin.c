#include "techniques/lpv/geometry_twin.h"

#include "core/sh.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static int index_of(const struct geometry_twin *twin, int x, int y, int z)
{
    const int32_t *cells = twin->grid.cells;
    return (z * (cells[1] + 1) + y) * (cells[0] + 1) + x;
}

static size_t count_of(const struct geometry_twin *twin)
{
    return (size_t)index_of(twin, twin->grid.cells[0], twin->grid.cells[1], twin->grid.cells[2]) +
           1;
}

void geometry_twin_init(struct geometry_twin *twin, struct lpv_grid grid, int kind)
{
    *twin = (struct geometry_twin){ .grid = grid, .kind = kind };
    twin->volume = calloc(count_of(twin), sizeof *twin->volume);
    twin->source = calloc(count_of(twin), sizeof *twin->source);
    twin->covered = calloc(count_of(twin), (size_t)3 * LPV_LINES * LPV_LINES);
    twin->places = calloc(count_of(twin), (size_t)3 * LPV_PLACES);
}

void geometry_twin_finish(struct geometry_twin *twin)
{
    free(twin->volume);
    free(twin->source);
    free(twin->covered);
    free(twin->places);
}

static double in_cells(const struct geometry_twin *twin, vec3s position, int axis)
{
    return ((double)position.raw[axis] - (double)twin->grid.origin_m.raw[axis]) /
           (double)twin->grid.cell_m;
}

void geometry_twin_surfel(struct geometry_twin *twin, vec3s position, vec3s normal, vec3s to_viewer,
                          double across)
{
    int corner[3];
    for (int axis = 0; axis < 3; axis++) {
        corner[axis] = (int)floor(in_cells(twin, position, axis) + 0.5);
        if (corner[axis] < 1 || corner[axis] >= twin->grid.cells[axis]) return;
    }
    const double cosine = fmax((double)glms_vec3_dot(normal, to_viewer), 0.1);
    const double face = (double)twin->grid.cell_m * (double)twin->grid.cell_m;
    const double coverage = fmin(across / cosine / face, 1.0);
    float zonal[2], lobe[4];
    zh_clamped_cosine(2, zonal);
    zh_rotate(2, zonal, normal, lobe);
    double *sum = twin->source[index_of(twin, corner[0], corner[1], corner[2])];
    for (int i = 0; i < 4; i++) sum[i] += coverage * (double)lobe[i];
}

// Rounds to the eleven bits of a half float.
static double half_of(double value)
{
    int exponent;
    const double fraction = frexp(value, &exponent);
    return ldexp(nearbyint(ldexp(fraction, 11)), exponent - 11);
}

static bool is_greater(const double a[4], const double b[4])
{
    for (int i = 0; i < 4; i++)
        if (half_of(a[i]) != half_of(b[i])) return half_of(a[i]) > half_of(b[i]);
    return false;
}

void geometry_twin_merge(struct geometry_twin *twin)
{
    for (size_t i = 0; i < count_of(twin); i++)
        if (is_greater(twin->source[i], twin->volume[i]))
            memcpy(twin->volume[i], twin->source[i], sizeof twin->volume[i]);
    memset(twin->source, 0, count_of(twin) * sizeof *twin->source);
}

// Intersects the line (u, v) along `axis` with the triangle; coordinates in cells.
static bool meets(double corners[3][3], int axis, double u, double v, double *where)
{
    const int a = (axis + 1) % 3, b = (axis + 2) % 3;
    double weight[3], area = 0.0;
    for (int k = 0; k < 3; k++) {
        const double *p = corners[(k + 1) % 3], *q = corners[(k + 2) % 3];
        weight[k] = (p[a] - u) * (q[b] - v) - (p[b] - v) * (q[a] - u);
        area += weight[k];
    }
    *where = 0.0;
    for (int k = 0; k < 3; k++) {
        if (!(weight[k] * area > 0.0)) return false;
        *where += weight[k] / area * corners[k][axis];
    }
    return true;
}

static void cross(struct geometry_twin *twin, double corners[3][3], int axis, int u, int v)
{
    double where;
    if (!meets(corners, axis, (u + 0.5) / LPV_LINES, (v + 0.5) / LPV_LINES, &where)) return;
    int at[3];
    at[axis] = (int)floor(where + 0.5);
    at[(axis + 1) % 3] = u / LPV_LINES;
    at[(axis + 2) % 3] = v / LPV_LINES;
    for (int i = 0; i < 3; i++)
        if (at[i] < 0 || at[i] >= twin->grid.cells[i]) return;
    const int face = 3 * index_of(twin, at[0], at[1], at[2]) + axis;
    const int place = (int)((where + 0.5 - floor(where + 0.5)) * (double)LPV_PLACES);
    twin->covered[(face * LPV_LINES + u % LPV_LINES) * LPV_LINES + v % LPV_LINES] = 1;
    twin->places[face * (int)LPV_PLACES + place] = 1;
}

void geometry_twin_triangle(struct geometry_twin *twin, const vec3s corners[3])
{
    double in[3][3];
    for (int k = 0; k < 3; k++)
        for (int axis = 0; axis < 3; axis++) in[k][axis] = in_cells(twin, corners[k], axis);
    for (int axis = 0; axis < 3; axis++)
        for (int v = 0; v < LPV_LINES * twin->grid.cells[(axis + 2) % 3]; v++)
            for (int u = 0; u < LPV_LINES * twin->grid.cells[(axis + 1) % 3]; u++)
                cross(twin, in, axis, u, v);
}

const double *geometry_twin_at(const struct geometry_twin *twin, int x, int y, int z)
{
    return twin->volume[index_of(twin, x, y, z)];
}

static double transmitted(double occluded, double occlusion)
{
    return 1.0 - fmin(fmax(occluded * occlusion, 0.0), 1.0);
}

static int clamped(int value, int low, int high)
{
    return value < low ? low : value > high ? high : value;
}

// Mean of the corners that two cells share; inner neighbours replace those on the border.
static double corner_occlusion(const struct geometry_twin *twin, const int cell[3],
                               const int offset[3])
{
    double sum[4] = { 0 };
    int count = 0;
    for (int k = 0; k < 8; k++) {
        int corner[3];
        bool shared = true;
        for (int axis = 0; axis < 3; axis++) {
            const int high = k >> axis & 1;
            shared = shared && (offset[axis] == 0 || high == (offset[axis] > 0));
            const int last = twin->grid.cells[axis] > 1 ? twin->grid.cells[axis] - 1 : 1;
            corner[axis] = clamped(cell[axis] + high, 1, last);
        }
        if (!shared) continue;
        const double *c = geometry_twin_at(twin, corner[0], corner[1], corner[2]);
        for (int i = 0; i < 4; i++) sum[i] += c[i];
        count++;
    }
    float basis[4];
    const vec3s back = vec3_of((float)-offset[0], (float)-offset[1], (float)-offset[2]);
    sh_eval(2, glms_vec3_normalize(back), basis);
    double occluded = 0.0;
    for (int i = 0; i < 4; i++) occluded += sum[i] / count * (double)basis[i];
    return occluded * (double)glms_vec3_norm(back) / 0.75; // the peak of a clamped cosine
}

static bool is_inside(const struct geometry_twin *twin, const int cell[3])
{
    for (int axis = 0; axis < 3; axis++)
        if (cell[axis] < 0 || cell[axis] >= twin->grid.cells[axis]) return false;
    return true;
}

static bool is_covered(const struct geometry_twin *twin, const int cell[3], int axis, int u, int v)
{
    const int face = 3 * index_of(twin, cell[0], cell[1], cell[2]) + axis;
    return twin->covered[(face * LPV_LINES + u) * LPV_LINES + v] != 0;
}

// Whether a surface is between the centre of a cell and its line `along` of axis b. `across`: the
// row of lines, of the next axis, or LPV_LINES more of the one after it.
static bool is_cut_off(const struct geometry_twin *twin, const int cell[3], int b, int along,
                       int across)
{
    const bool above = along >= LPV_LINES / 2;
    const double distance = fabs((along + 0.5) / LPV_LINES - 0.5);
    int at[3] = { cell[0], cell[1], cell[2] }, lines = 0;
    if (above) at[b]++;
    if (!is_inside(twin, at)) return false;
    for (int i = 0; i < LPV_LINES; i++)
        lines += across < LPV_LINES ? is_covered(twin, at, b, across, i)
                                    : is_covered(twin, at, b, i, across - LPV_LINES);
    if (2 * lines < LPV_LINES) return false;
    const unsigned char *places =
        &twin->places[(3 * index_of(twin, at[0], at[1], at[2]) + b) * (int)LPV_PLACES];
    for (int p = 0; p < (int)LPV_PLACES; p++) {
        const double from_centre = above ? p : (double)LPV_PLACES - 1.0 - p;
        if (places[p] && from_centre < distance * (double)LPV_PLACES) return true;
    }
    return false;
}

// Whether line (u, v) along an axis is on the side of the cell's centre.
static bool is_reached(const struct geometry_twin *twin, const int cell[3], int axis, int u, int v)
{
    return !is_cut_off(twin, cell, (axis + 1) % 3, u, v) &&
           !is_cut_off(twin, cell, (axis + 2) % 3, v, LPV_LINES + u);
}

double geometry_twin_occluded(const struct geometry_twin *twin, const int cell[3], int axis,
                              int side)
{
    int to[3] = { cell[0], cell[1], cell[2] }, from = 0, passed = 0;
    to[axis] += side;
    const int *face = side > 0 ? to : cell;
    for (int u = 0; u < LPV_LINES; u++)
        for (int v = 0; v < LPV_LINES; v++) {
            if (!is_reached(twin, cell, axis, u, v)) continue;
            from++;
            passed += is_reached(twin, to, axis, u, v) && !is_covered(twin, face, axis, u, v);
        }
    return from == 0 ? 1.0 : 1.0 - (double)passed / from;
}

// Mean over all orders of the axes of the offset.
static double path_transmittance(const struct geometry_twin *twin, const int cell[3],
                                 const int offset[3], double occlusion)
{
    double sum = 0.0;
    int count = 0;
    for (int axis = 0; axis < 3; axis++) {
        if (offset[axis] == 0) continue;
        int next[3] = { cell[0], cell[1], cell[2] }, rest[3] = { offset[0], offset[1], offset[2] };
        next[axis] += offset[axis];
        rest[axis] = 0;
        sum += transmitted(geometry_twin_occluded(twin, cell, axis, offset[axis]), occlusion) *
               path_transmittance(twin, next, rest, occlusion);
        count++;
    }
    return count == 0 ? 1.0 : sum / count;
}

double geometry_twin_transmittance(const struct geometry_twin *twin, const int cell[3],
                                   const int offset[3], double occlusion)
{
    if (twin->kind == LPV_GEOMETRY_MAPS)
        return transmitted(corner_occlusion(twin, cell, offset), occlusion);
    return path_transmittance(twin, cell, offset, occlusion);
}
