#include "techniques/ort/bake/offsets.h"

#include "techniques/ort/bake/density.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>

enum {
    SEEDS = 100,
    SEEDS_MOST_SIDE = 50, // columns or rows of the grid of seeds
    RINGS = 16,           // around 0, of 8 seeds each
    NEAR_SEEDS = 1 + 8 * RINGS,
    BATCH = 20,
    DRAWS_PER_REFINEMENT = 16,
    DRAWS_PER_OFFSET = 64,
};

struct chooser {
    struct host *host;
    const struct ort_offsets_wish *wish;
    struct rng rng;
    struct ort_point *points; // data points of the importance
    uint32_t point_count;
    struct ort_offset *batch; // of which the importance is asked
    float *importance;        // of the batch
    uint32_t batch_count;
    struct ort_offset_set known; // all data points
};

uint64_t ort_offset_most(uint32_t width, uint32_t height)
{
    return (2 * (uint64_t)width - 1) * (2 * (uint64_t)height - 1);
}

static int32_t last_x(const struct ort_offsets_wish *wish)
{
    return (int32_t)wish->width - 1;
}

static int32_t last_y(const struct ort_offsets_wish *wish)
{
    return (int32_t)wish->height - 1;
}

// ---- importance

// Asks for the importance of the batch, which becomes data points.
static bool measure_batch(struct chooser *chooser)
{
    const struct ort_offsets_wish *wish = chooser->wish;
    if (chooser->batch_count == 0) return true;
    if (!wish->importance(wish->user, chooser->batch, chooser->batch_count, chooser->importance))
        return false;
    for (uint32_t i = 0; i < chooser->batch_count; i++)
        chooser->points[chooser->point_count++] =
            (struct ort_point){ .x = (float)chooser->batch[i].x,
                                .y = (float)chooser->batch[i].y,
                                .value = chooser->importance[i] };
    chooser->batch_count = 0;
    return true;
}

static bool add_to_batch(struct chooser *chooser, struct ort_offset offset)
{
    if (!ort_offset_set_add(&chooser->known, offset)) return false;
    chooser->batch[chooser->batch_count++] = offset;
    return true;
}

// Columns and rows of the grid of seeds: at least 2, cells about square.
static void seed_grid(const struct ort_offsets_wish *wish, uint32_t sides[2])
{
    const double width = 2.0 * (double)wish->width - 1.0, height = 2.0 * (double)wish->height - 1.0;
    const double columns = round(sqrt(SEEDS * width / height));
    sides[0] = (uint32_t)fmin(fmax(columns, 2.0), fmin(width, SEEDS_MOST_SIDE));
    sides[1] = (uint32_t)fmin(fmax(round(SEEDS / (double)sides[0]), 2.0), height);
}

// Place i of `count` from −last to last, both included.
static int32_t seed_place(int32_t last, uint32_t i, uint32_t count)
{
    return (int32_t)lround(2.0 * last * i / (count - 1.0)) - last;
}

static bool is_in_square(const struct ort_offsets_wish *wish, struct ort_offset offset)
{
    return abs(offset.x) <= last_x(wish) && abs(offset.y) <= last_y(wish);
}

// 0, and eight offsets at each power of two: transfer between neighbours is the strongest, and a
// peak there, as that of subsurface scattering, may lie between the seeds of the grid.
static void add_near_seeds(struct chooser *chooser)
{
    static const int32_t AROUND[8][2] = { { 1, 0 },  { 1, 1 },   { 0, 1 },  { -1, 1 },
                                          { -1, 0 }, { -1, -1 }, { 0, -1 }, { 1, -1 } };
    add_to_batch(chooser, (struct ort_offset){ 0, 0 });
    for (int ring = 0; ring < RINGS; ring++)
        for (int k = 0; k < 8; k++) {
            const struct ort_offset offset = { AROUND[k][0] * (1 << ring),
                                               AROUND[k][1] * (1 << ring) };
            if (is_in_square(chooser->wish, offset)) add_to_batch(chooser, offset);
        }
}

static bool measure_seeds(struct chooser *chooser, const uint32_t sides[2])
{
    add_near_seeds(chooser);
    for (uint32_t y = 0; y < sides[1]; y++)
        for (uint32_t x = 0; x < sides[0]; x++)
            add_to_batch(chooser,
                         (struct ort_offset){ seed_place(last_x(chooser->wish), x, sides[0]),
                                              seed_place(last_y(chooser->wish), y, sides[1]) });
    return measure_batch(chooser);
}

static struct ort_offset draw(struct chooser *chooser, const struct ort_density *density)
{
    float at[2];
    ort_density_sample(density, &chooser->rng, at);
    return (struct ort_offset){ (int32_t)lroundf(at[0]), (int32_t)lroundf(at[1]) };
}

