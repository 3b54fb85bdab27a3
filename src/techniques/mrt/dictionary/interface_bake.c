// Stages of a dictionary's bake for interfaces: lightfields of the implicit lights, the reduced
// basis with its rounds of enrichment, and the operators with respect to the last basis.
#include "bake_stages.h"

#include "techniques/mrt/dictionary/basis.h"
#include "techniques/mrt/dictionary/gather.h"
#include "techniques/mrt/dictionary/cube_operators.h"
#include "techniques/mrt/dictionary/response.h"

#include <math.h>
#include <string.h>

enum { GRAM_TASKS = 16 };

// Names of the tensors of a round. Round 0 reduces H_lf, the others the basis of the round before
// and its propagation.
struct round_names {
    int round;
    const char *span[MRT_SPAN_PARTS]; // NULL: one part
    const char *gram, *coefficients, *sigma, *basis, *further;
};

static const char *basis_name(struct bake_plan *plan, int round)
{
    return bake_plan_name(plan, "interface/H_rlf/%d", round);
}

static const char *further_name(struct bake_plan *plan, int round)
{
    return bake_plan_name(plan, "interface/propagated/%d", round);
}

static size_t row_tasks(const struct mrt_bake_job *job)
{
    return (size_t)(job->options.lightfield_positions * job->options.lightfield_positions);
}

// ---- lightfields of the implicit lights

// Equation 4.1: shapes weigh the same whatever their indirect light. A cube of one face has none.
static bool run_scale(const struct bake_task *task)
{
    const struct mrt_bake_job *job = task->job;
    double sums[MRT_MAX_CUBES] = { 0 }, all = 0.0;
    float *scale = task->out[0];
    for (int i = 0; i < job->shapes; i++) {
        struct matrix_f32 sigma;
        if (!mrt_bake_shape_input(task, i, "sigma_M", &sigma)) return false;
        sums[i] = pow(matrix_f32_norm(&sigma), 2.0);
        all += sums[i];
    }
    for (int i = 0; i < job->shapes; i++) {
        const struct mrt_shape shape = mrt_bake_shape(job, i);
        const double factor = sums[i] > 0.0 ? sqrt(all / (sums[i] * job->shapes)) : 1.0;
        for (uint64_t k = 0; k < (uint64_t)mrt_shape_openings(&shape) * job->k_b; k++)
            *scale++ = (float)factor;
    }
    return true;
}

// The implicit lights of each shape at each of its openings, beside each other.
static bool run_lightfields(const struct bake_task *task)
{
    const struct mrt_bake_job *job = task->job;
    uint64_t first;
    size_t column = 0;
    const struct matrix_f32 out = mrt_bake_output(task, 0, &first);
    for (int i = 0; i < job->shapes; i++) {
        const struct mrt_shape shape = mrt_bake_shape(job, i);
        struct matrix_f32 l_imp;
        if (!mrt_bake_shape_input(task, i, "L_imp", &l_imp)) return false;
        for (int f = 0; f < CUBE_FACES; f++) {
            if (!mrt_shape_is_open(&shape, f)) continue;
            struct matrix_f32 to = matrix_f32_block(&out, 0, column, out.rows, l_imp.columns);
            if (bake_task_cancelled(task) ||
                !mrt_lightfield_of_surfaces(task->host, job->lightfield, &shape, f, &l_imp,
                                            (size_t)first, &to))
                return false;
            column += l_imp.columns;
        }
    }
    return true;
}

static bool add_lightfields(struct bake_plan *plan, const struct mrt_bake_job *job)
{
    const uint64_t columns = job->openings * job->k_b;
    const double rays =
        (double)(job->samples * job->openings) * mrt_lightfield_subsamples(job->lightfield);
    return bake_plan_add(
               plan, &(struct bake_stage){ .name = "interface weights",
                                           .wave = WAVE_LIGHTFIELDS,
                                           .task_count = 1,
                                           .run = run_scale,
                                           BAKE_OUTPUTS(BAKE_F32(BAKE_ROWS, "interface/scale",
                                                                 WAVE_REDUCE + 1, columns)) }) &&
           bake_plan_add(plan,
                         &(struct bake_stage){
                             .name = "lightfields",
                             .wave = WAVE_LIGHTFIELDS,
                             .task_count = row_tasks(job),
                             .run = run_lightfields,
                             BAKE_OUTPUTS(BAKE_F32(BAKE_ROWS, "interface/H_lf", job->wave_final + 1,
                                                   job->samples, columns)),
                             .rays = rays / (double)row_tasks(job) });
}

