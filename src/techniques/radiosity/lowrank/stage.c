#include "techniques/radiosity/lowrank/stage.h"

#include "core/half.h"
#include "core/rng.h"
#include "techniques/radiosity/lowrank/basis.h"
#include "techniques/radiosity/radiosity_tensors.h"

#include <math.h>
#include <string.h>

enum { OUT_SOURCE, OUT_PROJECT, OUT_SCALE, OUT_EXPAND, OUT_COUNT };
enum { LARGEST = 32767 }; // of a projection's integers

// ---- the plan

// Of a singular value decomposition of m×n, m ≥ n, and of the products around it.
static double flops_of(double rows, double sources, double modes)
{
    const double products = 2.0 * rows * 2.0 * sources * modes;
    return 8.0 * products + 14.0 * (rows + 2.0 * sources) * modes * modes;
}

static uint64_t met_of_texel(const struct radiosity_options *options, uint64_t clusters)
{
    return clusters < (uint64_t)options->rays ? clusters : (uint64_t)options->rays;
}

bool radiosity_lowrank_plan(struct bake_plan *plan, const struct radiosity_options *options,
                            uint32_t texels, uint64_t clusters,
                            bool (*run)(const struct bake_task *task), size_t room_bytes)
{
    const uint64_t regions = radiosity_rows(radiosity_region_count(texels));
    const uint64_t sources = radiosity_lowrank_sources(options);
    const uint64_t modes = radiosity_lowrank_modes(options);
    const uint64_t rows = RADIOSITY_COMPONENTS * RADIOSITY_REGION;
    const struct bake_output out[OUT_COUNT] = {
        { RADIOSITY_REGION_SOURCE, TENSOR_U32, 2, { regions, sources }, BAKE_ROWS, BAKE_SAVED },
        { RADIOSITY_REGION_PROJECT,
          TENSOR_U16,
          3,
          { regions, sources, modes },
          BAKE_ROWS,
          BAKE_SAVED },
        { RADIOSITY_REGION_SCALE, TENSOR_F32, 2, { regions, modes }, BAKE_ROWS, BAKE_SAVED },
        { RADIOSITY_REGION_EXPAND,
          TENSOR_F16,
          4,
          { regions, RADIOSITY_REGION, modes, RADIOSITY_COMPONENTS },
          BAKE_ROWS,
          BAKE_SAVED },
    };
    const size_t matrices = (size_t)(rows * (4 * sources + 3 * modes) + 4 * sources * modes);
    const size_t met = (size_t)(RADIOSITY_REGION * met_of_texel(options, clusters));
    return bake_plan_add(
        plan, &(struct bake_stage){ .name = "lowrank",
                                    .wave = 1,
                                    .task_count = (size_t)regions,
                                    .run = run,
                                    .outputs = out,
                                    .output_count = OUT_COUNT,
                                    .rays = (double)RADIOSITY_REGION * options->rays,
                                    .flops = flops_of((double)rows, (double)sources, (double)modes),
                                    .scratch_bytes =
                                        room_bytes + matrices * sizeof(double) +
                                        met * (sizeof(struct radiosity_factor) + sizeof(uint32_t)) +
                                        2 * (size_t)clusters * 4 * sizeof(uint32_t) });
}

// ---- rows of a region

// Factors that the rays of a texel met.
struct met {
    struct radiosity_factor *factor;
    uint32_t *cluster;
    uint32_t first[RADIOSITY_REGION + 1]; // of the texel
};

struct region {
    const struct bake_task *task;
    const struct radiosity_scene *scene;
    const struct radiosity_lowrank_room *room;
    const uint32_t *texels;
    uint32_t texel_count;
    struct met met;
    uint32_t *column; // [clusters] from 1; 0: none
    uint32_t *number; // scratch of the basis
    uint32_t *nodes;  // [sources] strata
    uint32_t sources;
};

