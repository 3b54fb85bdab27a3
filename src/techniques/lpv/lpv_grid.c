// Placement of the grid, and bounds on the flux, from which the scales of the fixed-point sums and
// of the grid follow.
#include "techniques/lpv/lpv_grid.h"

#include <math.h>
#include <string.h>

bool lpv_grid_fit(struct box3 bounds, int dim, float margin, struct lpv_grid *out)
{
    if (box3_is_empty(bounds)) return false;
    const vec3s size = box3_size(bounds);
    const double longest = (double)fmaxf(size.x, fmaxf(size.y, size.z));
    if (!(longest > 0.0) || !isfinite(longest)) return false;
    // Snapping both sides outwards adds less than one cell to the length.
    const double least = longest / ((double)dim - 1.0 - 2.0 * (double)margin);
    const double cell = exp2(ceil(16.0 * log2(least)) / 16.0);
    out->cell_m = (float)cell;
    out->open = 0;
    for (int axis = 0; axis < 3; axis++) {
        const double first = floor((double)bounds.min.raw[axis] / cell - (double)margin);
        const double last = ceil((double)bounds.max.raw[axis] / cell + (double)margin);
        out->origin_m.raw[axis] = (float)(first * cell);
        out->cells[axis] = (int32_t)fmin(fmax(last - first, 1.0), (double)dim);
    }
    return isfinite(out->cell_m) && out->cell_m > 0.0f;
}

// The smallest cell, as a share of the largest coordinate: four steps of the rounding of positions.
// Numbers of cells below 2^22 are exact.
static const float LEAST_CELL = 0x1p-22f;

static float largest_coordinate(struct box3 bounds)
{
    return fmaxf(glms_vec3_max(glms_vec3_abs(bounds.min)),
                 glms_vec3_max(glms_vec3_abs(bounds.max)));
}

void lpv_grid_around(struct box3 bounds, int dim, float margin, float cell_m, vec3s camera,
                     struct lpv_grid *out)
{
    const float least = LEAST_CELL * largest_coordinate(bounds);
    const double cell = (double)fmaxf(cell_m, least);
    out->cell_m = (float)cell;
    out->open = 0;
    for (int axis = 0; axis < 3; axis++) {
        const double low = floor((double)bounds.min.raw[axis] / cell - (double)margin);
        const double high = ceil((double)bounds.max.raw[axis] / cell + (double)margin);
        const double centred = 2.0 * round(0.5 * (double)camera.raw[axis] / cell) - 0.5 * dim;
        const double first = fmax(low, fmin(centred, high - dim));
        const double last = fmax(fmin(high, first + dim), first + 1.0);
        out->origin_m.raw[axis] = (float)(first * cell);
        out->cells[axis] = (int32_t)(last - first);
        if (first > low) out->open |= LPV_OPEN(axis, 0);
        if (last < high) out->open |= LPV_OPEN(axis, 1);
    }
}

struct box3 lpv_grid_inside(const struct lpv_grid *grid, float distance)
{
    const float FAR_M = 1e30f;
    struct box3 box;
    for (int axis = 0; axis < 3; axis++) {
        const float first = grid->origin_m.raw[axis], cells = (float)grid->cells[axis];
        box.min.raw[axis] =
            grid->open & LPV_OPEN(axis, 0) ? first + distance * grid->cell_m : -FAR_M;
        box.max.raw[axis] =
            grid->open & LPV_OPEN(axis, 1) ? first + (cells - distance) * grid->cell_m : FAR_M;
    }
    return box;
}

bool lpv_grid_equal(const struct lpv_grid *a, const struct lpv_grid *b)
{
    return a->cell_m == b->cell_m && memcmp(a->cells, b->cells, sizeof a->cells) == 0 &&
           memcmp(&a->origin_m, &b->origin_m, sizeof a->origin_m) == 0;
}

static double max_channel(vec3s v)
{
    return (double)fmaxf(v.x, fmaxf(v.y, v.z));
}

// Bounds in scaled lumen for a reflectance of 1: flux of the strongest texel, and of the whole
// face.
static void face_flux(const struct rsm_face *face, double rsm_size, double *texel, double *total)
{
    const double intensity = max_channel(face->intensity);
    if (face->type == FRAME_LIGHT_SUN) {
        *texel = intensity;
        *total = intensity * rsm_size * rsm_size;
        return;
    }
    // A texel at unit distance has the side 2 tan/size, which bounds its solid angle. The solid
    // angle of the face is that of a square pyramid, 4 asin(sin² of the half-angle).
    const double tangent = (double)face->tan_half;
    const double side = 2.0 * tangent / rsm_size;
    *texel = intensity * side * side;
    *total = intensity * 4.0 * asin(tangent * tangent / (1.0 + tangent * tangent));
}

// The largest power of two 2^n with value · 2^n ≤ 2^limit, within the range of a float.
static float power_of_two_below(double value, int limit)
{
    int exponent = 0;
    (void)frexp(value, &exponent); // value < 2^exponent
    const int power = limit - exponent;
    return ldexpf(1.0f, power < -100 ? -100 : power > 100 ? 100 : power);
}

bool lpv_scale_of(const struct lpv_lights *lights, struct lpv_scale *out)
{
    double largest = 0.0, total = 0.0; // flux of one addition, of all
    for (int i = 0; i < lights->face_count; i++) {
        double texel, face;
        face_flux(&lights->faces[i], (double)lights->rsm_size, &texel, &face);
        largest = fmax(largest, texel * (LPV_TEXELS * LPV_TEXELS));
        total += face;
    }
    for (int i = 0; i < lights->emitter_count; i++) {
        largest = fmax(largest, max_channel(lights->emitters[i].flux));
        total += max_channel(lights->emitters[i].flux);
    }
    total = (total + max_channel(lights->sky_flux)) * (1.0 + (double)lights->bounces);
    if (!(total > 0.0) || !isfinite(total)) return false;
    // The largest coefficient of a unit-flux lobe is below 1/2: 2/3 √(3/4π) = 0.326 in band 1.
    out->fixed_from_flux = power_of_two_below(largest * 0.5, 30);
    // With all light in one cell, coefficients are at most half of it; light that returns in later
    // steps keeps the sum below three quarters.
    out->grid_from_flux = power_of_two_below(total, 13);
    return true;
}
