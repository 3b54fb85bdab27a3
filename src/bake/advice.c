// The density of a light map whose bake fits in a limit of memory, found by planning it.
#include "bake/bake_state.h"
#include "bake/relay_host.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { TRIES = 8 };
// Densities are rounded to three digits, as users read and type them.
#define DENSITY_FORMAT "%.3g"
static const double NEAR_ENOUGH = 1.03;

static double rounded(double density)
{
    char text[BAKE_TEXT];
    snprintf(text, sizeof text, DENSITY_FORMAT, density);
    return atof(text);
}

// Peak memory at a density; 0: it cannot be planned. Its messages are dropped: they are not about
// the user's own density.
static uint64_t memory_at(const struct bake *bake, double density, int threads)
{
    struct relay_host quiet;
    relay_host_init(&quiet, bake->host, NULL);
    struct bake *other = bake_create(&quiet.host, &bake->identity);
    const bool ok = other && bake->plan.light_map.plan_at(bake_plan_of(other), bake->plan.job.job,
                                                          (float)density);
    const uint64_t bytes = ok ? estimate_peak_memory(other, threads) : 0;
    bake_destroy(other);
    return bytes;
}

struct search {
    double fits, exceeds; // densities; 0: none is known
};

// Memory grows at most as the square of the density: texels are as the square, those at the edges
// of charts linear, and triangles constant.
static double next_density(const struct search *s, double density, double ratio)
{
    double next = density * sqrt(ratio);
    if (s->fits == 0.0) return 0.97 * next;
    const double middle = sqrt(s->fits * s->exceeds);
    if (!(next > s->fits) || !(next < s->exceeds)) next = middle;
    return next;
}

double advised_density(const struct bake *bake, uint64_t needed, uint64_t limit, int threads)
{
    const struct bake_light_map *map = &bake->plan.light_map;
    struct search s = { 0.0, (double)map->texels_per_m };
    if (!map->plan_at || needed <= limit) return 0.0;
    double density = s.exceeds, bytes = (double)needed;
    for (int i = 0; i < TRIES && s.exceeds > NEAR_ENOUGH * s.fits; i++) {
        density = rounded(next_density(&s, density, (double)limit / bytes));
        if (density == s.fits || density == s.exceeds) break;
        bytes = (double)memory_at(bake, density, threads);
        if (!(bytes > 0.0)) break;
        if (bytes <= (double)limit)
            s.fits = density;
        else
            s.exceeds = density;
    }
    return s.fits;
}
