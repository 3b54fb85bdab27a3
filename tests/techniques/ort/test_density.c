// The density against closed forms, and its samples against exact integrals of cells.
#include "framework/test.h"

#include "api/counting_allocator.h"
#include "core/parallel.h"
#include "techniques/ort/bake/density.h"

#include <float.h>
#include <math.h>
#include <string.h>

enum { MOST = 400, SAMPLES = 200000, CELLS = 16 };

static struct ort_density density_of(const struct ort_point *points, uint32_t count)
{
    struct ort_density density;
    CHECK(ort_density_init(&density, test_host(), points, count));
    return density;
}

static double last_sum(const struct ort_density *density)
{
    return density->sums[3 * density->triangles.count - 1];
}

// ---- sets of points in the square −10…10

static float random_place(struct rng *rng)
{
    return 20.0f * rng_float(rng) - 10.0f;
}

// The corners alone: two triangles with one value of 0.
static uint32_t four_corners(struct ort_point *out)
{
    const struct ort_point corners[] = {
        { -10, -10, 0 }, { 10, -10, 1 }, { -10, 10, 2 }, { 10, 10, 7 }
    };
    memcpy(out, corners, sizeof corners);
    return 4;
}

// A regular grid with a narrow peak beside the center.
static uint32_t peaked_grid(struct ort_point *out)
{
    for (int i = 0; i < 100; i++) {
        const float x = (float)(i % 10) * 20.0f / 9.0f - 10.0f;
        const float y = (float)(i / 10) * 20.0f / 9.0f - 10.0f;
        out[i] = (struct ort_point){ x, y, expf(-0.1f * ((x - 2) * (x - 2) + y * y)) };
    }
    return 100;
}

// Corners and random points, with values over five orders of magnitude.
static uint32_t scattered(struct ort_point *out)
{
    struct rng rng = rng_for(11, 0, 0);
    four_corners(out);
    for (uint32_t i = 4; i < 200; i++) {
        const float x = random_place(&rng), y = random_place(&rng);
        out[i] = (struct ort_point){ x, y, powf(10.0f, 5.0f * rng_float(&rng) - 5.0f) };
    }
    return 200;
}

static uint32_t all_zero(struct ort_point *out)
{
    const uint32_t count = scattered(out);
    for (uint32_t i = 0; i < count; i++) out[i].value = 0.0f;
    return count;
}

// ---- interpolation

TEST(density_is_exact_at_data_points)
{
    struct ort_point points[MOST];
    const uint32_t counts[] = { four_corners(points), peaked_grid(points), scattered(points) };
    for (int set = 0; set < 3; set++) {
        if (set == 0) four_corners(points);
        if (set == 1) peaked_grid(points);
        if (set == 2) scattered(points);
        struct ort_density density = density_of(points, counts[set]);
        for (uint32_t i = 0; i < counts[set]; i++)
            CHECK(ort_density_at(&density, points[i].x, points[i].y) == points[i].value);
        ort_density_finish(&density);
    }
}

static float linear(float x, float y)
{
    return 30.0f + 2.0f * x - 0.5f * y;
}

TEST(density_is_exact_for_linear_functions_and_0_outside)
{
    struct ort_point points[MOST];
    struct rng rng = rng_for(12, 0, 0);
    const uint32_t count = scattered(points);
    for (uint32_t i = 0; i < count; i++) points[i].value = linear(points[i].x, points[i].y);
    struct ort_density density = density_of(points, count);
    for (int i = 0; i < 5000; i++) {
        const float x = random_place(&rng), y = random_place(&rng);
        CHECK_RELATIVE(ort_density_at(&density, x, y), linear(x, y), 1e-5);
    }
    CHECK(ort_density_at(&density, 10.001f, 0.0f) == 0.0f);
    CHECK(ort_density_at(&density, 0.0f, -10.001f) == 0.0f);
    CHECK_RELATIVE(density.integral, 400.0 * 30.0, 1e-6); // the mean is that of the center
    CHECK_RELATIVE(last_sum(&density), 400.0 * 30.0, 1e-6);
    ort_density_finish(&density);
}

