// Fitting of guides to records.
#include "trace/guide.h"

#include "core/parallel.h"

#include <math.h>
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

// Splits at the mean of the places with light, along their longest extent.
static size_t split_at_mean(struct guide_record *r, size_t count, size_t lit,
                            struct guide_node *node)
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
        size_t low = split_at_mean(b->records + from, count, lit, &node);
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

// Weights to choose from; the BSDF's samples keep an eighth.
static const float WEIGHTS[] = { 0.0f, 0.25f, 0.5f, 0.75f, 0.875f };
enum { WEIGHT_COUNT = sizeof WEIGHTS / sizeof WEIGHTS[0] };

// How well p = b + w s (g − b) samples the integrand F, for each weight w: the second moment
// ∫ F²/p, and ∫ F log(p/b), the cross entropy up to a constant. The latter is linear in F, so that
// a few bright records do not decide.
struct fitness {
    double moment[WEIGHT_COUNT], entropy[WEIGHT_COUNT];
};

// From records that `nodes` was not fitted to.
static void measure(const struct guide_record *r, size_t count, const struct direction_node *nodes,
                    struct fitness *fitness)
{
    for (size_t i = 0; i < count; i++) {
        if (!(r[i].reflected > 0.0f) || !(r[i].bsdf > 0.0f)) continue;
        double f = (double)r[i].reflected, b = (double)r[i].bsdf, all = (double)r[i].all;
        double g = (double)direction_tree_density(nodes, r[i].at), s = (double)r[i].share;
        for (int k = 0; k < WEIGHT_COUNT; k++) {
            double p = b + (double)WEIGHTS[k] * s * (g - b);
            fitness->moment[k] += f * f / p / all;
            fitness->entropy[k] += f / all * log(p / b);
        }
    }
}

struct cell_fit {
    struct direction_node nodes[DIRECTION_TREE_NODES];
    int count;            // of nodes
    double without, with; // variance of the image from this cell
};

enum { COPIES = 4 }; // of a record
struct fit_job {
    const struct builder *builder;
    struct direction_record *lights; // [records · COPIES]: scratch
    struct cell_fit *fits;           // [cells]
};

// Records are spread over a square of twice this width: the directions towards the same light
// differ within a cell.
static const float SPREAD = 1.0f / 40.0f;

static int spread(const struct guide_record *r, struct direction_record *out)
{
    for (int i = 0; i < COPIES; i++) {
        float x = r->at.x + (i & 1 ? SPREAD : -SPREAD), y = r->at.y + (i & 2 ? SPREAD : -SPREAD);
        vec2s at = { { fminf(fmaxf(x, 0.0f), 1.0f), fminf(fmaxf(y, 0.0f), 1.0f) } };
        out[i] = (struct direction_record){ at, r->weight };
    }
    return COPIES;
}

static int fit_records(const struct guide_record *r, size_t count, struct direction_record *lights,
                       struct direction_node *nodes)
{
    int lit = 0;
    for (size_t i = 0; i < count; i++)
        if (r[i].reflected > 0.0f) lit += spread(&r[i], lights + lit);
    return direction_tree_fit(lights, lit, nodes);
}

// Each half of the records measures the distribution fitted to the other. False without light.
static bool measure_halves(const struct guide_record *r, size_t count,
                           struct direction_record *lights, struct direction_node *nodes,
                           struct fitness *fitness)
{
    size_t half = count / 2;
    if (fit_records(r, half, lights, nodes) == 0) return false;
    measure(r + half, count - half, nodes, fitness);
    if (fit_records(r + half, count - half, lights, nodes) == 0) return false;
    measure(r, half, nodes, fitness);
    return true;
}

struct cell_sums {
    double importance, reflected, radiance;
};

static struct cell_sums sums_of(const struct guide_record *r, size_t count)
{
    struct cell_sums sums = { 0 };
    for (size_t i = 0; i < count; i++) {
        sums.importance += (double)r[i].importance;
        sums.radiance += (double)r[i].radiance;
        if (r[i].reflected > 0.0f) sums.reflected += (double)r[i].reflected / (double)r[i].all;
    }
    return sums;
}

static void fit_cell(void *user, size_t i)
{
    const struct fit_job *job = user;
    const struct builder *b = job->builder;
    const struct guide_record *r = b->records + b->from[i];
    size_t count = b->from[i + 1] - b->from[i];
    if (count == 0) return;
    struct guide_cell *cell = &b->guide->cells[i];
    struct cell_fit *fit = &job->fits[i];
    struct direction_record *lights = job->lights + COPIES * b->from[i];
    struct cell_sums sums = sums_of(r, count);
    struct fitness fitness = { 0 };
    double n = (double)count, mean = sums.reflected / n;
    cell->radiance = (float)(sums.radiance / n);
    if (!measure_halves(r, count, lights, fit->nodes, &fitness)) return;
    int best = 0;
    for (int k = 1; k < WEIGHT_COUNT; k++)
        if (fitness.entropy[k] > fitness.entropy[best]) best = k;
    fit->without = sums.importance * (fitness.moment[0] / n - mean * mean);
    fit->with = sums.importance * (fitness.moment[best] / n - mean * mean);
    if (best == 0) return;
    fit->count = fit_records(r, count, lights, fit->nodes);
    cell->axis = r[0].axis;
    cell->weight = WEIGHTS[best];
}

static float mean_radiance(const struct guide_record *r, size_t count)
{
    double sum = 0.0;
    for (size_t i = 0; i < count; i++) sum += (double)r[i].radiance;
    return count > 0 ? (float)(sum / (double)count) : 0.0f;
}

static double gain_of(const struct cell_fit *fits, size_t cells)
{
    double without = 0.0, with = 0.0;
    for (size_t i = 0; i < cells; i++) {
        without += fits[i].without;
        with += fits[i].with;
    }
    return with > 0.0 ? without / with : 1.0;
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

static bool fit_cells(struct host *host, const struct builder *b, size_t records, double *gain)
{
    struct fit_job job = { .builder = b };
    b->guide->cells = host_alloc(host, b->cells, sizeof *b->guide->cells);
    job.lights = host_alloc(host, COPIES * records, sizeof *job.lights);
    job.fits = host_alloc(host, b->cells, sizeof *job.fits);
    bool ok = b->guide->cells && job.lights && job.fits;
    if (ok) {
        parallel_for(b->cells, 1, fit_cell, &job);
        b->guide->radiance = mean_radiance(b->records, records);
        *gain = gain_of(job.fits, b->cells);
        ok = keep_distributions(host, b, job.fits);
    }
    host_free(host, job.lights);
    host_free(host, job.fits);
    return ok;
}

static bool has_distribution(const struct guide *guide, size_t cells)
{
    for (size_t i = 0; i < cells; i++)
        if (guide->cells[i].nodes) return true;
    return false;
}

bool guide_fit(struct host *host, struct guide_record *records, size_t count, struct guide **out,
               double *gain)
{
    struct builder b = { .records = records };
    b.max_nodes = AXES + 8 * (uint32_t)(count / CELL_RECORDS);
    *out = NULL;
    *gain = 1.0;
    b.guide = host_alloc(host, 1, sizeof *b.guide);
    if (!b.guide) return false;
    b.guide->nodes = host_alloc(host, b.max_nodes, sizeof *b.guide->nodes);
    b.from = host_alloc(host, b.max_nodes + 1, sizeof *b.from);
    bool ok = b.guide->nodes && b.from;
    if (ok) build_cells(&b, count);
    ok = ok && fit_cells(host, &b, count, gain);
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