// ---- a round

static bool span_input(const struct bake_task *task, const struct round_names *names,
                       struct mrt_span *span)
{
    span->parts = names->span[1] ? 2 : 1;
    for (int p = 0; p < span->parts; p++)
        if (!mrt_bake_input(task, names->span[p], &span->part[p])) return false;
    return true;
}

static bool run_gram(const struct bake_task *task)
{
    const struct round_names *names = task->argument;
    struct mrt_span span;
    struct matrix_f64 gram = { 0 };
    if (!span_input(task, names, &span)) return false;
    const size_t columns = mrt_span_columns(&span);
    uint64_t rows;
    const uint64_t first = bake_rows(span.part[0].rows, task->index, task->count, &rows);
    bool ok = matrix_f64_init(task->host, &gram, columns, columns) &&
              mrt_span_gram(task->host, &span, (size_t)first, (size_t)rows, &gram);
    for (size_t i = 0; ok && i < columns * columns; i++)
        ((float *)task->out[0])[i] = (float)gram.at[i];
    matrix_f64_finish(task->host, &gram);
    return ok;
}

// The factor of each column: equation 4.1 in round 0, equal norms of both parts later.
static bool set_factors(const struct bake_task *task, const struct round_names *names,
                        const struct matrix_f64 *gram, double *factor)
{
    const struct mrt_bake_job *job = task->job;
    struct matrix_f32 scale;
    if (names->round > 0) {
        mrt_span_balance(gram, (size_t)job->k_l, factor);
        return true;
    }
    if (!mrt_bake_input(task, "interface/scale", &scale)) return false;
    for (size_t i = 0; i < gram->rows; i++) factor[i] = (double)scale.at[i];
    return true;
}

static bool run_reduce(const struct bake_task *task)
{
    const struct round_names *names = task->argument;
    struct matrix_f32 narrow;
    struct matrix_f64 gram = { 0 };
    uint64_t first;
    struct matrix_f32 coefficients = mrt_bake_output(task, 0, &first);
    bool ok = mrt_bake_input(task, names->gram, &narrow) &&
              matrix_f64_from_f32(task->host, &narrow, &gram);
    const size_t columns = gram.rows, modes = coefficients.columns;
    double *factor = host_alloc(task->host, columns, sizeof *factor);
    double *sigma = host_alloc(task->host, modes, sizeof *sigma);
    ok = ok && factor && sigma && set_factors(task, names, &gram, factor) &&
         mrt_span_reduce(task->host, &gram, factor, &coefficients, sigma);
    for (size_t i = 0; ok && i < modes; i++) ((float *)task->out[1])[i] = (float)sigma[i];
    host_free(task->host, sigma);
    host_free(task->host, factor);
    matrix_f64_finish(task->host, &gram);
    return ok;
}

static bool run_basis(const struct bake_task *task)
{
    const struct round_names *names = task->argument;
    struct mrt_span span;
    struct matrix_f32 coefficients;
    uint64_t first;
    struct matrix_f32 out = mrt_bake_output(task, 0, &first);
    return span_input(task, names, &span) &&
           mrt_bake_input(task, names->coefficients, &coefficients) &&
           mrt_span_apply(task->host, &span, (size_t)first, &coefficients, &out);
}

static bool run_propagate(const struct bake_task *task)
{
    const struct mrt_bake_job *job = task->job;
    const struct round_names *names = task->argument;
    struct matrix_f32 basis;
    uint64_t first;
    const struct matrix_f32 out = mrt_bake_output(task, 0, &first);
    if (!mrt_bake_input(task, names->basis, &basis)) return false;
    for (int t = 0; t < job->turns; t++) {
        struct matrix_f32 to =
            matrix_f32_block(&out, 0, (size_t)t * basis.columns, out.rows, basis.columns);
        if (bake_task_cancelled(task) ||
            !mrt_propagate(task->host, job->lightfield, (enum mrt_turn)t, &basis, (size_t)first,
                           &to))
            return false;
    }
    return true;
}