// The linear function of a triangle: value = at[0] + at[1] x + at[2] y.
static void plane_of(const struct ort_density *density, const uint32_t corner[3], double at[3])
{
    const struct ort_point *p = &density->points[corner[0]];
    double d[2][3];
    for (int k = 0; k < 2; k++) {
        const struct ort_point *q = &density->points[corner[k + 1]];
        d[k][0] = (double)q->x - (double)p->x;
        d[k][1] = (double)q->y - (double)p->y;
        d[k][2] = (double)q->value - (double)p->value;
    }
    const double area = d[0][0] * d[1][1] - d[0][1] * d[1][0];
    at[1] = (d[0][2] * d[1][1] - d[0][1] * d[1][2]) / area;
    at[2] = (d[0][0] * d[1][2] - d[0][2] * d[1][0]) / area;
    at[0] = (double)p->value - at[1] * (double)p->x - at[2] * (double)p->y;
}

static double steepest(const struct ort_density *density)
{
    double most = 0.0;
    for (uint32_t t = 0; t < density->triangles.count; t++) {
        double plane[3];
        plane_of(density, density->triangles.corners[t], plane);
        most = fmax(most, hypot(plane[1], plane[2]));
    }
    return most;
}

// Along lines, a step changes it by at most its length times the steepest gradient.
TEST(density_is_continuous_across_edges)
{
    struct ort_point points[MOST];
    struct rng rng = rng_for(13, 0, 0);
    struct ort_density density = density_of(points, peaked_grid(points));
    const double most = steepest(&density) * 1.02e-4 + 1e-6;
    CHECK(most < 1e-4);
    for (int line = 0; line < 20; line++) {
        const float y = 0.95f * random_place(&rng), x = 0.95f * random_place(&rng);
        float before = ort_density_at(&density, x, y);
        for (int i = 1; i <= 5000; i++) {
            const float value = ort_density_at(&density, x + (float)i * 1e-4f, y);
            CHECK_NEAR(value, before, most);
            before = value;
        }
    }
    ort_density_finish(&density);
}

// ---- volumes

TEST(density_integral_of_a_cone_and_a_prism_are_closed_forms)
{
    struct ort_point cone[] = { { 0, 0, 0 }, { 4, 0, 0 }, { 4, 3, 0 }, { 0, 3, 0 }, { 2, 1, 5 } };
    struct ort_density density = density_of(cone, 5);
    CHECK(density.triangles.count == 4);
    CHECK_RELATIVE(density.integral, 12.0 * 5.0 / 3.0, 1e-6);
    ort_density_finish(&density);
    for (int i = 0; i < 5; i++) cone[i].value = 2.5f;
    density = density_of(cone, 5);
    CHECK_RELATIVE(density.integral, 12.0 * 2.5, 1e-6);
    ort_density_finish(&density);
}

static double volume(double v[4][3])
{
    double e[3][3];
    for (int i = 0; i < 3; i++)
        for (int a = 0; a < 3; a++) e[i][a] = v[i + 1][a] - v[0][a];
    return fabs(e[0][0] * (e[1][1] * e[2][2] - e[1][2] * e[2][1]) -
                e[0][1] * (e[1][0] * e[2][2] - e[1][2] * e[2][0]) +
                e[0][2] * (e[1][0] * e[2][1] - e[1][1] * e[2][0])) /
           6.0;
}

// Tetrahedron k: corner k at height 0 and at its value, those before at their value, those after at
// height 0.
static double stacked_volume(const struct ort_density *density, const uint32_t corner[3], int k)
{
    double v[4][3];
    for (int i = 0; i < 4; i++) {
        const struct ort_point *p = &density->points[corner[i == 3 ? k : i]];
        v[i][0] = (double)p->x;
        v[i][1] = (double)p->y;
        v[i][2] = i < k || i == 3 ? (double)p->value : 0.0;
    }
    return volume(v);
}

TEST(density_tetrahedra_are_stacked_prisms_and_sum_to_the_integral)
{
    struct ort_point points[MOST];
    struct ort_density density = density_of(points, scattered(points));
    double before = 0.0, sum = 0.0, prisms = 0.0;
    for (uint32_t t = 0; t < density.triangles.count; t++) {
        const uint32_t *corner = density.triangles.corners[t];
        const struct ort_point *a = &density.points[corner[0]], *b = &density.points[corner[1]],
                               *c = &density.points[corner[2]];
        for (int k = 0; k < 3; k++) {
            const double one = density.sums[3 * t + (uint32_t)k] - before;
            CHECK_NEAR(one, stacked_volume(&density, corner, k), 1e-11 * density.integral);
            before = density.sums[3 * t + (uint32_t)k];
            sum += one;
        }
        const double area = 0.5 * (((double)b->x - (double)a->x) * ((double)c->y - (double)a->y) -
                                   ((double)b->y - (double)a->y) * ((double)c->x - (double)a->x));
        CHECK(area > 0.0);
        prisms += area * ((double)a->value + (double)b->value + (double)c->value) / 3.0;
    }
    CHECK_RELATIVE(sum, density.integral, 1e-6);
    CHECK_RELATIVE(prisms, density.integral, 1e-6);
    ort_density_finish(&density);
}

