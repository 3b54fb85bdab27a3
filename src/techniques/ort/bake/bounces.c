// Between patches the transfer is T = F ρ + F ρd F ρ + …, with form factors F by the rays of the
// first stage, reflectances ρ, and factors d of light from all sides (first_order.glsl). With
// B = F ρd, T = (B + B² + …)/d: the sum of twice as many powers is S₂ₙ = Sₙ + Bⁿ Sₙ.
#include "techniques/ort/bake/bounces.h"

#include "core/linalg.h"
#include "techniques/ort/bake/texels.h"

#include <math.h>
#include <string.h>

enum { OUT_TRANSFER, OUT_PATCHES };

static void add_texel(struct ort_patch *patch, const struct ort_texel *t)
{
    patch->area += t->area;
    patch->diffuse += t->area * t->diffuse;
    for (int c = 0; c < 3; c++) patch->reflectance[c] += t->area * t->reflectance[c];
}

// Means of patches, and F by rows: shares of the rays of their texels, by area.
static void fill_patches(const struct ort_texels *t, struct ort_patch *patches,
                         struct matrix_f32 *f)
{
    const struct ort_scene *scene = t->scene;
    const size_t rays = (size_t)scene->options.rays;
    for (uint32_t i = 0; i < scene->map.texel_count; i++) {
        const struct ort_texel texel = ort_texel_of(t, i);
        const uint32_t p = scene->patch_of[i];
        add_texel(&patches[p], &texel);
        for (size_t k = 0; k < rays && t->hits[i * rays + k] != CHART_NONE; k++)
            f->at[p * f->stride + scene->patch_of[t->hits[i * rays + k]]] +=
                texel.area / (float)rays;
    }
    for (size_t p = 0; p < f->rows; p++) {
        const float per_area = patches[p].area > 0.0f ? 1.0f / patches[p].area : 0.0f;
        patches[p].diffuse *= per_area;
        for (int c = 0; c < 3; c++) patches[p].reflectance[c] *= per_area;
        for (size_t q = 0; q < f->columns; q++) f->at[p * f->stride + q] *= per_area;
    }
}

// The part of B's powers that is left: its norm by rows.
static float largest_row(const struct matrix_f32 *m)
{
    float most = 0.0f;
    for (size_t p = 0; p < m->rows; p++) {
        float sum = 0.0f;
        for (size_t q = 0; q < m->columns; q++) sum += m->at[p * m->stride + q];
        most = fmaxf(most, sum);
    }
    return most;
}

struct work {
    struct host *host;
    struct matrix_f32 power, sum, next; // Bⁿ, Sₙ
};

static bool double_sum(struct work *w)
{
    // next = S + Bⁿ S, then Bⁿ Bⁿ
    memcpy(w->next.at, w->sum.at, w->sum.rows * w->sum.stride * sizeof(float));
    if (!matrix_f32_multiply(w->host, 1.0f, &w->power, NOT_TRANSPOSED, &w->sum, NOT_TRANSPOSED,
                             1.0f, &w->next))
        return false;
    const struct matrix_f32 sum = w->next;
    w->next = w->sum;
    w->sum = sum;
    if (!matrix_f32_multiply(w->host, 1.0f, &w->power, NOT_TRANSPOSED, &w->power, NOT_TRANSPOSED,
                             0.0f, &w->next))
        return false;
    const struct matrix_f32 power = w->next;
    w->next = w->power;
    w->power = power;
    return true;
}

// Terms are below this share of the light, or there are 2¹² bounces.
static const float ENOUGH = 1e-4f;
enum { MOST_DOUBLINGS = 12 };

static bool sum_bounces(struct work *w, const struct matrix_f32 *f, const struct ort_patch *patches,
                        int colour)
{
    const size_t n = f->rows;
    for (size_t p = 0; p < n; p++)
        for (size_t q = 0; q < n; q++)
            w->power.at[p * w->power.stride + q] = w->sum.at[p * w->sum.stride + q] =
                f->at[p * f->stride + q] * patches[q].reflectance[colour] * patches[q].diffuse;
    for (int i = 0; i < MOST_DOUBLINGS && largest_row(&w->power) > ENOUGH; i++)
        if (!double_sum(w)) return false;
    for (size_t p = 0; p < n; p++)
        for (size_t q = 0; q < n; q++)
            if (patches[q].diffuse > 0.0f) w->sum.at[p * w->sum.stride + q] /= patches[q].diffuse;
    return true;
}

