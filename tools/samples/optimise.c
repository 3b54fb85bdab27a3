// Samples repel each other with 1/d⁴; the rim repels them with charge/b⁴, b the distance from the
// rim. A step is accepted only if it reduces the error; otherwise the step size is halved. Between
// rounds the rim's charge is adjusted, so that samples approach the centroids of their regions.
#include "optimise.h"

#include <math.h>

enum { TRIES = 200, ROUNDS = 40, MOVES = 60 };

static const double INNERMOST_RIM = 0.02; // least distance from the rim
static const double STEP_MIN = 1e-6, STEP_MAX = 0.05;

static double length(struct point p)
{
    return sqrt(p.x * p.x + p.y * p.y + p.z * p.z);
}

static struct point scaled(struct point p, double s)
{
    return (struct point){ p.x * s, p.y * s, p.z * s };
}

static struct point sum(struct point a, struct point b)
{
    return (struct point){ a.x + b.x, a.y + b.y, a.z + b.z };
}

// ---- starts

static struct point random_point(bool ball, struct rng *rng)
{
    for (;;) {
        const struct point p = { 2.0 * (double)rng_float(rng) - 1.0,
                                 2.0 * (double)rng_float(rng) - 1.0,
                                 ball ? 2.0 * (double)rng_float(rng) - 1.0 : 0.0 };
        if (length(p) < 1.0 - INNERMOST_RIM) return p;
    }
}

static bool is_free(const struct points *set, struct point p, double min_distance)
{
    for (int i = 0; i < set->count; i++)
        if (length(sum(p, scaled(set->at[i], -1.0))) < min_distance) return false;
    return true;
}

// Dart throwing: the minimum distance shrinks after TRIES failures.
static struct point dart(const struct points *set, bool symmetric, double *min_distance,
                         struct rng *rng)
{
    for (int tries = 0;; tries++) {
        if (tries == TRIES) {
            *min_distance *= 0.9;
            tries = 0;
        }
        const struct point p = random_point(set->ball, rng);
        if (is_free(set, p, *min_distance) && (!symmetric || 2.0 * length(p) >= *min_distance))
            return p;
    }
}

struct points optimise_start(bool ball, int count, enum start start, struct rng *rng)
{
    const bool symmetric = start == START_SYMMETRIC;
    struct points set = { .ball = ball };
    double min_distance = 2.0 * pow(count, ball ? -1.0 / 3.0 : -0.5);
    if (symmetric && count % 2) set.at[set.count++] = (struct point){ 0 };
    while (set.count < count) {
        const struct point p = dart(&set, symmetric, &min_distance, rng);
        set.at[set.count++] = p;
        if (symmetric) set.at[set.count++] = scaled(p, -1.0);
    }
    return set;
}

// ---- forces

static struct point force_on(const struct points *set, int i, double charge)
{
    struct point force = { 0 };
    for (int j = 0; j < set->count; j++) {
        if (j == i) continue;
        const struct point away = sum(set->at[i], scaled(set->at[j], -1.0));
        const double d = fmax(length(away), 1e-6);
        force = sum(force, scaled(away, 1.0 / pow(d, 5)));
    }
    const double r = length(set->at[i]);
    if (r < 1e-9) return force;
    return sum(force, scaled(set->at[i], -charge / (r * pow(1.0 - r, 4))));
}

static struct point inside(struct point p)
{
    const double r = length(p);
    return r > 1.0 - INNERMOST_RIM ? scaled(p, (1.0 - INNERMOST_RIM) / r) : p;
}

// Moves each sample along its force, the one with the largest force by `step`.
static struct points moved(const struct points *set, double charge, double step)
{
    struct point forces[MAX_SAMPLES];
    double largest = 0.0;
    for (int i = 0; i < set->count; i++) {
        forces[i] = force_on(set, i, charge);
        largest = fmax(largest, length(forces[i]));
    }
    struct points to = *set;
    for (int i = 0; i < set->count && largest > 0.0; i++)
        to.at[i] = inside(sum(set->at[i], scaled(forces[i], step / largest)));
    return to;
}

// Mean of the radius of the samples minus the radius of their regions' centroids.
static double mean_excess_radius(const struct points *set, const struct voronoi *v)
{
    double mean = 0.0;
    for (int i = 0; i < set->count; i++) mean += length(set->at[i]) - length(v->centroid[i]);
    return mean / set->count;
}

static double repel(struct points *set, const struct grid *grid, double charge, double error)
{
    double step = STEP_MAX;
    for (int i = 0; i < MOVES && step > STEP_MIN; i++) {
        const struct points to = moved(set, charge, step);
        const struct voronoi v = voronoi_of(&to, grid);
        const double e = voronoi_error(&to, &v);
        if (e < error) {
            *set = to;
            error = e;
            step = fmin(step * 1.5, STEP_MAX);
        } else {
            step *= 0.5;
        }
    }
    return error;
}

double optimise(struct points *set, const struct grid *grid)
{
    // Initially the rim repels like the mirror image of a neighbour.
    double charge = 1.0 / 16.0, factor = 2.0;
    struct voronoi v = voronoi_of(set, grid);
    double error = INFINITY;
    bool inwards = false;
    for (int round = 0; round < ROUNDS && factor > 1.001; round++) {
        if (round == 0) error = voronoi_error(set, &v);
        error = repel(set, grid, charge, error);
        v = voronoi_of(set, grid);
        const bool now_inwards = mean_excess_radius(set, &v) < 0.0;
        if (round > 0 && now_inwards != inwards) factor = sqrt(factor);
        inwards = now_inwards;
        charge *= inwards ? 1.0 / factor : factor;
    }
    return error;
}