// ---- samples

struct polygon {
    double at[16][2];
    int count;
};

// The part where at[axis] is at most, or at least, `bound`.
static struct polygon clip(const struct polygon *from, int axis, double bound, double sign)
{
    struct polygon out = { .count = 0 };
    for (int i = 0; i < from->count; i++) {
        const double *p = from->at[i], *q = from->at[(i + 1) % from->count];
        const double dp = sign * (bound - p[axis]), dq = sign * (bound - q[axis]);
        if (dp >= 0.0) memcpy(out.at[out.count++], p, sizeof out.at[0]);
        if ((dp >= 0.0) == (dq >= 0.0)) continue;
        for (int a = 0; a < 2; a++) out.at[out.count][a] = p[a] + dp / (dp - dq) * (q[a] - p[a]);
        out.count++;
    }
    return out;
}

static double integral_over(const struct polygon *polygon, const double plane[3])
{
    double sum = 0.0;
    for (int i = 1; i + 1 < polygon->count; i++) {
        const double *p = polygon->at[0], *q = polygon->at[i], *r = polygon->at[i + 1];
        const double area =
            0.5 * fabs((q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]));
        sum += area * (plane[0] +
                       (plane[1] * (p[0] + q[0] + r[0]) + plane[2] * (p[1] + q[1] + r[1])) / 3.0);
    }
    return sum;
}

// Exact integrals over CELLS × CELLS cells of the square −10…10; of 1 where the density is 0.
static void integrate_cells(const struct ort_density *density, double *cells)
{
    memset(cells, 0, CELLS * CELLS * sizeof *cells);
    for (uint32_t t = 0; t < density->triangles.count; t++) {
        const uint32_t *corner = density->triangles.corners[t];
        struct polygon triangle = { .count = 3 };
        double plane[3] = { 1.0, 0.0, 0.0 };
        if (density->integral > 0.0) plane_of(density, corner, plane);
        for (int k = 0; k < 3; k++) {
            triangle.at[k][0] = (double)density->points[corner[k]].x;
            triangle.at[k][1] = (double)density->points[corner[k]].y;
        }
        for (int i = 0; i < CELLS * CELLS; i++) {
            const double x = i % CELLS * 20.0 / CELLS - 10.0, y = i / CELLS * 20.0 / CELLS - 10.0;
            struct polygon part = clip(&triangle, 0, x, -1.0);
            part = clip(&part, 0, x + 20.0 / CELLS, 1.0);
            part = clip(&part, 1, y, -1.0);
            part = clip(&part, 1, y + 20.0 / CELLS, 1.0);
            cells[i] += integral_over(&part, plane);
        }
    }
}

// The χ² that a sum of `freedom` squares exceeds with the probability of `deviations` of a normal
// distribution (Wilson & Hilferty 1931).
static double chi_square_quantile(double freedom, double deviations)
{
    const double share = 2.0 / (9.0 * freedom);
    return freedom * pow(1.0 - share + deviations * sqrt(share), 3.0);
}

static void check_counts(const int *counts, const double *cells, double total)
{
    double sum = 0.0, freedom = -1.0, rare = 0.0;
    int rare_count = 0;
    for (int i = 0; i < CELLS * CELLS; i++) {
        const double expected = SAMPLES * cells[i] / total;
        if (expected < 10.0) { // too few for χ²: one bin has them all
            rare += expected;
            rare_count += counts[i];
            continue;
        }
        sum += (counts[i] - expected) * (counts[i] - expected) / expected;
        freedom += 1.0;
    }
    if (rare >= 10.0) {
        sum += (rare_count - rare) * (rare_count - rare) / rare;
        freedom += 1.0;
    } else
        CHECK(rare_count <= 40);
    if (getenv("AFTERGLOW_TEST_VERBOSE"))
        print_message("chi-square %.1f, %.0f degrees of freedom, %.1f to %.1f\n", sum, freedom,
                      chi_square_quantile(freedom, -4.0), chi_square_quantile(freedom, 4.0));
    // Fewer than one run in 30 000 is outside.
    CHECK(sum > chi_square_quantile(freedom, -4.0) && sum < chi_square_quantile(freedom, 4.0));
}