static bool add_reduction(struct bake_plan *plan, const struct mrt_bake_job *job,
                          const struct round_names *names, uint64_t columns)
{
    const int round = names->round, wave = mrt_wave_of_round(round);
    const bool last = round == job->options.lightfield_rounds;
    const double samples = (double)job->samples, n = (double)columns;
    return bake_plan_add(
               plan, &(struct bake_stage){ .name = bake_plan_name(plan, "round %d products", round),
                                           .wave = wave,
                                           .task_count = GRAM_TASKS,
                                           .run = run_gram,
                                           .argument = names,
                                           BAKE_OUTPUTS(BAKE_F32(BAKE_SUM, names->gram, wave + 1,
                                                                 columns, columns)),
                                           .flops = 2.0 * samples * n * n / GRAM_TASKS,
                                           .scratch_bytes = (size_t)(8 * columns * columns) }) &&
           bake_plan_add(
               plan, &(struct bake_stage){ .name = bake_plan_name(plan, "round %d modes", round),
                                           .wave = wave + 1,
                                           .task_count = 1,
                                           .run = run_reduce,
                                           .argument = names,
                                           BAKE_OUTPUTS(BAKE_F32(BAKE_ROWS, names->coefficients,
                                                                 wave + 2, columns, job->k_l),
                                                        BAKE_F32(BAKE_ROWS, names->sigma,
                                                                 BAKE_REPORTED, job->k_l)),
                                           .flops = 12.0 * n * n * n,
                                           .scratch_bytes = (size_t)(24 * columns * columns) }) &&
           bake_plan_add(
               plan, &(struct bake_stage){
                         .name = bake_plan_name(plan, "round %d basis", round),
                         .wave = wave + 2,
                         .task_count = row_tasks(job),
                         .run = run_basis,
                         .argument = names,
                         BAKE_OUTPUTS(BAKE_F32(BAKE_ROWS, names->basis, wave + (last ? 5 : 6),
                                               job->samples, job->k_l)),
                         .flops = 2.0 * samples * n * (double)job->k_l / (double)row_tasks(job) });
}

// Propagates the basis of a round; the next round or the operators read it.
static bool add_propagation(struct bake_plan *plan, const struct mrt_bake_job *job,
                            const struct round_names *names)
{
    const int wave = mrt_wave_of_round(names->round) + 3;
    const bool last = names->round == job->options.lightfield_rounds;
    const double rays =
        (double)job->samples * mrt_lightfield_subsamples(job->lightfield) * job->turns;
    return bake_plan_add(plan,
                         &(struct bake_stage){
                             .name = bake_plan_name(plan, "round %d propagation", names->round),
                             .wave = wave,
                             .task_count = row_tasks(job),
                             .run = run_propagate,
                             .argument = names,
                             BAKE_OUTPUTS(BAKE_F32(BAKE_ROWS, names->further, wave + (last ? 1 : 3),
                                                   job->samples, (uint64_t)job->turns * job->k_l)),
                             .rays = rays / (double)row_tasks(job) });
}

static struct round_names *names_of_round(struct bake_plan *plan, int round)
{
    struct round_names *names = bake_plan_alloc(plan, 1, sizeof *names);
    if (!names) return NULL;
    names->round = round;
    names->span[0] = round == 0 ? "interface/H_lf" : basis_name(plan, round - 1);
    names->span[1] = round == 0 ? NULL : further_name(plan, round - 1);
    names->gram = bake_plan_name(plan, "interface/gram/%d", round);
    names->coefficients = bake_plan_name(plan, "interface/coefficients/%d", round);
    names->sigma = bake_plan_name(plan, "interface/sigma/%d", round);
    names->basis = basis_name(plan, round);
    names->further = further_name(plan, round);
    return names;
}

// ---- operators with respect to the last basis

