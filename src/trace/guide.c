// Fitting of guides to records.
#include "trace/guide.h"

#include "core/parallel.h"

#include <stdlib.h>
#include <string.h>

enum {
    CELL_RECORDS = 256, // with light, of a divided cell
    MAX_DEPTH = 20,
    AXES = 6,
};

// ---- cells

struct builder {
    struct guide *guide;
    struct guide_record *records;
    size_t *from; // [cell]: first record
    size_t cells;
    uint32_t nodes, max_nodes;
};

static float key_of(const struct guide_record *r, int axis)
{
    return axis < 3 ? r->position.raw[axis] : (float)r->axis;
}

// Moves records below `split` to the front. axis 3: by orientation.
static size_t partition(struct guide_record *r, size_t count, int axis, float split)
{
    size_t low = 0;
    for (size_t i = 0; i < count; i++)
        if (key_of(&r[i], axis) < split) {
            struct guide_record t = r[i];
            r[i] = r[low];
            r[low++] = t;
        }
    return low;
}

// Divides at the mean of the places with light, along their longest extent.
static size_t divide(struct guide_record *r, size_t count, size_t lit, struct guide_node *node)
{
    struct box3 bounds = box3_empty();
    double sum[3] = { 0.0 };
    for (size_t i = 0; i < count; i++) {
        if (!(r[i].reflected > 0.0f)) continue;
        bounds = box3_add_point(bounds, r[i].position);
        for (int c = 0; c < 3; c++) sum[c] += (double)r[i].position.raw[c];
    }
    int axis = box3_longest_axis(bounds);
    node->axis = (uint32_t)axis & 3u;
    node->split = (float)(sum[axis] / (double)lit);
    return partition(r, count, axis, node->split);
}

static size_t count_lit(const struct guide_record *r, size_t count)
{
    size_t lit = 0;
    for (size_t i = 0; i < count; i++) lit += r[i].reflected > 0.0f;
    return lit;
}

static void build_node(struct builder *b, uint32_t index, size_t from, size_t to, int depth)
{
    size_t count = to - from;
    size_t lit = count_lit(b->records + from, count);
    if (lit > CELL_RECORDS && depth < MAX_DEPTH && b->nodes + 2 <= b->max_nodes) {
        struct guide_node node = { 0 };
        size_t low = divide(b->records + from, count, lit, &node);
        if (low > 0 && low < count) {
            uint32_t child = node.child = b->nodes & 0x3fffffffu;
            b->nodes += 2;
            b->guide->nodes[index] = node;
            build_node(b, child, from, from + low, depth + 1);
            build_node(b, child + 1, from + low, to, depth + 1);
            return;
        }
    }
    b->guide->nodes[index] = (struct guide_node){ .axis = 3, .child = b->cells & 0x3fffffffu };
    b->from[b->cells++] = from;
    b->from[b->cells] = to;
}

static void build_cells(struct builder *b, size_t count)
{
    b->nodes = AXES;
    size_t from = 0;
    for (int axis = 0; axis < AXES; axis++) {
        size_t n = partition(b->records + from, count - from, 3, (float)axis + 0.5f);
        build_node(b, (uint32_t)axis, from, from + n, 0);
        from += n;
    }
}

// ---- distributions

// Variance of the light reflected at a visit, without guided rays and with them.
struct variances {
    double without, with;
};

// From records that `nodes` was not fitted to: V = E[x²] − E[x]². With both techniques, by the
// balance heuristic, E[x²] = ∫ F²/(b + g), and their means are the integrals of F b/(b + g) and
// F g/(b + g).
static struct variances measure(const struct guide_record *r, size_t count,
                                const struct direction_node *nodes)
{
    double visits = 0.0, without = 0.0, with = 0.0, bsdf = 0.0, guided = 0.0;
    for (size_t i = 0; i < count; i++) {
        visits += r[i].visit;
        if (!(r[i].reflected > 0.0f)) continue;
        double f = (double)r[i].reflected, b = (double)r[i].bsdf, all = (double)r[i].all;
        double g = (double)direction_tree_density(nodes, r[i].at);
        without += f * f / b / all;
        with += f * f / (b + g) / all;
        bsdf += f * (b / (b + g)) / all;
        guided += f * (g / (b + g)) / all;
    }
    if (!(visits > 0.0)) return (struct variances){ 0 };
    double mean = (bsdf + guided) / visits;
    return (struct variances){ without / visits - mean * mean,
                               (with - (bsdf * bsdf + guided * guided) / visits) / visits };
}

struct cell_fit {
    struct direction_node nodes[DIRECTION_TREE_NODES];
    int count; // of nodes
    double visits;
    double without, gain; // variance of the image from near light at this cell; its reduction
};

struct fit_job {
    const struct builder *builder;
    struct direction_record *lights; // [records]: scratch
    struct cell_fit *fits;           // [cells]
};

static int fit_records(const struct guide_record *r, size_t count, struct direction_record *lights,
                       struct direction_node *nodes)
{
    int lit = 0;
    for (size_t i = 0; i < count; i++)
        if (r[i].reflected > 0.0f)
            lights[lit++] = (struct direction_record){ r[i].at, r[i].moment };
    return direction_tree_fit(lights, lit, nodes);
}

