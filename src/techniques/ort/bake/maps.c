// The stage of transfer maps: R(t, t + Δt) TVA(t, Δt) for all offsets of a texel (equation 10),
// then its weights are scaled to the sum of its row, which follows from the rays. One bounce and
// more are treated apart. One bounce that the points of the offsets overestimate is scaled down;
// missing transfer is added from the patches that rays have hit. Scattered light is integrated over
// the regions of offsets (shares.c).
#include "core/half.h"
#include "techniques/ort/bake/shares.h"
#include "techniques/ort/bake/stages.h"
#include "techniques/ort/bake/transfer.h"

#include "bake/plan.h"

#include <string.h>

enum { TEXELS_PER_TASK = 256 };
enum { OUT_MAPS, OUT_ENERGY };

// Weights of all offsets for one colour: [offsets].
enum { SINGLE, PATCH, MULTIPLE, SCATTERED, KINDS };
struct row {
    size_t offsets;
    float *weight[KINDS][3];
    float sum[KINDS][3];
};

static bool row_init(struct row *row, struct host *host, size_t offsets)
{
    bool ok = true;
    *row = (struct row){ .offsets = offsets };
    for (int kind = 0; kind < KINDS; kind++)
        for (int c = 0; c < 3; c++)
            ok &= (row->weight[kind][c] = host_alloc(host, offsets, sizeof(float))) != NULL;
    return ok;
}

static void row_finish(struct row *row, struct host *host)
{
    for (int kind = 0; kind < KINDS; kind++)
        for (int c = 0; c < 3; c++) host_free(host, row->weight[kind][c]);
}

static void add_weights(struct row *row, int kind, size_t k, const float transfer[3], float area)
{
    for (int c = 0; c < 3; c++) {
        row->weight[kind][c][k] = transfer[c] * area;
        row->sum[kind][c] += transfer[c] * area;
    }
}

static void weigh(const struct ort_transfer *transfer, const struct ort_receiver *r,
                  const struct bake_task *task, struct row *row)
{
    const struct ort_scene *scene = transfer->texels.scene;
    const struct ort_map *map = &scene->map;
    const int32_t *offset = (const int32_t *)bake_task_input(task, ORT_OFFSETS)->data +
                            2 * map->group_of[r->texel] * row->offsets;
    const float *areas = bake_task_input(task, ORT_AREAS)->data;
    const struct ort_place place = ort_place_of(map, r->texel);
    memset(row->sum, 0, sizeof row->sum);
    for (size_t k = 0; k < row->offsets; k++) {
        const uint32_t from = ort_texel_at(map, place, offset[2 * k], offset[2 * k + 1]);
        const float area = areas[k * map->texel_count + r->texel];
        float of[KINDS][3] = { { 0 } };
        if (from != CHART_NONE && area > 0.0f) {
            if (scene->options.transfer != ORT_SCATTERING) {
                ort_transfer_single(transfer, r, from, of[SINGLE]);
                ort_transfer_patch(transfer, r, from, of[PATCH]);
                ort_transfer_multiple(transfer, r, from, of[MULTIPLE]);
            }
            if (scene->kernel) ort_transfer_scattered(transfer, r, from, of[SCATTERED]);
        }
        for (int kind = 0; kind < KINDS; kind++) add_weights(row, kind, k, of[kind], area);
    }
}

// Weights of scattered light by regions, in place of those by points.
static void weigh_regions(const struct ort_transfer *transfer, const struct ort_receiver *r,
                          struct ort_shares *shares, struct row *row)
{
    float *const *weight = row->weight[SCATTERED];
    for (int c = 0; c < 3; c++) memset(weight[c], 0, row->offsets * sizeof *weight[c]);
    ort_shares_add(shares, transfer, r, weight);
    for (int c = 0; c < 3; c++) {
        row->sum[SCATTERED][c] = 0.0f;
        for (size_t k = 0; k < row->offsets; k++) row->sum[SCATTERED][c] += weight[c][k];
    }
}

// Factors of the three kinds that give a row its exact sum.
static void find_factors(const struct ort_receiver *r, const struct row *row, int c, bool exact,
                         float factor[KINDS])
{
    const float sum[KINDS] = { row->sum[SINGLE][c], row->sum[PATCH][c], row->sum[MULTIPLE][c],
                               row->sum[SCATTERED][c] };
    float missed = r->single[c] - sum[SINGLE], multiple = r->multiple[c];
    factor[SINGLE] = factor[MULTIPLE] = factor[SCATTERED] = 1.0f;
    factor[PATCH] = 0.0f;
    if (!exact) return;
    if (missed < 0.0f) factor[SINGLE] = r->single[c] / sum[SINGLE];
    if (missed > 0.0f && sum[PATCH] > 0.0f) {
        factor[PATCH] = missed / sum[PATCH];
        missed = 0.0f;
    }
    if (missed > 0.0f) multiple += missed; // no offset leads to a hit of the rays
    factor[SCATTERED] = sum[SCATTERED] > 0.0f ? r->scattered[c] / sum[SCATTERED] : 0.0f;
    factor[MULTIPLE] = sum[MULTIPLE] > 0.0f ? multiple / sum[MULTIPLE] : 0.0f;
}