// Products of the basis with the lightfields of the openings and with its own propagation.
static bool run_project(const struct bake_task *task)
{
    const struct round_names *names = task->argument;
    struct matrix_f32 basis, lightfields, further;
    uint64_t first, rows, unused;
    struct matrix_f32 r_b = mrt_bake_output(task, 0, &unused);
    struct matrix_f32 r_turn = mrt_bake_output(task, 1, &unused);
    if (!mrt_bake_input(task, names->basis, &basis) ||
        !mrt_bake_input(task, "interface/H_lf", &lightfields) ||
        !mrt_bake_input(task, names->further, &further))
        return false;
    first = bake_rows(basis.rows, task->index, task->count, &rows);
    return mrt_project_add(task->host, &basis, &lightfields, (size_t)first, (size_t)rows, &r_b) &&
           mrt_project_add(task->host, &basis, &further, (size_t)first, (size_t)rows, &r_turn);
}

static bool add_project(struct bake_plan *plan, const struct mrt_bake_job *job,
                        const struct round_names *names)
{
    const uint64_t columns = job->openings * job->k_b, turns = (uint64_t)job->turns * job->k_l;
    const int wave = job->wave_final + 1;
    const double flops = 2.0 * (double)(job->samples * job->k_l * (columns + turns));
    return bake_plan_add(
        plan,
        &(struct bake_stage){
            .name = "projections",
            .wave = wave,
            .task_count = GRAM_TASKS,
            .run = run_project,
            .argument = names,
            BAKE_OUTPUTS(BAKE_F32(BAKE_SUM, "interface/product/b", wave + 1, job->k_l, columns),
                         BAKE_F32(BAKE_SUM, "interface/product/turn", wave + 1, job->k_l, turns)),
            .flops = flops / GRAM_TASKS });
}

static bool run_operators(const struct bake_task *task)
{
    const struct mrt_bake_job *job = task->job;
    const struct round_names *names = task->argument;
    struct matrix_f32 b, turn, sigma;
    if (!mrt_bake_input(task, "interface/product/b", &b) ||
        !mrt_bake_input(task, "interface/product/turn", &turn) ||
        !mrt_bake_input(task, names->sigma, &sigma))
        return false;
    mrt_project_finish(&turn, &sigma, 0, (size_t)job->k_l, (size_t)job->turns, task->out[0]);
    int output = 1;
    size_t first = 0;
    for (int i = 0; i < job->shapes; i++) {
        const struct mrt_shape shape = mrt_bake_shape(job, i);
        const size_t openings = (size_t)mrt_shape_openings(&shape);
        if (openings == 0) continue;
        mrt_project_finish(&b, &sigma, first, (size_t)job->k_b, openings, task->out[output++]);
        first += openings * (size_t)job->k_b;
    }
    return true;
}

static bool add_operators(struct bake_plan *plan, const struct mrt_bake_job *job,
                          const struct round_names *names)
{
    struct bake_output outputs[1 + MRT_MAX_CUBES] = {
        BAKE_F32(BAKE_ROWS, "interface/R_turn", BAKE_SAVED, (uint64_t)job->turns, job->k_l,
                 job->k_l),
    };
    int count = 1;
    for (int i = 0; i < job->shapes; i++) {
        const struct mrt_shape shape = mrt_bake_shape(job, i);
        const uint64_t openings = (uint64_t)mrt_shape_openings(&shape);
        if (openings > 0)
            outputs[count++] =
                BAKE_F32(BAKE_ROWS, bake_plan_name(plan, "%s/%d/R_b", job->family, i), BAKE_SAVED,
                         openings, job->k_l, job->k_b);
    }
    return bake_plan_add(plan, &(struct bake_stage){ .name = "interface operators",
                                                     .wave = job->wave_final + 2,
                                                     .task_count = 1,
                                                     .run = run_operators,
                                                     .argument = names,
                                                     .outputs = outputs,
                                                     .output_count = count });
}

// ---- the response of the block that light enters

// A gather stage: its measure, the basis that it gathers (one for each shape that light enters,
// below each other, or one for all), and the points of a shape.
struct response_stage {
    enum mrt_measure measure;
    const char *basis;
    uint64_t points;
};

enum { ROWS_PER_TASK = 16 };