static bool region_init(struct region *r, size_t clusters)
{
    struct host *host = r->task->host;
    const size_t met = RADIOSITY_REGION * (size_t)met_of_texel(&r->scene->options, clusters);
    r->met.factor = host_alloc(host, met, sizeof *r->met.factor);
    r->met.cluster = host_alloc(host, met, sizeof *r->met.cluster);
    r->column = host_alloc(host, clusters, sizeof *r->column);
    r->number = host_alloc(host, r->scene->map.tree.count, sizeof *r->number);
    r->nodes = host_alloc(host, radiosity_lowrank_sources(&r->scene->options), sizeof *r->nodes);
    return r->met.factor && r->met.cluster && r->column && r->number && r->nodes;
}

static void region_finish(struct region *r)
{
    struct host *host = r->task->host;
    host_free(host, r->met.factor);
    host_free(host, r->met.cluster);
    host_free(host, r->column);
    host_free(host, r->number);
    host_free(host, r->nodes);
}

static bool trace_texels(struct region *r, const struct radiosity_point *points)
{
    struct radiosity_gather *gather = r->room->gather;
    struct met *met = &r->met;
    for (uint32_t t = 0; t < r->texel_count; t++) {
        const struct radiosity_point *point = &points[r->texels[t]];
        met->first[t + 1] = met->first[t];
        if (point->share == 0.0f) continue;
        if (bake_task_cancelled(r->task)) return false;
        radiosity_gather(r->scene, r->texels[t], point->position, r->task->bake_seed, gather);
        for (uint32_t k = 0; k < gather->met_count; k++) {
            met->cluster[met->first[t + 1]] = gather->met[k];
            met->factor[met->first[t + 1]++] = gather->factor[gather->met[k]];
        }
    }
    return true;
}

// The sum over the region's texels, whose strata are its sources.
static void find_sources(struct region *r, uint64_t seed)
{
    struct radiosity_gather *sum = r->room->gather;
    radiosity_gather_clear(sum);
    for (uint32_t i = 0; i < r->met.first[r->texel_count]; i++) {
        const uint32_t cluster = r->met.cluster[i];
        if (sum->factor[cluster].weight == 0.0f) sum->met[sum->met_count++] = cluster;
        sum->factor[cluster].weight += r->met.factor[i].weight;
    }
    r->sources = radiosity_make_row(
        r->room->rows, sum, radiosity_lowrank_sources(&r->scene->options), seed, r->room->row);
    const struct radiosity_node *nodes = r->scene->map.tree.nodes;
    for (uint32_t k = 0; k < r->sources; k++) {
        const struct radiosity_node *node = &nodes[r->room->row[k].stratum];
        r->nodes[k] = r->room->row[k].stratum;
        for (uint32_t c = node->first; c < node->first + node->count; c++) r->column[c] = k + 1;
    }
}

static void fill_rows(const struct region *r, struct matrix_f64 *a)
{
    for (uint32_t t = 0; t < r->texel_count; t++)
        for (uint32_t i = r->met.first[t]; i < r->met.first[t + 1]; i++) {
            const struct radiosity_factor *factor = &r->met.factor[i];
            const uint32_t column = r->column[r->met.cluster[i]] - 1;
            double *at = a->at + (size_t)RADIOSITY_COMPONENTS * t * a->stride + column;
            at[0] += (double)factor->weight;
            at[a->stride] += (double)factor->along[0];
            at[2 * a->stride] += (double)factor->along[1];
        }
}

// ---- tables

static double largest(const double *at, size_t count, size_t stride)
{
    double most = 0.0;
    for (size_t i = 0; i < count; i++) most = fmax(most, fabs(at[i * stride]));
    return most;
}

// Integers whose sum is 0, as that of the mode is, so that uniform light stays exact.
static void balance(int32_t *row, uint32_t count)
{
    int64_t sum = 0;
    for (uint32_t i = 0; i < count; i++) sum += row[i];
    while (sum != 0) {
        const int32_t step = sum > 0 ? -1 : 1;
        for (uint32_t i = 0; i < count && sum != 0; i++) {
            if (row[i] + step > LARGEST || row[i] + step < -LARGEST) continue;
            row[i] += step;
            sum += step;
        }
    }
}