static void write_row(const struct ort_receiver *r, const struct row *row, bool exact,
                      uint16_t *out)
{
    for (int c = 0; c < 3; c++) {
        float factor[KINDS];
        find_factors(r, row, c, exact, factor);
        for (size_t k = 0; k < row->offsets; k++) {
            float weight = 0.0f;
            for (int kind = 0; kind < KINDS; kind++)
                weight += factor[kind] * row->weight[kind][c][k];
            out[3 * k + (size_t)c] = half_from_float(ORT_MAP_SCALE * weight);
        }
    }
}

// Sums of the row as the offsets give it, and of the exact one.
static void add_energy(const struct ort_receiver *r, const struct row *row, float energy[6])
{
    for (int c = 0; c < 3; c++) {
        energy[c] +=
            r->at.area * (row->sum[SINGLE][c] + row->sum[MULTIPLE][c] + row->sum[SCATTERED][c]);
        energy[3 + c] += r->at.area * (r->single[c] + r->multiple[c] + r->scattered[c]);
    }
}

struct work {
    struct ort_transfer transfer;
    struct ort_receiver receiver;
    struct ort_shares shares;
    struct row row;
};

static bool make_row(const struct bake_task *task, struct work *w, uint32_t texel, uint16_t *out)
{
    const struct ort_scene *scene = task->job;
    const bool exact = scene->options.rows == ORT_ROWS_EXACT;
    if (!ort_receive(&w->transfer, texel, &w->receiver)) return true;
    weigh(&w->transfer, &w->receiver, task, &w->row);
    add_energy(&w->receiver, &w->row, task->out[OUT_ENERGY]);
    if (exact && scene->kernel) {
        if (!ort_shares_select(&w->shares, task, scene->map.group_of[texel])) return false;
        weigh_regions(&w->transfer, &w->receiver, &w->shares, &w->row);
    }
    write_row(&w->receiver, &w->row, exact, out);
    return true;
}

static bool make_rows(const struct bake_task *task, struct work *w)
{
    uint64_t count, first = bake_task_rows(task, OUT_MAPS, &count);
    for (uint64_t i = 0; i < count; i++) {
        if (bake_task_cancelled(task)) return false;
        if (!make_row(task, w, (uint32_t)(first + i), bake_row(task, OUT_MAPS, i))) return false;
    }
    return true;
}

static bool run(const struct bake_task *task)
{
    const struct ort_scene *scene = task->job;
    struct work w;
    if (scene->map.texel_count == 0) return true;
    if (!ort_transfer_init(&w.transfer, task) || !bake_task_input(task, ORT_OFFSETS) ||
        !bake_task_input(task, ORT_AREAS))
        return false;
    const bool has_row =
        row_init(&w.row, task->host, ort_offset_count(&scene->map, &scene->options));
    const bool has_shares = ort_shares_init(&w.shares, task);
    const bool ok = ort_receiver_init(&w.receiver, task->host, w.transfer.patch_count) && has_row &&
                    has_shares && make_rows(task, &w);
    ort_receiver_finish(&w.receiver, task->host);
    ort_shares_finish(&w.shares);
    row_finish(&w.row, task->host);
    return ok;
}

bool ort_add_maps(struct bake_plan *plan, const struct ort_scene *scene)
{
    const uint64_t texels = light_map_rows(scene->map.texel_count);
    const uint64_t offsets = ort_offset_count(&scene->map, &scene->options);
    const double patches = (double)ort_patch_count(scene->map.texel_count);
    const size_t tasks = (size_t)((texels + TEXELS_PER_TASK - 1) / TEXELS_PER_TASK);
    const size_t regions =
        scene->options.transfer == ORT_RADIOSITY ? 0 : ort_shares_bytes(&scene->map);
    const struct bake_output out[] = {
        { ORT_MAPS, TENSOR_F16, 3, { texels, offsets, 3 }, BAKE_ROWS, BAKE_SAVED },
        { ORT_ENERGY, TENSOR_F32, 2, { 2, 3 }, BAKE_SUM, BAKE_SAVED },
    };
    // A quarter of the offsets face the texel; a ray takes as long as the bounces of that many
    // patches.
    enum { PATCHES_PER_RAY = 400 };
    return bake_plan_add(
        plan, &(struct bake_stage){
                  .name = "maps",
                  .wave = 4,
                  .task_count = tasks,
                  .run = run,
                  .outputs = out,
                  .output_count = 2,
                  .rays = 0.25 * (double)(texels * offsets) / (double)tasks,
                  .others = (double)texels / (double)tasks *
                            (0.1 * patches * patches / PATCHES_PER_RAY + 0.25 * (double)offsets),
                  .scratch_bytes = (size_t)(9.0 * patches * sizeof(float)) + regions });
}