// One batch from the density of the points so far. Known offsets are drawn again, a few times.
static bool refine(struct chooser *chooser)
{
    struct ort_density density;
    if (!ort_density_init(&density, chooser->host, chooser->points, chooser->point_count))
        return false;
    for (int i = 0; i < BATCH; i++)
        for (int k = 0; k < DRAWS_PER_REFINEMENT; k++)
            if (add_to_batch(chooser, draw(chooser, &density))) break;
    ort_density_finish(&density);
    return measure_batch(chooser);
}

static bool find_importance(struct chooser *chooser)
{
    uint32_t sides[2];
    seed_grid(chooser->wish, sides);
    const size_t refinements = chooser->wish->refinements;
    const size_t seeds = (size_t)sides[0] * sides[1] + NEAR_SEEDS, points = seeds + refinements;
    const size_t batch = seeds > BATCH ? seeds : BATCH;
    chooser->points = host_alloc(chooser->host, points, sizeof *chooser->points);
    chooser->batch = host_alloc(chooser->host, batch, sizeof *chooser->batch);
    chooser->importance = host_alloc(chooser->host, batch, sizeof *chooser->importance);
    if (!chooser->points || !chooser->batch || !chooser->importance) return false;
    if (!ort_offset_set_init(&chooser->known, chooser->host, points)) return false;
    if (!measure_seeds(chooser, sides)) return false;
    for (size_t i = 0; i < refinements / BATCH; i++)
        if (!refine(chooser)) return false;
    return true;
}

// ---- choice

// Draws until there are `count`, at most DRAWS_PER_OFFSET times as often. Returns how many were
// found: fewer where the density is concentrated in a few texels.
static uint32_t draw_offsets(struct chooser *chooser, const struct ort_density *density,
                             struct ort_offset_set *chosen, uint32_t count, struct ort_offset *out)
{
    uint32_t found = 0;
    for (uint64_t i = 0; i < (uint64_t)count * DRAWS_PER_OFFSET && found < count; i++) {
        const struct ort_offset offset = draw(chooser, density);
        if (ort_offset_set_add(chosen, offset)) out[found++] = offset;
    }
    return found;
}

// Fills up from `found` to `count` with offsets of which all unused ones are equally likely: one
// pass over the square (Knuth 1997, section 3.4.2, algorithm S).
static void fill_up(struct chooser *chooser, const struct ort_offset_set *chosen, uint32_t found,
                    uint32_t count, struct ort_offset *out)
{
    const int32_t width = last_x(chooser->wish), height = last_y(chooser->wish);
    uint64_t unused = ort_offset_most(chooser->wish->width, chooser->wish->height) - found;
    for (int32_t y = -height; y <= height && found < count; y++)
        for (int32_t x = -width; x <= width && found < count; x++) {
            const struct ort_offset offset = { x, y };
            if (ort_offset_set_has(chosen, offset)) continue;
            if (rng_double(&chooser->rng) * (double)unused < (double)(count - found))
                out[found++] = offset;
            unused--;
        }
}

static int by_place(const void *a, const void *b)
{
    const struct ort_offset *p = a, *q = b;
    if (p->y != q->y) return p->y < q->y ? -1 : 1;
    return (p->x > q->x) - (p->x < q->x);
}

// With no `density` all are equally likely.
static bool choose(struct chooser *chooser, const struct ort_density *density, uint32_t count,
                   struct ort_offset *out)
{
    struct ort_offset_set chosen;
    uint32_t found = 0;
    if (!ort_offset_set_init(&chosen, chooser->host, density ? count : 0)) return false;
    if (density) found = draw_offsets(chooser, density, &chosen, count, out);
    fill_up(chooser, &chosen, found, count, out);
    ort_offset_set_finish(&chosen);
    qsort(out, count, sizeof *out, by_place);
    return true;
}

static bool choose_by_importance(struct chooser *chooser, uint32_t count, struct ort_offset *out)
{
    struct ort_density density;
    if (!find_importance(chooser)) return false;
    if (!ort_density_init(&density, chooser->host, chooser->points, chooser->point_count))
        return false;
    const bool ok = choose(chooser, &density, count, out);
    ort_density_finish(&density);
    return ok;
}

bool ort_choose_offsets(struct host *host, const struct ort_offsets_wish *wish,
                        struct ort_offset *out)
{
    assert(wish->width > 0 && wish->width <= ORT_MOST_SIDE && wish->count > 0);
    assert(wish->height > 0 && wish->height <= ORT_MOST_SIDE);
    const uint64_t most = ort_offset_most(wish->width, wish->height);
    const uint32_t count = most < wish->count ? (uint32_t)most : wish->count;
    struct chooser chooser = { .host = host, .wish = wish };
    chooser.rng = rng_for((uint32_t)wish->seed, (uint32_t)(wish->seed >> 32), 0);
    const bool flat = wish->width == 1 || wish->height == 1;
    const bool ok = count == most || flat ? choose(&chooser, NULL, count, out)
                                          : choose_by_importance(&chooser, count, out);
    ort_offset_set_finish(&chooser.known);
    host_free(host, chooser.points);
    host_free(host, chooser.batch);
    host_free(host, chooser.importance);
    return ok;
}