// The gain is that of a distribution fitted to half of the records, for the others.
static void fit_cell(void *user, size_t i)
{
    const struct fit_job *job = user;
    const struct builder *b = job->builder;
    const struct guide_record *r = b->records + b->from[i];
    size_t count = b->from[i + 1] - b->from[i], half = count / 2;
    struct cell_fit *fit = &job->fits[i];
    struct direction_record *lights = job->lights + b->from[i];
    double importance = 0.0;
    for (size_t k = 0; k < count; k++) {
        fit->visits += r[k].visit;
        importance += (double)r[k].importance;
    }
    if (fit_records(r, half, lights, fit->nodes) == 0) return;
    struct variances v = measure(r + half, count - half, fit->nodes);
    fit->without = importance * v.without;
    fit->gain = importance * (v.without - v.with);
    memset(fit->nodes, 0, sizeof fit->nodes);
    fit->count = fit_records(r, count, lights, fit->nodes);
    b->guide->cells[i].axis = r[0].axis;
}

// ---- choice of cells

// Of the variance by near light: that of all other light, which guided rays leave.
static const double OTHER_VARIANCE = 0.15;
// The least estimated gain; it pays for the training and covers errors of the estimate.
static const double MIN_GAIN = 1.2;

static int by_gain_per_visit(const void *a, const void *b)
{
    const struct cell_fit *x = *(struct cell_fit *const *)a, *y = *(struct cell_fit *const *)b;
    double first = x->gain * y->visits, second = y->gain * x->visits;
    if (first != second) return first > second ? -1 : 1;
    return x < y ? -1 : 1;
}

// Keeps the distributions that minimize the product of variance and time.
static void choose_cells(struct cell_fit *fits, struct cell_fit **order, size_t cells,
                         double ray_cost)
{
    double variance = 0.0, time = 0.0, least;
    size_t kept = 0;
    for (size_t i = 0; i < cells; i++) {
        order[i] = &fits[i];
        variance += fits[i].without;
        time += fits[i].visits;
    }
    variance *= 1.0 + OTHER_VARIANCE;
    qsort(order, cells, sizeof *order, by_gain_per_visit);
    least = variance * time / MIN_GAIN;
    for (size_t i = 0; i < cells; i++) {
        variance -= order[i]->gain;
        time += ray_cost * order[i]->visits;
        if (!(variance * time < least)) continue;
        least = variance * time;
        kept = i + 1;
    }
    for (size_t i = kept; i < cells; i++) order[i]->count = 0;
}

static bool keep_distributions(struct host *host, const struct builder *b,
                               const struct cell_fit *fits)
{
    size_t count = 0, next = 0;
    for (size_t i = 0; i < b->cells; i++) count += (size_t)fits[i].count;
    struct direction_node *nodes = b->guide->directions =
        host_alloc(host, count, sizeof *b->guide->directions);
    if (!nodes) return false;
    for (size_t i = 0; i < b->cells; i++) {
        size_t own = (size_t)fits[i].count;
        if (own == 0) continue;
        memcpy(nodes + next, fits[i].nodes, own * sizeof *nodes);
        b->guide->cells[i].nodes = nodes + next;
        next += own;
    }
    return true;
}

static bool fit_cells(struct host *host, const struct builder *b, size_t records, double ray_cost)
{
    struct fit_job job = { .builder = b };
    b->guide->cells = host_alloc(host, b->cells, sizeof *b->guide->cells);
    job.lights = host_alloc(host, records, sizeof *job.lights);
    job.fits = host_alloc(host, b->cells, sizeof *job.fits);
    struct cell_fit **order = host_alloc(host, b->cells, sizeof *order);
    bool ok = b->guide->cells && job.lights && job.fits && order;
    if (ok) parallel_for(b->cells, 1, fit_cell, &job);
    if (ok && ray_cost > 0.0) choose_cells(job.fits, order, b->cells, ray_cost);
    ok = ok && keep_distributions(host, b, job.fits);
    host_free(host, job.lights);
    host_free(host, job.fits);
    host_free(host, order);
    return ok;
}

static bool has_distribution(const struct guide *guide, size_t cells)
{
    for (size_t i = 0; i < cells; i++)
        if (guide->cells[i].nodes) return true;
    return false;
}

bool guide_fit(struct host *host, struct guide_record *records, size_t count, double ray_cost,
               struct guide **out)
{
    struct builder b = { .records = records };
    b.max_nodes = AXES + 8 * (uint32_t)(count / CELL_RECORDS);
    *out = NULL;
    b.guide = host_alloc(host, 1, sizeof *b.guide);
    if (!b.guide) return false;
    b.guide->nodes = host_alloc(host, b.max_nodes, sizeof *b.guide->nodes);
    b.from = host_alloc(host, b.max_nodes + 1, sizeof *b.from);
    bool ok = b.guide->nodes && b.from;
    if (ok) build_cells(&b, count);
    ok = ok && fit_cells(host, &b, count, ray_cost);
    if (ok && has_distribution(b.guide, b.cells))
        *out = b.guide;
    else
        guide_destroy(host, b.guide);
    host_free(host, b.from);
    return ok;
}

void guide_destroy(struct host *host, struct guide *guide)
{
    if (!guide) return;
    host_free(host, guide->nodes);
    host_free(host, guide->cells);
    host_free(host, guide->directions);
    host_free(host, guide);
}
