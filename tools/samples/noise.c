// Test surfaces: a floor, z = 0 in the sphere's frame with z away from the camera, that rises
// towards the camera behind a straight edge at distance a: z = −slope · (x − a) for x > a, from
// ramps to walls. The visible part of the hemisphere above the floor is estimated as in
// src/techniques/vo, for many rotations of the set.
#include "noise.h"

#include "core/rng.h"

#include <math.h>

enum { ROTATIONS = 128, DISTANCES = 6, SLOPES = 4, EXACT = 400 };

static const double ROUNDING = 1e-6; // tolerance for points on the floor

static const double slopes[SLOPES] = { 0.5, 1.0, 2.0, 1e9 };

struct surface {
    double distance, slope;
};

static double depth_at(const struct surface *s, double x)
{
    return x > s->distance ? -s->slope * (x - s->distance) : 0.0;
}

// The visible part of the line through (x, y), relative to its length in the sphere.
static double visible_line(const struct surface *s, double x, double y)
{
    const double half = sqrt(fmax(1.0 - x * x - y * y, 1e-12));
    return (fmax(depth_at(s, x), -half) + half) / (2.0 * half);
}

static double exact(const struct surface *s)
{
    double sum = 0.0, all = 0.0;
    for (int j = 0; j < EXACT; j++)
        for (int i = 0; i < EXACT; i++) {
            const double x = (2 * i + 1.0) / EXACT - 1.0, y = (2 * j + 1.0) / EXACT - 1.0;
            if (x * x + y * y >= 1.0) continue;
            const double extent = sqrt(1.0 - x * x - y * y);
            sum += extent * visible_line(s, x, y);
            all += 0.5 * extent;
        }
    return sum / all;
}

// A rotation matrix; the disk uses its first two rows only.
struct rotation {
    double m[3][3];
};

static struct rotation rotation_in_plane(int k)
{
    const double a = 2.0 * 3.14159265358979323846 * k / ROTATIONS;
    return (struct rotation){ { { cos(a), -sin(a), 0 }, { sin(a), cos(a), 0 }, { 0, 0, 1 } } };
}

// Uniform over all rotations (Shoemake 1992).
static struct rotation rotation_in_space(struct rng *rng)
{
    const double two_pi = 2.0 * 3.14159265358979323846;
    const double u = (double)rng_float(rng), a = two_pi * (double)rng_float(rng),
                 b = two_pi * (double)rng_float(rng);
    const double x = sqrt(1 - u) * sin(a), y = sqrt(1 - u) * cos(a), z = sqrt(u) * sin(b),
                 w = sqrt(u) * cos(b);
    return (struct rotation){
        { { 1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w) },
          { 2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w) },
          { 2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y) } }
    };
}

static struct point rotated(const struct rotation *r, struct point p)
{
    return (struct point){ r->m[0][0] * p.x + r->m[0][1] * p.y + r->m[0][2] * p.z,
                           r->m[1][0] * p.x + r->m[1][1] * p.y + r->m[1][2] * p.z,
                           r->m[2][0] * p.x + r->m[2][1] * p.y + r->m[2][2] * p.z };
}

static double estimate(const struct points *set, const struct voronoi *v, const struct surface *s,
                       const struct rotation *r)
{
    double sum = 0.0, all = 0.0;
    for (int i = 0; i < set->count; i++) {
        const struct point p = rotated(r, set->at[i]);
        if (set->ball) { // points below the floor are mirrored; points on it are visible
            sum += -fabs(p.z) <= depth_at(s, p.x) + ROUNDING ? v->weight[i] : 0.0;
            all += v->weight[i];
        } else {
            sum += v->weight[i] * visible_line(s, p.x, p.y);
            all += 0.5 * v->weight[i];
        }
    }
    return sum / all;
}

struct noise noise_of(const struct points *set, const struct voronoi *v)
{
    double variance = 0.0, bias = 0.0;
    for (int k = 0; k < DISTANCES * SLOPES; k++) {
        const struct surface s = { (k / SLOPES) * (0.9 / DISTANCES), slopes[k % SLOPES] };
        struct rng rng = rng_for(0, 0, 0);
        double sum = 0.0, squares = 0.0;
        for (int i = 0; i < ROTATIONS; i++) {
            const struct rotation r = set->ball ? rotation_in_space(&rng) : rotation_in_plane(i);
            const double e = estimate(set, v, &s, &r);
            sum += e / ROTATIONS;
            squares += e * e / ROTATIONS;
        }
        const double error = sum - exact(&s);
        variance += fmax(squares - sum * sum, 0.0) / (DISTANCES * SLOPES);
        bias += error * error / (DISTANCES * SLOPES);
    }
    return (struct noise){ sqrt(variance), sqrt(bias) };
}