static void check_samples(const struct ort_density *density, uint32_t seed)
{
    static double cells[CELLS * CELLS];
    int counts[CELLS * CELLS] = { 0 };
    double total = 0.0;
    struct rng rng = rng_for(seed, 1, 2);
    integrate_cells(density, cells);
    for (int i = 0; i < CELLS * CELLS; i++) total += cells[i];
    CHECK_RELATIVE(total, last_sum(density), 1e-9);
    for (int i = 0; i < SAMPLES; i++) {
        float at[2];
        ort_density_sample(density, &rng, at);
        const int x = (int)((at[0] + 10.0f) / 20.0f * CELLS);
        const int y = (int)((at[1] + 10.0f) / 20.0f * CELLS);
        CHECK(x >= 0 && y >= 0 && x <= CELLS && y <= CELLS);
        counts[(y == CELLS ? CELLS - 1 : y) * CELLS + (x == CELLS ? CELLS - 1 : x)]++;
    }
    check_counts(counts, cells, total);
}

TEST(density_samples_match_exact_integrals_of_cells)
{
    uint32_t (*const sets[])(struct ort_point *) = { four_corners, peaked_grid, scattered,
                                                     all_zero };
    struct ort_point points[MOST];
    for (uint32_t set = 0; set < 4; set++) {
        struct ort_density density = density_of(points, sets[set](points));
        for (uint32_t seed = 0; seed < 3; seed++) check_samples(&density, 10 * set + seed);
        ort_density_finish(&density);
    }
}

TEST(density_of_zeros_is_zero_and_samples_uniformly)
{
    struct ort_point points[MOST];
    struct ort_density density = density_of(points, all_zero(points));
    CHECK(density.integral == 0.0);
    CHECK(ort_density_at(&density, 1.0f, 2.0f) == 0.0f);
    CHECK_RELATIVE(last_sum(&density), 400.0, 1e-6);
    ort_density_finish(&density);
}

// Only the triangles at (3, 1), the last point, have any volume.
TEST(density_samples_lie_in_triangles_with_volume)
{
    const struct ort_point points[] = { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 1, 1, 0 },
                                        { 3, 0, 0 }, { 3, 1, 1 }, { 2, 0, 0 }, { 2, 1, 0 } };
    struct ort_density density = density_of(points, 8);
    struct rng rng = rng_for(4, 5, 6);
    for (int i = 0; i < 20000; i++) {
        float at[2];
        ort_density_sample(&density, &rng, at);
        CHECK(at[0] >= 2.0f && at[0] <= 3.0f && at[1] >= 0.0f && at[1] <= 1.0f);
    }
    ort_density_finish(&density);
}

// ---- extremes

TEST(density_ignores_the_order_of_points_and_averages_coincident_ones)
{
    struct ort_point points[2 * MOST], reversed[2 * MOST];
    uint32_t count = scattered(points);
    for (uint32_t i = 0; i < 50; i++) {
        points[count] = points[3 * i];
        points[count++].value += 1.0f;
    }
    points[count++] = (struct ort_point){ 0.0f, 0.5f, 1.0f };
    points[count++] = (struct ort_point){ -0.0f, 0.5f, 4.0f };
    for (uint32_t i = 0; i < count; i++) reversed[i] = points[count - 1 - i];
    struct ort_density a = density_of(points, count), b = density_of(reversed, count);
    CHECK(a.point_count == 201 && b.point_count == 201);
    CHECK(a.triangles.count == b.triangles.count);
    CHECK(memcmp(a.triangles.corners, b.triangles.corners,
                 a.triangles.count * sizeof *a.triangles.corners) == 0);
    CHECK(memcmp(a.sums, b.sums, 3 * a.triangles.count * sizeof *a.sums) == 0);
    CHECK(ort_density_at(&a, 0.0f, 0.5f) == 2.5f);
    CHECK_RELATIVE(ort_density_at(&a, points[3].x, points[3].y), points[3].value + 0.5f, 1e-6);
    ort_density_finish(&a);
    ort_density_finish(&b);
}

struct copies {
    struct ort_point points[MOST];
    uint32_t count;
    struct ort_density densities[16];
    float samples[16][100][2];
};

