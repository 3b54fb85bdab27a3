// Edge functions in double precision, evaluated from the lesser corner to the greater one: both
// triangles at an edge compute the same number.
#include "scene/charts/raster.h"

#include <math.h>
#include <string.h>

double raster_area2(const struct raster_triangle *t)
{
    return (t->at[1][0] - t->at[0][0]) * (t->at[2][1] - t->at[0][1]) -
           (t->at[2][0] - t->at[0][0]) * (t->at[1][1] - t->at[0][1]);
}

static bool is_less(const double a[2], const double b[2])
{
    return a[0] < b[0] || (a[0] == b[0] && a[1] < b[1]);
}

// Whether p is left of the way from a to b. A point on the edge is left of the ascending way.
static bool is_left(const double a[2], const double b[2], const double p[2])
{
    const bool ascends = is_less(a, b);
    const double *from = ascends ? a : b, *to = ascends ? b : a;
    const double side = (to[0] - from[0]) * (p[1] - from[1]) - (p[0] - from[0]) * (to[1] - from[1]);
    return ascends ? side >= 0.0 : side < 0.0;
}

static bool contains(const struct raster_triangle *t, bool reversed, const double p[2])
{
    for (int k = 0; k < 3; k++) {
        const double *a = t->at[k], *b = t->at[(k + 1) % 3];
        if (!(reversed ? is_left(b, a, p) : is_left(a, b, p))) return false;
    }
    return true;
}

// The range of x in which the triangle meets the line y.
static void row_range(const struct raster_triangle *t, double y, double *low, double *high)
{
    *low = INFINITY;
    *high = -INFINITY;
    for (int k = 0; k < 3; k++) {
        const double *a = t->at[k], *b = t->at[(k + 1) % 3];
        const double bottom = fmin(a[1], b[1]), top = fmax(a[1], b[1]);
        if (y < bottom || y > top) continue;
        const double share = top > bottom ? (y - a[1]) / (b[1] - a[1]) : 0.0;
        const double x = a[0] + share * (b[0] - a[0]);
        *low = fmin(*low, top > bottom ? x : fmin(a[0], b[0]));
        *high = fmax(*high, top > bottom ? x : fmax(a[0], b[0]));
    }
}

bool raster_centres(const struct raster_triangle *t, raster_visit visit, void *user)
{
    const double bottom = fmin(t->at[0][1], fmin(t->at[1][1], t->at[2][1]));
    const double top = fmax(t->at[0][1], fmax(t->at[1][1], t->at[2][1]));
    const bool reversed = raster_area2(t) < 0.0;
    if (raster_area2(t) == 0.0) return true;
    for (double y = floor(bottom - 0.5); y <= top - 0.5; y += 1.0) {
        double low, high;
        row_range(t, y + 0.5, &low, &high);
        // One texel more on both sides, against the rounding of the range.
        for (double x = floor(low - 1.5); x <= high + 0.5; x += 1.0) {
            const double centre[2] = { x + 0.5, y + 0.5 };
            if (contains(t, reversed, centre) && !visit(user, (int32_t)x, (int32_t)y)) return false;
        }
    }
    return true;
}

struct raster_polygon raster_polygon_of(const vec2s corner[3])
{
    struct raster_polygon polygon = { .count = 3 };
    for (int k = 0; k < 3; k++)
        for (int a = 0; a < 2; a++) polygon.at[k][a] = (double)corner[k].raw[a];
    return polygon;
}

// Sutherland & Hodgman 1974, one half-plane: sign · (coordinate − limit) ≥ 0.
static struct raster_polygon clip_side(const struct raster_polygon *in, int axis, double limit,
                                       double sign)
{
    struct raster_polygon out = { .count = 0 };
    for (int i = 0; i < in->count; i++) {
        const double *a = in->at[i], *b = in->at[(i + 1) % in->count];
        const double side_a = sign * (a[axis] - limit), side_b = sign * (b[axis] - limit);
        if (side_a >= 0.0 && out.count < RASTER_MAX_CORNERS)
            memcpy(out.at[out.count++], a, sizeof out.at[0]);
        if ((side_a < 0.0) == (side_b < 0.0) || out.count >= RASTER_MAX_CORNERS) continue;
        const double share = side_a / (side_a - side_b);
        double *cut = out.at[out.count++];
        cut[1 - axis] = a[1 - axis] + share * (b[1 - axis] - a[1 - axis]);
        cut[axis] = limit;
    }
    return out;
}

struct raster_polygon raster_clip(const struct raster_polygon *polygon, int axis, double low)
{
    const struct raster_polygon above = clip_side(polygon, axis, low, 1.0);
    return clip_side(&above, axis, low + 1.0, -1.0);
}

static void range_of(const struct raster_polygon *polygon, int axis, double *low, double *high)
{
    *low = INFINITY;
    *high = -INFINITY;
    for (int i = 0; i < polygon->count; i++) {
        *low = fmin(*low, polygon->at[i][axis]);
        *high = fmax(*high, polygon->at[i][axis]);
    }
    *low = floor(*low);
}

bool raster_parts(const struct raster_polygon *polygon, raster_part_visit visit, void *user)
{
    double top, bottom, left, right;
    range_of(polygon, 1, &bottom, &top);
    for (double y = bottom; y < top; y += 1.0) {
        const struct raster_polygon row = raster_clip(polygon, 1, y);
        if (row.count < 3) continue;
        range_of(&row, 0, &left, &right);
        for (double x = left; x < right; x += 1.0) {
            const struct raster_polygon part = raster_clip(&row, 0, x);
            if (!visit(user, (int32_t)x, (int32_t)y, &part)) return false;
        }
    }
    return true;
}

// Twice the signed area of a triangle of the fan around corner 0.
static double fan_area2(const struct raster_polygon *p, int i)
{
    const double *o = p->at[0], *a = p->at[i], *b = p->at[i + 1];
    return (a[0] - o[0]) * (b[1] - o[1]) - (b[0] - o[0]) * (a[1] - o[1]);
}

double raster_polygon_area(const struct raster_polygon *p)
{
    double sum = 0.0;
    for (int i = 1; i + 1 < p->count; i++) sum += fan_area2(p, i);
    return 0.5 * fabs(sum);
}

void raster_polygon_centroid(const struct raster_polygon *p, double out[2])
{
    double sum = 0.0, moment[2] = { 0.0, 0.0 };
    for (int i = 1; i + 1 < p->count; i++) {
        const double area2 = fan_area2(p, i);
        sum += area2;
        for (int k = 0; k < 2; k++)
            moment[k] += area2 * (p->at[0][k] + p->at[i][k] + p->at[i + 1][k]) / 3.0;
    }
    for (int k = 0; k < 2; k++) out[k] = moment[k] / sum;
}