// The patches that have texels, about half of them.
struct used {
    uint32_t *patch;           // [f.rows] of all patches
    struct ort_patch *patches; // [f.rows]
    struct matrix_f32 f;
};

static bool used_init(struct used *out, struct host *host, const struct matrix_f32 *f,
                      const struct ort_patch *patches)
{
    size_t count = 0;
    *out = (struct used){ .patch = host_alloc(host, f->rows, sizeof *out->patch),
                          .patches = host_alloc(host, f->rows, sizeof *out->patches) };
    if (!out->patch || !out->patches) return false;
    for (size_t p = 0; p < f->rows; p++) {
        if (!(patches[p].area > 0.0f)) continue;
        out->patch[count] = (uint32_t)p;
        out->patches[count++] = patches[p];
    }
    if (!matrix_f32_init(host, &out->f, count, count)) return false;
    for (size_t p = 0; p < count; p++)
        for (size_t q = 0; q < count; q++)
            out->f.at[p * out->f.stride + q] = f->at[out->patch[p] * f->stride + out->patch[q]];
    return true;
}

static void used_finish(struct used *used, struct host *host)
{
    host_free(host, used->patch);
    host_free(host, used->patches);
    matrix_f32_finish(host, &used->f);
}

// all: number of patches.
static bool write_colours(const struct bake_task *task, const struct used *used, size_t all)
{
    struct work w = { .host = task->host };
    const size_t n = used->f.rows;
    float *out = task->out[OUT_TRANSFER];
    bool ok = matrix_f32_init(w.host, &w.power, n, n) && matrix_f32_init(w.host, &w.sum, n, n) &&
              matrix_f32_init(w.host, &w.next, n, n);
    for (size_t c = 0; ok && c < 3; c++) {
        ok = !bake_task_cancelled(task) && sum_bounces(&w, &used->f, used->patches, (int)c);
        for (size_t p = 0; ok && p < n; p++)
            for (size_t q = 0; q < n; q++)
                out[(c * all + used->patch[p]) * all + used->patch[q]] =
                    w.sum.at[p * w.sum.stride + q];
    }
    matrix_f32_finish(w.host, &w.power);
    matrix_f32_finish(w.host, &w.sum);
    matrix_f32_finish(w.host, &w.next);
    return ok;
}

static bool run(const struct bake_task *task)
{
    const struct ort_scene *scene = task->job;
    struct ort_texels texels;
    struct matrix_f32 f = { 0 };
    struct used used = { 0 };
    const size_t n = ort_patch_count(scene->map.texel_count);
    if (scene->map.texel_count == 0) return true;
    if (!ort_find_texels(&texels, task) || !matrix_f32_init(task->host, &f, n, n)) return false;
    fill_patches(&texels, task->out[OUT_PATCHES], &f);
    const bool ok = used_init(&used, task->host, &f, task->out[OUT_PATCHES]) &&
                    (used.f.rows == 0 || write_colours(task, &used, n));
    used_finish(&used, task->host);
    matrix_f32_finish(task->host, &f);
    return ok;
}

bool ort_add_bounces(struct bake_plan *plan, const struct ort_scene *scene)
{
    enum { WAVE = 1, LAST_WAVE = 4 };
    const uint64_t n = ort_patch_count(scene->map.texel_count);
    const double used = 0.5 * (double)n;     // patches that have texels
    const double products = 3.0 * 2.0 * 7.0; // colours, per doubling, doublings of a white room
    return bake_plan_add(
        plan,
        &(struct bake_stage){ .name = "bounces",
                              .wave = WAVE,
                              .task_count = 1,
                              .run = run,
                              BAKE_OUTPUTS(BAKE_F32(BAKE_ROWS, ORT_BOUNCES, LAST_WAVE, 3, n, n),
                                           BAKE_F32(BAKE_ROWS, ORT_PATCHES, LAST_WAVE, n, 5)),
                              .flops = products * 2.0 * used * used * used,
                              .scratch_bytes = (size_t)(5 * n * n * sizeof(float)) });
}
