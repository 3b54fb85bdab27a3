// Surfaces: a floor, z = 0 in the sphere's frame with z away from the eye, that rises towards the
// eye from a straight line at the distance a on: z = −slope · (x − a) for x > a, with slopes up to
// a wall's. What is visible of the hemisphere above the floor is estimated with the set as
// src/techniques/vo does it, the set turned many ways.
#include "noise.h"

#include "core/rng.h"

#include <math.h>

enum { TURNS = 128, DISTANCES = 6, SLOPES = 4, EXACT = 400 };

static const double ROUNDING = 1e-6; // a point on the floor

static const double slopes[SLOPES] = { 0.5, 1.0, 2.0, 1e9 };

struct surface {
    double distance, slope;
};

static double depth_at(const struct surface *s, double x)
{
    return x > s->distance ? -s->slope * (x - s->distance) : 0.0;
}

// Of the line through (x, y), the part between the sphere and the surface over the sphere's whole
// extent.
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

// Columns of a turn; the third row is only of use in the ball.
struct turn {
    double m[3][3];
};

static struct turn turn_in_plane(int k)
{
    const double a = 2.0 * 3.14159265358979323846 * k / TURNS;
    return (struct turn){ { { cos(a), -sin(a), 0 }, { sin(a), cos(a), 0 }, { 0, 0, 1 } } };
}

// Uniform over all rotations (Shoemake 1992).
static struct turn turn_in_space(struct rng *rng)
{
    const double two_pi = 2.0 * 3.14159265358979323846;
    const double u = (double)rng_float(rng), a = two_pi * (double)rng_float(rng),
                 b = two_pi * (double)rng_float(rng);
    const double x = sqrt(1 - u) * sin(a), y = sqrt(1 - u) * cos(a), z = sqrt(u) * sin(b),
                 w = sqrt(u) * cos(b);
    return (
        struct turn){ { { 1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w) },
                        { 2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w) },
                        { 2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y) } } };
}

static struct point turned(const struct turn *t, struct point p)
{
    return (struct point){ t->m[0][0] * p.x + t->m[0][1] * p.y + t->m[0][2] * p.z,
                           t->m[1][0] * p.x + t->m[1][1] * p.y + t->m[1][2] * p.z,
                           t->m[2][0] * p.x + t->m[2][1] * p.y + t->m[2][2] * p.z };
}

static double estimate(const struct points *set, const struct voronoi *v, const struct surface *s,
                       const struct turn *t)
{
    double sum = 0.0, all = 0.0;
    for (int i = 0; i < set->count; i++) {
        const struct point p = turned(t, set->at[i]);
        if (set->ball) { // points below the floor are mirrored to above it, those on it are seen
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
        for (int i = 0; i < TURNS; i++) {
            const struct turn t = set->ball ? turn_in_space(&rng) : turn_in_plane(i);
            const double e = estimate(set, v, &s, &t);
            sum += e / TURNS;
            squares += e * e / TURNS;
        }
        const double off = sum - exact(&s);
        variance += fmax(squares - sum * sum, 0.0) / (DISTANCES * SLOPES);
        bias += off * off / (DISTANCES * SLOPES);
    }
    return (struct noise){ sqrt(variance), sqrt(bias) };
}