static bool run_response(const struct bake_task *task)
{
    const struct mrt_bake_job *job = task->job;
    const struct response_stage *stage = task->argument;
    const struct mrt_rays *rays = &job->rays[stage->measure];
    struct matrix_f32 basis, gather = { 0 };
    uint64_t first, unused, points;
    struct matrix_f32 out = mrt_bake_output(task, 0, &unused);
    first = bake_task_rows(task, 0, &points);
    const uint64_t index = first / stage->points;
    const struct mrt_shape entered = mrt_entered_shape(job->maze, job->options.texels, (int)index);
    if (!mrt_bake_input(task, stage->basis, &basis)) return false;
    if (basis.rows > job->samples)
        basis = matrix_f32_block(&basis, (size_t)(index * job->samples), 0, (size_t)job->samples,
                                 basis.columns);
    bool ok = matrix_f32_init(task->host, &gather, out.rows, basis.rows);
    for (uint64_t i = 0; ok && i < points; i++) {
        struct mrt_point at = mrt_gather_point(&entered, job->options.block_probes, stage->measure,
                                               (int)(first + i - index * stage->points));
        mrt_gather_interface(job->lightfield, &entered, at, rays,
                             gather.at + i * (uint64_t)rays->values * gather.stride);
        ok = !bake_task_cancelled(task);
    }
    ok = ok && matrix_f32_multiply(task->host, 1.0f, &gather, NOT_TRANSPOSED, &basis,
                                   NOT_TRANSPOSED, 0.0f, &out);
    matrix_f32_finish(task->host, &gather);
    return ok;
}

// Tasks of as many points as divide those of a shape, so that each task is in one shape.
static uint64_t points_per_task(uint64_t points, uint64_t values)
{
    uint64_t part = values < ROWS_PER_TASK ? ROWS_PER_TASK / values : 1;
    while (points % part != 0) part--;
    return part;
}

static bool add_response(struct bake_plan *plan, const struct mrt_bake_job *job, const char *name,
                         int wave, const struct response_stage *stage,
                         const struct bake_output *out)
{
    const uint64_t values = out->rank == 3 ? out->shape[1] : 1;
    const uint64_t part = points_per_task(stage->points, values);
    const double columns = (double)out->shape[out->rank - 1], rows = (double)(part * values);
    return bake_plan_add(
        plan, &(struct bake_stage){ .name = name,
                                    .wave = wave,
                                    .task_count = (size_t)(out->shape[0] / part),
                                    .run = run_response,
                                    .argument = stage,
                                    .outputs = out,
                                    .output_count = 1,
                                    .rays = (double)part * job->options.rays,
                                    .flops = 2.0 * rows * (double)job->samples * columns,
                                    .scratch_bytes = (size_t)(4.0 * rows * (double)job->samples) });
}

// One task for each shape that light enters.
static bool run_response_modes(const struct bake_task *task)
{
    const struct mrt_bake_job *job = task->job;
    struct matrix_f32 g;
    struct mrt_response response;
    if (!mrt_bake_input(task, "interface/G", &g)) return false;
    g = matrix_f32_block(&g, task->index * (size_t)job->entered_texels, 0,
                         (size_t)job->entered_texels, g.columns);
    if (!mrt_response_init(task->host, &g, (int)job->k_r, &response)) return false;
    const struct matrix_f32 *parts[] = { &response.u_r, &response.t_r, &response.lift };
    for (int i = 0; i < 3; i++)
        memcpy(task->out[i], parts[i]->at, parts[i]->rows * parts[i]->columns * sizeof(float));
    mrt_response_finish(task->host, &response);
    return true;
}

static bool add_response_modes(struct bake_plan *plan, const struct mrt_bake_job *job)
{
    const uint64_t count = (uint64_t)job->entered, m = job->entered_texels;
    const int wave = job->wave_final + 1;
    return bake_plan_add(
        plan, &(struct bake_stage){
                  .name = "response modes",
                  .wave = wave,
                  .task_count = (size_t)count,
                  .run = run_response_modes,
                  BAKE_OUTPUTS(
                      BAKE_F32(BAKE_ROWS, "interface/U_r", BAKE_SAVED, count * m, job->k_r),
                      BAKE_F32(BAKE_ROWS, "interface/T_r", BAKE_SAVED, count * job->k_r, job->k_l),
                      BAKE_F32(BAKE_ROWS, "interface/lift", wave + 1, count * job->k_l, job->k_r)),
                  .flops = 10.0 * (double)(m * job->k_l) * (double)job->k_l,
                  .scratch_bytes = (size_t)(32 * m * job->k_l) });
}