// Integers of a mode's projection; returns what one stands for.
static double quantise(const struct matrix_f64 *v, uint32_t mode, uint32_t sources, int32_t *out)
{
    const double *row = v->at + mode * v->stride;
    const double most = largest(row, sources, 1);
    int64_t sum = 0;
    for (uint32_t i = 0; i < sources; i++) {
        out[i] = most > 0.0 ? (int32_t)lrint(row[i] / most * LARGEST) : 0;
        sum += out[i];
    }
    if (mode == 0) return sum > 0 ? 1.0 / (double)sum : 0.0; // it sums to 1
    balance(out, sources);
    return most / LARGEST;
}

static void write_mode(const struct region *r, const struct radiosity_basis *basis, uint32_t mode,
                       int32_t *integers)
{
    const size_t modes = radiosity_lowrank_modes(&r->scene->options);
    uint16_t *project = r->task->out[OUT_PROJECT], *expand = r->task->out[OUT_EXPAND];
    const double unit = quantise(&basis->v, mode, r->sources, integers);
    const double most =
        mode == 0 ? 1.0 : largest(basis->u.at + mode, basis->u.rows, basis->u.stride);
    ((float *)r->task->out[OUT_SCALE])[mode] = (float)(unit * most);
    for (uint32_t i = 0; i < r->sources; i++) project[i * modes + mode] = (uint16_t)integers[i];
    for (size_t row = 0; most > 0.0 && row < basis->u.rows; row++) {
        const size_t texel = row / RADIOSITY_COMPONENTS, part = row % RADIOSITY_COMPONENTS;
        expand[(texel * modes + mode) * RADIOSITY_COMPONENTS + part] =
            half_from_float((float)(basis->u.at[row * basis->u.stride + mode] / most));
    }
}

static bool write_basis(const struct region *r, const struct radiosity_basis *basis)
{
    int32_t *integers = host_alloc(r->task->host, r->sources, sizeof *integers);
    uint32_t *source = r->task->out[OUT_SOURCE];
    for (uint32_t k = 0; k < r->sources; k++) source[k] = r->room->row[k].node;
    for (uint32_t k = 0; integers && k < basis->count; k++) write_mode(r, basis, k, integers);
    host_free(r->task->host, integers);
    return integers;
}

static bool make_basis(struct region *r, uint64_t seed)
{
    struct host *host = r->task->host;
    const struct radiosity_options *options = &r->scene->options;
    struct matrix_f64 a = { 0 };
    struct radiosity_basis basis = { 0 };
    const struct radiosity_operator of = { &a, r->nodes, &r->scene->map.tree, r->number };
    const struct radiosity_basis_how how = { options->energy, radiosity_lowrank_modes(options),
                                             seed };
    bool ok = matrix_f64_init(host, &a, RADIOSITY_COMPONENTS * (size_t)r->texel_count, r->sources);
    if (ok) fill_rows(r, &a);
    ok = ok && radiosity_basis_init(&basis, host, &of, &how) && write_basis(r, &basis);
    radiosity_basis_finish(&basis, host);
    matrix_f64_finish(host, &a);
    return ok;
}

bool radiosity_lowrank_run(const struct bake_task *task, const struct radiosity_scene *scene,
                           const uint32_t *regions, const struct radiosity_lowrank_room *room)
{
    const struct tensor *points = bake_task_input(task, RADIOSITY_POINT);
    uint64_t count, first = bake_task_rows(task, OUT_SOURCE, &count);
    const uint64_t texels = scene->map.texel_count, begin = first * RADIOSITY_REGION;
    if (!points) return false;
    if (begin >= texels) return true; // an empty scene
    const uint64_t left = texels - begin;
    struct region r = { .task = task,
                        .scene = scene,
                        .room = room,
                        .texels = regions + begin,
                        .texel_count =
                            (uint32_t)(left < RADIOSITY_REGION ? left : RADIOSITY_REGION) };
    const uint64_t seed = rng_mix(task->bake_seed ^ first << 32);
    bool ok = region_init(&r, scene->map.cluster_count) && trace_texels(&r, points->data);
    if (ok) find_sources(&r, seed);
    ok = ok && (r.sources == 0 || make_basis(&r, seed));
    region_finish(&r);
    return ok;
}