static void make_copy(void *user, size_t i)
{
    struct copies *copies = user;
    static struct host host;
    struct rng rng = rng_for(1, 2, 3);
    ort_density_init(&copies->densities[i], &host, copies->points, copies->count);
    for (int k = 0; k < 100; k++)
        ort_density_sample(&copies->densities[i], &rng, copies->samples[i][k]);
}

TEST(density_is_the_same_on_any_thread)
{
    static struct copies copies;
    copies.count = scattered(copies.points);
    parallel_for_on(4, 16, 1, make_copy, &copies);
    const struct ort_density *first = &copies.densities[0];
    for (int i = 0; i < 16; i++) {
        const struct ort_density *density = &copies.densities[i];
        CHECK(density->triangles.count == first->triangles.count);
        CHECK(memcmp(density->triangles.corners, first->triangles.corners,
                     first->triangles.count * sizeof *first->triangles.corners) == 0);
        CHECK(memcmp(density->sums, first->sums,
                     3 * first->triangles.count * sizeof *first->sums) == 0);
        CHECK(memcmp(copies.samples[i], copies.samples[0], sizeof copies.samples[0]) == 0);
    }
    for (int i = 0; i < 16; i++) ort_density_finish(&copies.densities[i]);
}

TEST(density_takes_huge_and_tiny_values_and_places)
{
    static const float values[] = { FLT_MAX, FLT_TRUE_MIN, 1.0f };
    static const float scales[] = { 1.0f, 1e30f, 1e-30f };
    for (int i = 0; i < 9; i++) {
        const float v = values[i % 3], s = scales[i / 3];
        const struct ort_point points[] = { { 0, 0, v }, { s, 0, v }, { 0, s, v }, { s, s, v } };
        struct ort_density density = density_of(points, 4);
        CHECK_RELATIVE(density.integral, (double)v * (double)s * (double)s, 1e-6);
        CHECK_RELATIVE(ort_density_at(&density, 0.25f * s, 0.5f * s), v, 1e-6);
        struct rng rng = rng_for(1, 1, 1);
        for (int k = 0; k < 100; k++) {
            float at[2];
            ort_density_sample(&density, &rng, at);
            CHECK(at[0] >= 0.0f && at[0] <= s && at[1] >= 0.0f && at[1] <= s);
        }
        ort_density_finish(&density);
    }
}

static void check_refused(struct ort_point odd, uint32_t count, const char *why)
{
    const struct ort_point points[] = { { 0, 0, 1 }, { 1, 0, 1 }, { 0, 1, 1 }, odd };
    struct ort_density density;
    test_forget_messages();
    CHECK(!ort_density_init(&density, test_host(), &points[4 - count], count));
    CHECK(density.host == NULL && density.points == NULL);
    CHECK(test_host()->failure == FAIL_ARGUMENT);
    CHECK(strstr(test_last_message(), why) != NULL);
}

TEST(density_refuses_what_is_no_number_negative_or_without_area)
{
    check_refused((struct ort_point){ 1, 1, NAN }, 4, "data point 3");
    check_refused((struct ort_point){ 1, 1, INFINITY }, 4, "data point 3");
    check_refused((struct ort_point){ 1, 1, -1e-30f }, 4, "at least 0");
    check_refused((struct ort_point){ NAN, 1, 1 }, 4, "data point 3");
    check_refused((struct ort_point){ 1, -INFINITY, 1 }, 4, "data point 3");
    check_refused((struct ort_point){ 1, 1, 1 }, 2, "2 points");
    check_refused((struct ort_point){ 1, 1, 1 }, 0, "0 points");
    check_refused((struct ort_point){ -1, 2, 1 }, 3, "on a line");
    check_refused((struct ort_point){ 0, 1, 1 }, 3, "2 points"); // two of the three coincide
}

TEST(density_fails_cleanly_without_memory)
{
    struct ort_point points[MOST];
    const uint32_t count = scattered(points);
    for (long i = 1; i < 20; i++) {
        struct counting_allocator allocator = { .refuse_at = i };
        struct host host = { .reallocate = counting_reallocate, .user = &allocator };
        struct ort_density density;
        const bool ok = ort_density_init(&density, &host, points, count);
        CHECK(ok == (allocator.asked < i));
        CHECK(ok || host.failure == FAIL_MEMORY);
        ort_density_finish(&density);
        CHECK(allocator.blocks == 0);
        if (ok) return;
    }
    CHECK(false);
}
