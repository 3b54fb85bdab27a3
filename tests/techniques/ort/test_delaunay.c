// Triangulations: Delaunay, of the whole hull, of every point.
#include "framework/test.h"

#include "core/rng.h"
#include "techniques/ort/bake/delaunay.h"

#include <math.h>
#include <string.h>

enum { MOST = 400 };

static double cross(const double *a, const double *b, const double *c)
{
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

// Positive where d lies inside the circle of a, b, c, which are counter-clockwise.
static double in_circle(const double *a, const double *b, const double *c, const double *d)
{
    double rows[3][3];
    const double *corner[3] = { a, b, c };
    for (int i = 0; i < 3; i++) {
        rows[i][0] = corner[i][0] - d[0];
        rows[i][1] = corner[i][1] - d[1];
        rows[i][2] = rows[i][0] * rows[i][0] + rows[i][1] * rows[i][1];
    }
    double sum = 0.0;
    for (int i = 0; i < 3; i++) {
        const double *p = rows[i], *q = rows[(i + 1) % 3], *r = rows[(i + 2) % 3];
        sum += p[2] * (q[0] * r[1] - q[1] * r[0]);
    }
    return sum;
}

// Distinct integer points in a square of `side`: all arithmetic of this file is exact.
static uint32_t random_points(uint32_t seed, uint32_t count, uint32_t side, double *at)
{
    struct rng rng = rng_for(seed, 0, 0);
    uint32_t found = 0;
    while (found < count) {
        const double x = rng_u32(&rng) % side, y = rng_u32(&rng) % side;
        bool is_new = true;
        for (uint32_t i = 0; i < found; i++) is_new &= at[2 * i] != x || at[2 * i + 1] != y;
        at[2 * found] = x;
        at[2 * found + 1] = y;
        found += is_new;
    }
    return found;
}

// Twice the area, by gift wrapping.
static double hull_area(const double *at, uint32_t count)
{
    uint32_t start = 0, from;
    double sum = 0.0;
    for (uint32_t i = 1; i < count; i++)
        if (at[2 * i] < at[2 * start]) start = i;
    from = start;
    do {
        uint32_t to = from == 0 ? 1 : 0;
        for (uint32_t i = 0; i < count; i++)
            if (cross(&at[2 * from], &at[2 * to], &at[2 * i]) < 0.0) to = i;
        sum += at[2 * from] * at[2 * to + 1] - at[2 * from + 1] * at[2 * to];
        // A hull of collinear first points may be closed by another one of the same x.
        from = at[2 * to] == at[2 * start] && at[2 * to + 1] == at[2 * start + 1] ? start : to;
    } while (from != start);
    return sum;
}

static double area_of(const double *at, const struct ort_triangles *triangles)
{
    double sum = 0.0;
    for (uint32_t t = 0; t < triangles->count; t++) {
        const uint32_t *c = triangles->corners[t];
        const double area = cross(&at[2 * c[0]], &at[2 * c[1]], &at[2 * c[2]]);
        CHECK(area > 0.0);
        sum += area;
    }
    return sum;
}

static void check_empty_circles(const double *at, uint32_t count,
                                const struct ort_triangles *triangles)
{
    for (uint32_t t = 0; t < triangles->count; t++) {
        const uint32_t *c = triangles->corners[t];
        for (uint32_t i = 0; i < count; i++)
            CHECK(in_circle(&at[2 * c[0]], &at[2 * c[1]], &at[2 * c[2]], &at[2 * i]) <= 0.0);
    }
}

TEST(delaunay_circles_are_empty_and_triangles_fill_the_hull)
{
    static const uint32_t sides[] = { 8, 30, 200, 1023 }; // in a small square many are cocircular
    double at[2 * MOST];
    for (uint32_t k = 0; k < 12; k++) {
        const uint32_t side = sides[k % 4];
        const uint32_t count = random_points(k, side == 8 ? 40 : 40 + 30 * k, side, at);
        struct ort_triangles triangles;
        CHECK(ort_delaunay(test_host(), at, count, &triangles));
        CHECK_NEAR(area_of(at, &triangles), hull_area(at, count), 0.0);
        check_empty_circles(at, count, &triangles);
        ort_triangles_finish(test_host(), &triangles);
    }
}

TEST(delaunay_triangulates_cocircular_grids_and_circles)
{
    double at[2 * MOST];
    struct ort_triangles triangles;
    for (uint32_t side = 2; side <= 20; side++) {
        for (uint32_t i = 0; i < side * side; i++) {
            at[2 * i] = 7.0 * (i % side) - 100.0;
            at[2 * i + 1] = 7.0 * (i / side) + 3000.0;
        }
        CHECK(ort_delaunay(test_host(), at, side * side, &triangles));
        CHECK(triangles.count == 2 * (side - 1) * (side - 1));
        CHECK_NEAR(area_of(at, &triangles), 2.0 * 49.0 * (side - 1) * (side - 1), 0.0);
        ort_triangles_finish(test_host(), &triangles);
    }
    // All twelve points of x² + y² = 25.
    static const double circle[] = { 5,  0, 4,  3,  3,  4,  0, 5,  -3, 4,  -4, 3,
                                     -5, 0, -4, -3, -3, -4, 0, -5, 3,  -4, 4,  -3 };
    CHECK(ort_delaunay(test_host(), circle, 12, &triangles));
    CHECK(triangles.count == 10);
    CHECK_NEAR(area_of(circle, &triangles), hull_area(circle, 12), 0.0);
    ort_triangles_finish(test_host(), &triangles);
}

TEST(delaunay_is_the_same_at_any_power_of_two_and_place)
{
    double at[2 * MOST], moved[2 * MOST];
    const uint32_t count = random_points(5, 100, 50, at);
    struct ort_triangles first, second;
    CHECK(ort_delaunay(test_host(), at, count, &first));
    for (int exponent = -120; exponent <= 120; exponent += 60) {
        for (uint32_t i = 0; i < 2 * count; i++)
            moved[i] = ldexp(at[i] + (i % 2 ? 1e6 : -3e5), exponent);
        CHECK(ort_delaunay(test_host(), moved, count, &second));
        CHECK(first.count == second.count);
        CHECK(memcmp(first.corners, second.corners, first.count * sizeof *first.corners) == 0);
        ort_triangles_finish(test_host(), &second);
    }
    ort_triangles_finish(test_host(), &first);
}

// Refinement gathers neighbours in the square of all offsets.
TEST(delaunay_takes_neighbouring_integers_in_the_largest_square)
{
    double at[2 * MOST] = { -65535, -65535, 65535, -65535, 65535, 65535, -65535, 65535 };
    struct rng rng = rng_for(8, 0, 0);
    struct ort_triangles triangles;
    for (int k = 0; k < 20; k++) {
        const double x = rng_u32(&rng) % 131000 - 65500.0, y = rng_u32(&rng) % 131000 - 65500.0;
        for (uint32_t i = 4; i < MOST; i++) {
            at[2 * i] = x + i % 20;
            at[2 * i + 1] = y + i / 20;
        }
        CHECK(ort_delaunay(test_host(), at, MOST, &triangles));
        CHECK(triangles.count == 2 * MOST - 2 - 4); // Euler's formula
        CHECK_NEAR(area_of(at, &triangles), 2.0 * 131070.0 * 131070.0, 0.0);
        ort_triangles_finish(test_host(), &triangles);
    }
}

static void check_refused(const double *at, uint32_t count, const char *why)
{
    struct ort_triangles triangles;
    test_forget_messages();
    CHECK(!ort_delaunay(test_host(), at, count, &triangles));
    CHECK(triangles.corners == NULL);
    CHECK(test_host()->failure == FAIL_ARGUMENT);
    CHECK(strstr(test_last_message(), why) != NULL);
}

TEST(delaunay_refuses_points_without_area_and_points_too_close)
{
    double line[2 * MOST];
    for (uint32_t i = 0; i < MOST; i++) line[2 * i] = line[2 * i + 1] = i;
    check_refused(line, 2, "2 points");
    check_refused(line, MOST, "on a line");
    for (uint32_t i = 0; i < MOST; i++) line[2 * i] = 3.0;
    check_refused(line, 3, "on a line");
    const double close[] = { 0, 0, 1, 0, 0, 1, 1, 1, 0.5, 0.5, 0.5, 0.5 + 1e-15 };
    check_refused(close, 6, "too close");
}
