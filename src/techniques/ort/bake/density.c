// A density is the graph of a function: a prism above each triangle, as a stack of three
// tetrahedra, whose volumes are the area times a third of the value of each corner.
//
// Differs from the paper: volumes where it says area, barycentric interpolation where it says
// bilinear.
#include "techniques/ort/bake/density.h"

#include <math.h>
#include <stdlib.h>

static int by_place(const void *a, const void *b)
{
    const struct ort_point *p = a, *q = b;
    if (p->y != q->y) return p->y < q->y ? -1 : 1;
    if (p->x != q->x) return p->x < q->x ? -1 : 1;
    return (p->value > q->value) - (p->value < q->value);
}

static bool is_valid(struct ort_point point)
{
    return isfinite(point.x) && isfinite(point.y) && isfinite(point.value) && point.value >= 0.0f;
}

// Averages the values of coincident points, which are neighbours.
static void merge_coincident(struct ort_density *density)
{
    struct ort_point *points = density->points;
    uint32_t merged = 0;
    for (uint32_t i = 0, next; i < density->point_count; i = next) {
        double sum = 0.0;
        for (next = i; next < density->point_count && points[next].x == points[i].x &&
                       points[next].y == points[i].y;
             next++)
            sum += (double)points[next].value;
        points[merged] = points[i];
        points[merged++].value = (float)(sum / (next - i));
    }
    density->point_count = merged;
}

static bool copy_points(struct ort_density *density, const struct ort_point *points, uint32_t count)
{
    density->points = host_alloc(density->host, count, sizeof *density->points);
    if (!density->points) return false;
    for (uint32_t i = 0; i < count; i++) {
        if (!is_valid(points[i]))
            return host_fail(density->host, FAIL_ARGUMENT,
                             "data point %u of a density: (%g, %g) with value %g; coordinates must "
                             "be finite and values at least 0",
                             i, (double)points[i].x, (double)points[i].y, (double)points[i].value);
        density->points[i] = points[i];
    }
    qsort(density->points, count, sizeof *density->points, by_place);
    density->point_count = count;
    merge_coincident(density);
    return true;
}

static bool triangulate(struct ort_density *density)
{
    double *at = host_alloc(density->host, density->point_count, 2 * sizeof *at);
    if (!at) return false;
    for (uint32_t i = 0; i < density->point_count; i++) {
        at[2 * i] = (double)density->points[i].x;
        at[2 * i + 1] = (double)density->points[i].y;
    }
    const bool ok = ort_delaunay(density->host, at, density->point_count, &density->triangles);
    host_free(density->host, at);
    return ok;
}

// Twice the signed area of a, b and (x, y), positive where they are counter-clockwise. The two
// triangles of an edge round it alike, so that no gap is between them.
static double side(const struct ort_point *points, uint32_t a, uint32_t b, double x, double y)
{
    if (a > b) return -side(points, b, a, x, y);
    const double ax = (double)points[a].x, ay = (double)points[a].y;
    return ((double)points[b].x - ax) * (y - ay) - ((double)points[b].y - ay) * (x - ax);
}

static double area_of(const struct ort_density *density, const uint32_t corner[3])
{
    const struct ort_point *third = &density->points[corner[2]];
    return 0.5 *
           fabs(side(density->points, corner[0], corner[1], (double)third->x, (double)third->y));
}

// Volumes of all tetrahedra, with a height of 1 everywhere if `uniform`. Returns their sum.
static double add_volumes(struct ort_density *density, bool uniform)
{
    double sum = 0.0;
    for (uint32_t t = 0; t < density->triangles.count; t++) {
        const uint32_t *corner = density->triangles.corners[t];
        const double third = area_of(density, corner) / 3.0;
        for (int k = 0; k < 3; k++) {
            sum += third * (uniform ? 1.0 : (double)density->points[corner[k]].value);
            density->sums[3 * (size_t)t + (size_t)k] = sum;
        }
    }
    return sum;
}

bool ort_density_init(struct ort_density *out, struct host *host, const struct ort_point *points,
                      uint32_t count)
{
    *out = (struct ort_density){ .host = host };
    if (!copy_points(out, points, count) || !triangulate(out)) goto fail;
    out->sums = host_alloc(host, out->triangles.count, 3 * sizeof *out->sums);
    if (!out->sums) goto fail;
    out->integral = add_volumes(out, false);
    if (out->integral == 0.0) add_volumes(out, true);
    return true;
fail:
    ort_density_finish(out);
    return false;
}

void ort_density_finish(struct ort_density *density)
{
    if (!density->host) return;
    ort_triangles_finish(density->host, &density->triangles);
    host_free(density->host, density->points);
    host_free(density->host, density->sums);
    *density = (struct ort_density){ 0 };
}

float ort_density_at(const struct ort_density *density, float x, float y)
{
    for (uint32_t t = 0; t < density->triangles.count; t++) {
        const uint32_t *corner = density->triangles.corners[t];
        double sum = 0.0, value = 0.0;
        bool inside = true;
        for (int k = 0; k < 3 && inside; k++) {
            const double weight = side(density->points, corner[(k + 1) % 3], corner[(k + 2) % 3],
                                       (double)x, (double)y);
            inside = weight >= 0.0;
            sum += weight;
            value += weight * (double)density->points[corner[k]].value;
        }
        if (inside && sum > 0.0) return (float)(value / sum);
    }
    return 0.0f;
}

// ---- sampling

// The first tetrahedron whose sum is greater than a random one: never one without volume.
static size_t choose_tetrahedron(const struct ort_density *density, struct rng *rng)
{
    size_t low = 0, high = 3 * (size_t)density->triangles.count - 1;
    const double sum = rng_double(rng) * density->sums[high];
    while (low < high) {
        const size_t middle = low + (high - low) / 2;
        if (density->sums[middle] > sum)
            high = middle;
        else
            low = middle + 1;
    }
    return low;
}

// Barycentric coordinates of a uniform point of a tetrahedron (Rocchini & Cignoni 2001): the unit
// cube is folded into the one that s + t + u ≤ 1 bounds.
static void sample_tetrahedron(struct rng *rng, double weight[4])
{
    double s = rng_double(rng), t = rng_double(rng), u = rng_double(rng);
    if (s + t > 1.0) {
        s = 1.0 - s;
        t = 1.0 - t;
    }
    const double rest = 1.0 - s - t, old = u;
    if (t + u > 1.0) {
        u = rest;
        t = 1.0 - old;
    } else if (u > rest) {
        u = u - rest;
        s = 1.0 - t - old;
    }
    weight[0] = s;
    weight[1] = t;
    weight[2] = u;
    weight[3] = fmax(1.0 - s - t - u, 0.0);
}

// Tetrahedron k of a triangle has vertices above all three corners, and a second one above corner
// k. The point's height is not needed.
void ort_density_sample(const struct ort_density *density, struct rng *rng, float at[2])
{
    const size_t chosen = choose_tetrahedron(density, rng);
    const uint32_t *corner = density->triangles.corners[chosen / 3];
    double weight[4], x = 0.0, y = 0.0;
    sample_tetrahedron(rng, weight);
    weight[chosen % 3] += weight[3];
    for (int k = 0; k < 3; k++) {
        x += weight[k] * (double)density->points[corner[k]].x;
        y += weight[k] * (double)density->points[corner[k]].y;
    }
    at[0] = (float)x;
    at[1] = (float)y;
}