// The lightfields of single r-coefficients.
static bool run_lift(const struct bake_task *task)
{
    const struct mrt_bake_job *job = task->job;
    const struct round_names *names = task->argument;
    struct mrt_span span = { .parts = 1 };
    struct matrix_f32 lift;
    uint64_t first;
    struct matrix_f32 out = mrt_bake_output(task, 0, &first);
    if (!mrt_bake_input(task, names->basis, &span.part[0]) ||
        !mrt_bake_input(task, "interface/lift", &lift))
        return false;
    const size_t index = (size_t)(first / job->samples), k_l = (size_t)job->k_l;
    lift = matrix_f32_block(&lift, index * k_l, 0, k_l, lift.columns);
    return mrt_span_apply(task->host, &span, (size_t)(first % job->samples), &lift, &out);
}

static bool add_lift(struct bake_plan *plan, const struct mrt_bake_job *job,
                     const struct round_names *names)
{
    const uint64_t count = (uint64_t)job->entered;
    return bake_plan_add(
        plan,
        &(struct bake_stage){ .name = "response lightfields",
                              .wave = job->wave_final + 2,
                              .task_count = (size_t)count * row_tasks(job),
                              .run = run_lift,
                              .argument = names,
                              BAKE_OUTPUTS(BAKE_F32(BAKE_ROWS, "interface/H_r", job->wave_final + 3,
                                                    count * job->samples, job->k_r)) });
}

static bool add_responses(struct bake_plan *plan, const struct mrt_bake_job *job,
                          const struct round_names *last)
{
    struct response_stage *stages = bake_plan_alloc(plan, 3, sizeof *stages);
    struct mrt_last_basis *holes = bake_plan_alloc(plan, 1, sizeof *holes);
    if (!stages || !holes) return false;
    *holes = (struct mrt_last_basis){ last->basis, last->sigma };
    for (int m = 0; m < 3; m++)
        stages[m] = (struct response_stage){ (enum mrt_measure)m,
                                             m == MRT_IRRADIANCE ? last->basis : "interface/H_r",
                                             m == MRT_PROBE ? job->probes : job->entered_texels };
    const uint64_t count = (uint64_t)job->entered, texels = count * job->entered_texels;
    const struct bake_output g =
        BAKE_F32(BAKE_ROWS, "interface/G", job->wave_final + 1, texels, job->k_l);
    const struct bake_output vec = BAKE_F32(BAKE_ROWS, "interface/U_rvec", BAKE_SAVED, texels,
                                            MRT_VECTOR_COEFFICIENTS, job->k_r);
    const struct bake_output vol = BAKE_F32(BAKE_ROWS, "interface/U_rvol", BAKE_SAVED,
                                            count * job->probes, MRT_PROBE_COEFFICIENTS, job->k_r);
    return add_response(plan, job, "response", job->wave_final, &stages[0], &g) &&
           add_project(plan, job, last) && add_response_modes(plan, job) &&
           mrt_hole_products(plan, job, holes) && add_operators(plan, job, last) &&
           mrt_hole_operators(plan, job, holes) && add_lift(plan, job, last) &&
           add_response(plan, job, "response directions", job->wave_final + 3, &stages[1], &vec) &&
           add_response(plan, job, "response probes", job->wave_final + 3, &stages[2], &vol);
}

bool mrt_interface_bake(struct bake_plan *plan, const struct mrt_bake_job *job)
{
    const struct round_names *names = NULL;
    bool ok = add_lightfields(plan, job);
    for (int round = 0; ok && round <= job->options.lightfield_rounds; round++) {
        names = names_of_round(plan, round);
        const uint64_t columns =
            round == 0 ? job->openings * job->k_b : (uint64_t)(1 + job->turns) * job->k_l;
        ok = names && add_reduction(plan, job, names, columns) && add_propagation(plan, job, names);
    }
    return ok && add_responses(plan, job, names);
}
