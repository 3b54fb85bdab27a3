// The stages of the second wave: transfer vectors by coefficient, which do not mix, so that each is
// a task; and bounces of the light of emissive surfaces.
#include "techniques/prt/bake/samples.h"
#include "techniques/prt/bake/series.h"

#include "bake/plan.h"
#include "core/half.h"

#include <math.h>

static double series_cost(const struct prt_scene *scene)
{
    return PRT_SERIES_COST * (double)scene->receivers.count * scene->options.rays *
           scene->options.bounces;
}

// ---- coefficients

enum { OUT_DIRECT, OUT_BOUNCE };

static void write_direct(const struct prt_scene *scene, const float *rows, size_t coefficient,
                         uint16_t *out)
{
    const size_t count = prt_coefficients(&scene->options);
    for (size_t i = 0; i < scene->receivers.count; i++)
        out[i] = half_from_float(rows[i * count + coefficient]);
}

static bool write_bounce(struct prt_series *s, const struct bake_task *task, const float *rows,
                         size_t coefficient, uint16_t *out)
{
    const size_t count = prt_coefficients(&s->scene->options);
    for (size_t i = 0; i < s->texels; i++) {
        const float direct = rows[i * count + coefficient];
        s->term[i] = (vec4s){ { direct, direct, direct, 0 } };
    }
    if (!prt_series_sum(s, task, s->scene->options.threshold, false)) return false;
    for (size_t i = 0; i < s->texels; i++)
        for (size_t c = 0; c < 3; c++) out[3 * i + c] = half_from_float(s->sum[i].raw[c]);
    return true;
}

static bool run_transfer(const struct bake_task *task)
{
    const struct prt_scene *scene = task->job;
    const struct tensor *rows = bake_task_input(task, PRT_ROWS);
    struct prt_series series = { 0 };
    uint64_t count, first = bake_task_rows(task, OUT_DIRECT, &count);
    if (!rows) return false;
    bool ok = !prt_has_bounces(&scene->options) || prt_series_init(&series, task);
    for (uint64_t k = 0; ok && k < count; k++) {
        const size_t coefficient = (size_t)(first + k);
        write_direct(scene, rows->data, coefficient, bake_row(task, OUT_DIRECT, k));
        ok = !prt_has_bounces(&scene->options) ||
             write_bounce(&series, task, rows->data, coefficient, bake_row(task, OUT_BOUNCE, k));
    }
    prt_series_finish(&series);
    return ok;
}

static bool add_coefficients(struct bake_plan *plan, const struct prt_scene *scene)
{
    const uint64_t texels = light_map_rows(scene->receivers.count);
    const uint64_t coefficients = prt_coefficients(&scene->options);
    const bool bounces = prt_has_bounces(&scene->options);
    const int keep = prt_keep(&scene->options);
    const struct bake_output out[] = {
        { PRT_DIRECT, TENSOR_F16, 2, { coefficients, texels }, BAKE_ROWS, keep },
        { PRT_BOUNCE, TENSOR_F16, 3, { coefficients, texels, 3 }, BAKE_ROWS, keep },
    };
    return bake_plan_add(
        plan,
        &(struct bake_stage){ .name = "transfer",
                              .wave = 1,
                              .task_count = (size_t)coefficients,
                              .run = run_transfer,
                              .outputs = out,
                              .output_count = bounces ? 2 : 1,
                              .others = bounces ? series_cost(scene) : 1,
                              .scratch_bytes = bounces ? (size_t)texels * PRT_SERIES_BYTES : 0 });
}

// ---- emissive surfaces

static bool run_emitted(const struct bake_task *task)
{
    const struct prt_scene *scene = task->job;
    const struct tensor *emitted = bake_task_input(task, LIGHT_MAP_EMITTED);
    struct prt_series s;
    float most = 0.0f;
    bool ok = prt_series_init(&s, task) && emitted;
    for (size_t i = 0; ok && i < s.texels; i++)
        for (size_t c = 0; c < 3; c++) {
            s.term[i].raw[c] = ((const float *)emitted->data)[12 * i + 4 * c];
            most = fmaxf(most, s.term[i].raw[c]);
        }
    ok = ok && prt_series_sum(&s, task, scene->options.threshold * most, most > 0.0f);
    for (size_t i = 0; ok && i < s.texels; i++)
        for (size_t c = 0; c < 3; c++) ((float *)bake_row(task, 0, i))[c] = s.sum[i].raw[c];
    prt_series_finish(&s);
    return ok;
}

static bool add_emitted(struct bake_plan *plan, const struct prt_scene *scene)
{
    const uint64_t texels = light_map_rows(scene->receivers.count);
    return bake_plan_add(
        plan, &(struct bake_stage){
                  .name = "emitters",
                  .wave = 1,
                  .task_count = 1,
                  .run = run_emitted,
                  .rays = (double)texels * prt_sample_count(&scene->options),
                  .others = series_cost(scene),
                  .scratch_bytes = (size_t)texels * (PRT_SERIES_BYTES + PRT_SAMPLES_BYTES),
                  BAKE_OUTPUTS(BAKE_F32(BAKE_ROWS, PRT_EMITTED, BAKE_SAVED, texels, 3)) });
}

bool prt_add_transfer(struct bake_plan *plan, const struct prt_scene *scene)
{
    return add_coefficients(plan, scene) &&
           (!prt_has_bounces(&scene->options) || add_emitted(plan, scene));
}
