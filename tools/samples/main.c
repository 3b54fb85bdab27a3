// Generates the sample tables that src/techniques/common/sample_sets.c includes:
//
//     make_samples disk > src/techniques/common/sample_sets_disk.inc
//     make_samples ball > src/techniques/common/sample_sets_ball.inc
//
// Optimises many random starts, scales each by several factors, and keeps the set with the least
// noise and bias under rotation. All sets are symmetric about their centre, so that a plane through
// the centre of any slope is exactly half visible. The same seed gives the same tables.
#include "noise.h"
#include "optimise.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum {
    STARTS = 48,
    COARSE_DISK = 96,
    COARSE_BALL = 24,
    FINE_DISK = 512,
    FINE_BALL = 128,
    CHECK_DISK = 192,
    CHECK_BALL = 40
};

static const int counts[] = { 1, 5, 6, 7, 9, 12, 13, 16, 33 };
enum { COUNTS = sizeof counts / sizeof counts[0] };

static const double RIM = 0.97; // largest radius: beyond it a line sample has almost no length
static const double SPREAD_MIN = 0.9, SPREAD_MAX = 1.4, SPREAD_STEP = 0.025;

struct choice {
    struct points set;
    double error; // before spreading
    double spread;
    int start;
    struct noise noise;
    double total;
};

static struct points spread_by(const struct points *set, double factor, double *reach)
{
    struct points out = *set;
    *reach = 0.0;
    for (int i = 0; i < out.count; i++) {
        struct point *p = &out.at[i];
        *p = (struct point){ p->x * factor, p->y * factor, p->z * factor };
        *reach = fmax(*reach, sqrt(p->x * p->x + p->y * p->y + p->z * p->z));
    }
    return out;
}

static void consider(struct choice *best, const struct points *set, double error, int start,
                     const struct grid *grid)
{
    for (double spread = SPREAD_MIN; spread < SPREAD_MAX; spread += SPREAD_STEP) {
        double reach;
        struct choice c = {
            .set = spread_by(set, spread, &reach), .error = error, .spread = spread, .start = start
        };
        if (reach > RIM) return;
        const struct voronoi v = voronoi_of(&c.set, grid);
        c.noise = noise_of(&c.set, &v);
        c.total = hypot(c.noise.deviation, c.noise.bias);
        if (c.total < best->total) *best = c;
    }
}

// A single sample stands off-centre: a line through the centre would meet any surface at the
// centre. It needs no repulsion.
static struct points single(bool ball)
{
    return (struct points){ .ball = ball, .count = 1, .at = { { 0.5, 0.0, 0.0 } } };
}

static struct choice choose(bool ball, int count, uint32_t seed, const struct grid *coarse,
                            const struct grid *check)
{
    struct choice best = { .total = INFINITY };
    for (int start = 0; start < (count > 1 ? STARTS : 1); start++) {
        struct rng rng = rng_for((uint32_t)start, (uint32_t)count, seed);
        struct points set =
            count > 1 ? optimise_start(ball, count, START_SYMMETRIC, &rng) : single(ball);
        const double error = count > 1 ? optimise(&set, coarse) : 0.0;
        consider(&best, &set, error, start, check);
    }
    return best;
}

static void print_set(const struct choice *c, const struct grid *fine, uint32_t seed)
{
    const struct points *set = &c->set;
    const char *shape = set->ball ? "ball" : "disk";
    const struct voronoi v = voronoi_of(set, fine);
    printf("\n// %d: seed %u, start %d, error %.4f, spread %.3f, noise %.4f, bias %.4f\n",
           set->count, seed, c->start, c->error, c->spread, c->noise.deviation, c->noise.bias);
    printf("static const struct sample %s_%d[] = {\n", shape, set->count);
    for (int i = 0; i < set->count; i++) {
        const struct point p = set->at[i];
        const double z = set->ball ? p.z : sqrt(1.0 - p.x * p.x - p.y * p.y);
        printf("    { %.8ff, %.8ff, %.8ff, %.8ff, %.8ff },\n", p.x, p.y, z, v.weight[i],
               v.share[i]);
    }
    printf("};\n");
}

static void print_index(bool ball, const struct choice *choices)
{
    const char *shape = ball ? "ball" : "disk";
    printf("\nstatic const struct sample_set %s_sets[] = {\n", shape);
    for (int i = 0; i < COUNTS; i++)
        printf("    { %d, %s_%d, %.6ff, %.6ff },\n", counts[i], shape, counts[i],
               choices[i].noise.deviation, choices[i].noise.bias);
    printf("};\n");
}

static bool make(bool ball, uint32_t seed)
{
    struct grid coarse = { 0 }, check = { 0 }, fine = { 0 };
    struct choice choices[COUNTS];
    const bool ok = grid_init(&coarse, ball, ball ? COARSE_BALL : COARSE_DISK) &&
                    grid_init(&check, ball, ball ? CHECK_BALL : CHECK_DISK) &&
                    grid_init(&fine, ball, ball ? FINE_BALL : FINE_DISK);
    if (ok)
        printf("// Made by tools/samples (make_samples %s %u); sample_sets.h says what the columns "
               "are.\n",
               ball ? "ball" : "disk", seed);
    for (int i = 0; i < COUNTS && ok; i++) {
        choices[i] = choose(ball, counts[i], seed, &coarse, &check);
        print_set(&choices[i], &fine, seed);
        fprintf(stderr, "%s %d: noise %.4f, bias %.4f\n", ball ? "ball" : "disk", counts[i],
                choices[i].noise.deviation, choices[i].noise.bias);
    }
    if (ok) print_index(ball, choices);
    grid_finish(&coarse);
    grid_finish(&check);
    grid_finish(&fine);
    return ok;
}

int main(int argc, char **argv)
{
    const bool known = argc >= 2 && (strcmp(argv[1], "disk") == 0 || strcmp(argv[1], "ball") == 0);
    if (!known || argc > 3) {
        fprintf(stderr, "usage: make_samples disk|ball [SEED]\n");
        return 2;
    }
    const uint32_t seed = argc == 3 ? (uint32_t)strtoul(argv[2], NULL, 10) : 1;
    if (make(strcmp(argv[1], "ball") == 0, seed)) return 0;
    fprintf(stderr, "make_samples: out of memory\n");
    return 1;
}
