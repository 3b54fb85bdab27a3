// Stages of a dictionary's bake: the closed cube, the light prior and the transfer of each shape.
// interface_bake.c adds the interfaces.
#include "dictionary.h"

#include "techniques/mrt/dictionary/bake_stages.h"
#include "techniques/mrt/dictionary/cube_operators.h"
#include "techniques/mrt/dictionary/gather.h"
#include "techniques/mrt/dictionary/prior.h"
#include "techniques/mrt/dictionary/transfer.h"
#include "techniques/mrt/dictionary/tube_bake.h"
#include "techniques/mrt/dictionary/tube_symmetry.h"

#include <math.h>
#include <string.h>

// Of a stage: the measure or the shape.
struct stage_index {
    int measure, shape;
    const char *direct, *l_imp; // names of inputs
};

static const char *const OPERATORS[] = { "closed/F", "closed/vector", "closed/probe" };

// ---- the closed cube

static bool run_gather(const struct bake_task *task)
{
    const struct mrt_bake_job *job = task->job;
    const struct stage_index *index = task->argument;
    const struct mrt_rays *rays = &job->rays[index->measure];
    const struct mrt_shape shape = mrt_cube(job->options.texels, 0);
    uint64_t first, points;
    const struct matrix_f32 out = mrt_bake_output(task, 0, &first);
    bake_task_rows(task, 0, &points);
    for (uint64_t i = 0; i < points; i++) {
        if (bake_task_cancelled(task)) return false;
        struct mrt_point at = mrt_gather_point(&shape, job->options.block_probes,
                                               (enum mrt_measure)index->measure, (int)(first + i));
        mrt_gather(&shape, at, rays, out.at + i * (uint64_t)rays->values * out.stride, out.stride);
    }
    return true;
}

static bool add_gather(struct bake_plan *plan, const struct mrt_bake_job *job, int measure)
{
    static const char *const names[] = { "gather irradiance", "gather vector irradiance",
                                         "gather probes" };
    static const uint64_t values[] = { 1, MRT_VECTOR_COEFFICIENTS, MRT_PROBE_COEFFICIENTS };
    enum { POINTS_PER_TASK = 16 };
    uint64_t points = measure == MRT_PROBE ? job->probes : job->texels;
    size_t tasks = (size_t)((points + POINTS_PER_TASK - 1) / POINTS_PER_TASK);
    struct stage_index *index = bake_plan_alloc(plan, 1, sizeof *index);
    if (!index) return false;
    index->measure = measure;
    const struct bake_output out = { OPERATORS[measure],
                                     TENSOR_F32,
                                     3,
                                     { points, values[measure], job->texels },
                                     BAKE_ROWS,
                                     measure == MRT_IRRADIANCE ? WAVE_MODES : WAVE_ELEMENTS };
    return bake_plan_add(
        plan, &(struct bake_stage){
                  .name = names[measure],
                  .wave = WAVE_GATHER,
                  .task_count = tasks,
                  .run = run_gather,
                  .argument = index,
                  .outputs = &out,
                  .output_count = 1,
                  .rays = (double)points * job->options.rays / (double)tasks,
                  .texels = measure == MRT_IRRADIANCE ? (double)points / (double)tasks : 0 });
}

// ---- the light prior of a shape

// Lights that are traced; a bend's stand for four each.
static int traced_lights(const struct mrt_shape *shape)
{
    const bool bend = shape->kind == MRT_TUBE_LEFT || shape->kind == MRT_TUBE_RIGHT;
    return bend ? tube_light_orbits() : mrt_prior_light_count(shape);
}

static bool run_direct(const struct bake_task *task)
{
    const struct mrt_bake_job *job = task->job;
    const struct stage_index *index = task->argument;
    const struct mrt_shape shape = mrt_bake_shape(job, index->shape);
    // Lights inside take no rays: in steps of a prime that does not divide their number, all tasks
    // get a share of them, so that times can be predicted.
    enum { STEP = 89 };
    const size_t count = (size_t)traced_lights(&shape);
    const size_t all = (size_t)mrt_prior_light_count(&shape);
    uint64_t first;
    const struct matrix_f32 out = mrt_bake_output(task, 0, &first);
    struct mrt_prior_light *lights = host_alloc(task->host, all, sizeof *lights);
    if (!lights) return false;
    mrt_prior_lights(&shape, lights);
    for (size_t l = 0; l < out.rows; l++) {
        const int i = (int)((first + l) * STEP % count);
        mrt_prior_column(&shape, lights[count < all ? tube_light_representative(i) : i],
                         out.at + l * out.stride, 1);
    }
    host_free(task->host, lights);
    return true;
}

static bool add_direct(struct bake_plan *plan, const struct mrt_bake_job *job,
                       const struct stage_index *index)
{
    enum { LIGHTS_PER_TASK = 36, TUBE_LIGHTS_PER_TASK = 12 };
    const struct mrt_shape shape = mrt_bake_shape(job, index->shape);
    const uint64_t lights = (uint64_t)traced_lights(&shape);
    const uint64_t per_task = shape.kind == MRT_CUBE ? LIGHTS_PER_TASK : TUBE_LIGHTS_PER_TASK;
    const struct bake_output out = {
        index->direct, TENSOR_F32, 2, { lights, (uint64_t)mrt_shape_texels(&shape) },
        BAKE_ROWS,     WAVE_MODES
    };
    return bake_plan_add(
        plan,
        &(struct bake_stage){
            .name = bake_plan_name(plan, "%s %d lights", job->family, index->shape),
            .wave = WAVE_GATHER,
            .task_count = (size_t)(lights / per_task),
            .run = run_direct,
            .argument = index,
            .outputs = &out,
            .output_count = 1,
            .rays = mrt_prior_rays(&shape) * (double)per_task / mrt_prior_light_count(&shape) });
}

// ---- the modes of a shape

static bool operator_of(const struct bake_task *task, int measure, const struct stage_index *index,
                        struct matrix_f64 *out)
{
    const struct mrt_shape shape = mrt_bake_shape(task->job, index->shape);
    struct mrt_cube_operators closed = { 0 };
    if (shape.kind != MRT_CUBE) return mrt_tube_operator(task, index->shape, out);
    return mrt_bake_input(task, OPERATORS[measure], &closed.by_measure[measure]) &&
           mrt_cube_operator_of(task->host, &closed, (enum mrt_measure)measure, &shape, out);
}

static bool direct_light(const struct bake_task *task, const char *name,
                         const struct mrt_shape *shape, struct matrix_f64 *out)
{
    struct matrix_f32 direct;
    const size_t lights = (size_t)mrt_prior_light_count(shape);
    if (!mrt_bake_input(task, name, &direct) ||
        !matrix_f64_init(task->host, out, direct.columns, lights))
        return false;
    for (size_t c = 0; c < lights; c++) {
        const struct tube_motion motion = tube_bend_motion((int)(c / direct.rows));
        const float *column = direct.at + c % direct.rows * direct.stride;
        for (size_t r = 0; r < out->rows; r++) {
            const size_t to =
                lights == direct.rows ? r : (size_t)tube_moved_texel(shape, motion, (int)r);
            out->at[to * out->stride + c] = (double)column[r];
        }
    }
    return true;
}

static void store(const double *from, size_t count, float *to)
{
    for (size_t i = 0; i < count; i++) to[i] = (float)from[i];
}

enum { OUT_U_B, OUT_T_DB, OUT_L_IMP, OUT_SIGMA_L, OUT_SIGMA_M, OUT_CHECKS };

static void store_transfer(const struct mrt_transfer *transfer, void *const *out)
{
    const struct matrix_f64 *u = &transfer->u_b, *t = &transfer->t_db, *l = &transfer->l_imp;
    const double checks[] = { transfer->orthonormality, transfer->implicit_error };
    store(u->at, u->rows * u->columns, out[OUT_U_B]);
    store(t->at, t->rows * t->columns, out[OUT_T_DB]);
    store(l->at, l->rows * l->columns, out[OUT_L_IMP]);
    store(transfer->sigma_l, transfer->sigma_l_count, out[OUT_SIGMA_L]);
    store(transfer->sigma_m, transfer->sigma_m_count, out[OUT_SIGMA_M]);
    store(checks, 2, out[OUT_CHECKS]);
}

static bool run_modes(const struct bake_task *task)
{
    const struct mrt_bake_job *job = task->job;
    const struct stage_index *index = task->argument;
    const struct mrt_shape shape = mrt_bake_shape(job, index->shape);
    const struct mrt_transfer_options options = { .k_d = job->options.prior_modes,
                                                  .k_b = job->options.modes,
                                                  .enrich = job->options.enrich };
    struct matrix_f64 f = { 0 }, direct = { 0 };
    struct mrt_transfer transfer = { 0 };
    bool ok = operator_of(task, MRT_IRRADIANCE, index, &f) &&
              direct_light(task, index->direct, &shape, &direct) &&
              mrt_transfer_init(task->host, &shape, &f, &direct, &options, &transfer);
    if (ok) store_transfer(&transfer, task->out);
    mrt_transfer_finish(task->host, &transfer);
    matrix_f64_finish(task->host, &direct);
    matrix_f64_finish(task->host, &f);
    return ok;
}

static bool add_modes(struct bake_plan *plan, const struct mrt_bake_job *job,
                      const struct stage_index *index)
{
    const struct mrt_shape shape = mrt_bake_shape(job, index->shape);
    const uint64_t n = (uint64_t)mrt_shape_texels(&shape), k_b = job->k_b;
    const uint64_t lights = (uint64_t)mrt_prior_light_count(&shape);
    const uint64_t k_d = (uint64_t)job->options.prior_modes, small = n < lights ? n : lights;
    const char *names[] = { "U_b", "T_db", "L_imp", "sigma_L", "sigma_M", "checks" };
    for (int i = 0; i <= OUT_CHECKS; i++)
        names[i] = bake_plan_name(plan, "%s/%d/%s", job->family, index->shape, names[i]);
    const struct bake_output outputs[] = {
        { names[OUT_U_B], TENSOR_F32, 2, { n, k_b }, BAKE_ROWS, BAKE_SAVED },
        { names[OUT_T_DB], TENSOR_F32, 2, { k_b, n }, BAKE_ROWS, BAKE_SAVED },
        { names[OUT_L_IMP], TENSOR_F32, 2, { n, k_b }, BAKE_ROWS, BAKE_SAVED },
        { names[OUT_SIGMA_L], TENSOR_F32, 1, { small }, BAKE_ROWS, BAKE_SAVED },
        { names[OUT_SIGMA_M], TENSOR_F32, 1, { k_d }, BAKE_ROWS, BAKE_SAVED },
        { names[OUT_CHECKS], TENSOR_F32, 1, { 2 }, BAKE_ROWS, BAKE_SAVED },
    };
    const double flops = 10.0 * (double)(n * lights * small) + 6.0 * (double)(n * n * k_d);
    return bake_plan_add(plan,
                         &(struct bake_stage){
                             .name = bake_plan_name(plan, "%s %d modes", job->family, index->shape),
                             .wave = WAVE_MODES,
                             .task_count = 1,
                             .run = run_modes,
                             .argument = index,
                             .outputs = outputs,
                             .output_count = OUT_CHECKS + 1,
                             .flops = flops,
                             .scratch_bytes = (size_t)(8 * (n * n + 4 * n * lights)) });
}

// ---- singular values of F, for the report

static bool run_spectrum(const struct bake_task *task)
{
    const struct stage_index *index = task->argument;
    struct matrix_f64 f = { 0 }, gram = { 0 };
    struct linalg_eigen eigen = { 0 };
    bool ok =
        operator_of(task, MRT_IRRADIANCE, index, &f) &&
        matrix_f64_init(task->host, &gram, f.rows, f.rows) &&
        matrix_f64_multiply(task->host, 1.0, &f, TRANSPOSED, &f, NOT_TRANSPOSED, 0.0, &gram) &&
        linalg_symmetric_eigen(task->host, "the one-bounce operator", &gram, &eigen);
    for (size_t i = 0; ok && i < f.rows; i++)
        ((float *)task->out[0])[i] = (float)sqrt(fmax(eigen.values[i], 0.0));
    linalg_eigen_finish(task->host, &eigen);
    matrix_f64_finish(task->host, &gram);
    matrix_f64_finish(task->host, &f);
    return ok;
}

static bool add_spectrum(struct bake_plan *plan, const struct mrt_bake_job *job,
                         const struct stage_index *index)
{
    const struct mrt_shape shape = mrt_bake_shape(job, index->shape);
    const uint64_t n = (uint64_t)mrt_shape_texels(&shape);
    const struct bake_output out = { bake_plan_name(plan, "%s/%d/sigma_F", job->family,
                                                    index->shape),
                                     TENSOR_F32,
                                     1,
                                     { n },
                                     BAKE_ROWS,
                                     BAKE_REPORTED };
    return bake_plan_add(plan,
                         &(struct bake_stage){ .name = bake_plan_name(plan, "%s %d spectrum",
                                                                      job->family, index->shape),
                                               .wave = WAVE_MODES,
                                               .task_count = 1,
                                               .run = run_spectrum,
                                               .argument = index,
                                               .outputs = &out,
                                               .output_count = 1,
                                               .flops = 12.0 * (double)(n * n * n),
                                               .scratch_bytes = (size_t)(40 * n * n) });
}

// ---- directional light of a shape

// U_vec and U_bvol: gathering L_imp.
static bool gather_implicit(const struct bake_task *task, int measure, int output,
                            const struct stage_index *index, const struct matrix_f64 *l_imp)
{
    struct matrix_f64 gather = { 0 }, out = { 0 };
    bool ok = operator_of(task, measure, index, &gather) &&
              matrix_f64_init(task->host, &out, gather.rows, l_imp->columns) &&
              matrix_f64_multiply(task->host, 1.0, &gather, NOT_TRANSPOSED, l_imp, NOT_TRANSPOSED,
                                  0.0, &out);
    if (ok) store(out.at, out.rows * out.columns, task->out[output]);
    matrix_f64_finish(task->host, &out);
    matrix_f64_finish(task->host, &gather);
    return ok;
}

static bool run_directional(const struct bake_task *task)
{
    const struct stage_index *index = task->argument;
    struct matrix_f32 narrow;
    struct matrix_f64 l_imp = { 0 };
    bool ok = mrt_bake_input(task, index->l_imp, &narrow) &&
              matrix_f64_from_f32(task->host, &narrow, &l_imp) &&
              gather_implicit(task, MRT_VECTOR, 0, index, &l_imp) &&
              gather_implicit(task, MRT_PROBE, 1, index, &l_imp);
    matrix_f64_finish(task->host, &l_imp);
    return ok;
}

static bool add_directional(struct bake_plan *plan, const struct mrt_bake_job *job,
                            const struct stage_index *index)
{
    const struct mrt_shape shape = mrt_bake_shape(job, index->shape);
    const uint64_t n = (uint64_t)mrt_shape_texels(&shape);
    const struct bake_output outputs[] = {
        { bake_plan_name(plan, "%s/%d/U_vec", job->family, index->shape),
          TENSOR_F32,
          3,
          { n, MRT_VECTOR_COEFFICIENTS, job->k_b },
          BAKE_ROWS,
          BAKE_SAVED },
        { bake_plan_name(plan, "%s/%d/U_bvol", job->family, index->shape),
          TENSOR_F32,
          3,
          { job->probes, MRT_PROBE_COEFFICIENTS, job->k_b },
          BAKE_ROWS,
          BAKE_SAVED },
    };
    return bake_plan_add(plan,
                         &(struct bake_stage){ .name = bake_plan_name(plan, "%s %d directions",
                                                                      job->family, index->shape),
                                               .wave = WAVE_ELEMENTS,
                                               .task_count = 1,
                                               .run = run_directional,
                                               .argument = index,
                                               .outputs = outputs,
                                               .output_count = 2,
                                               .flops = 8.0 * (double)(n * n * job->k_b),
                                               .scratch_bytes = (size_t)(8 * 4 * n * n) });
}

// ---- the plan

static bool prepare_job(void *user, struct host *host)
{
    struct mrt_bake_job *job = user;
    job->host = host;
    for (int m = 0; m < 3; m++)
        if (!mrt_rays_init(host, (enum mrt_measure)m, job->options.rays, &job->rays[m]))
            return false;
    return true;
}

static void finish_job(void *user)
{
    struct mrt_bake_job *job = user;
    for (int m = 0; m < 3; m++) mrt_rays_finish(job->host, &job->rays[m]);
}

static void set_sizes(const struct mrt_dictionary_options *o, struct mrt_bake_job *job)
{
    const enum mrt_maze maze = mrt_dictionary_maze(o);
    const struct mrt_shape closed = mrt_cube(o->texels, 0);
    const struct mrt_shape entered = mrt_entered_shape(maze, o->texels, 0);
    *job = (struct mrt_bake_job){
        .options = *o,
        .maze = maze,
        .shapes = mrt_dictionary_shapes(maze),
        .baked = maze == MRT_TUNNEL ? MRT_TUBE_RIGHT - MRT_TUBE : mrt_dictionary_shapes(maze),
        .entered = mrt_entered_shapes(maze),
        .family = maze == MRT_TUNNEL ? "tube" : "cube",
        .turns = maze == MRT_MAZE_3D ? MRT_TURNS_3D : MRT_TURNS_2D,
        .k_b = (uint64_t)o->modes,
        .k_l = (uint64_t)o->lightfield_modes,
        .k_r = (uint64_t)o->response_modes,
        .texels = (uint64_t)mrt_shape_texels(&closed),
        .entered_texels = (uint64_t)mrt_shape_texels(&entered),
        .probes = (uint64_t)(o->block_probes * o->block_probes * o->block_probes),
        .openings = (uint64_t)mrt_dictionary_openings(maze),
        .lightfield = { o->lightfield_positions, o->lightfield_directions,
                        o->lightfield_supersampling, maze == MRT_TUNNEL },
        .wave_final = mrt_wave_of_round(o->lightfield_rounds) + 3,
    };
    job->samples = mrt_lightfield_samples(job->lightfield);
}

static struct stage_index *index_of_shape(struct bake_plan *plan, const struct mrt_bake_job *job,
                                          int shape)
{
    struct stage_index *index = bake_plan_alloc(plan, 1, sizeof *index);
    if (!index) return NULL;
    index->shape = shape;
    index->direct = bake_plan_name(plan, "%s/%d/direct", job->family, shape);
    index->l_imp = bake_plan_name(plan, "%s/%d/L_imp", job->family, shape);
    return index->direct && index->l_imp ? index : NULL;
}

static bool add_gathers(struct bake_plan *plan, const struct mrt_bake_job *job,
                        struct stage_index *const *shape)
{
    bool ok = true;
    if (job->maze == MRT_TUNNEL)
        for (int i = 0; ok && i < job->baked; i++)
            ok = mrt_tube_gather(plan, job, i) && mrt_tube_vector_gather(plan, job, i);
    else
        for (int m = 0; ok && m < 3; m++) ok = add_gather(plan, job, m);
    for (int i = 0; ok && i < job->baked; i++) ok = add_direct(plan, job, shape[i]);
    return ok;
}

static bool add_directions(struct bake_plan *plan, const struct mrt_bake_job *job,
                           struct stage_index *const *shape)
{
    const bool tubes = job->maze == MRT_TUNNEL;
    bool ok = true;
    for (int i = 0; ok && i < job->baked; i++)
        ok = tubes ? mrt_tube_directions(plan, job, i) : add_directional(plan, job, shape[i]);
    return ok && (!tubes || mrt_tube_mirror_modes(plan, job));
}

bool mrt_dictionary_bake(struct bake_plan *plan, const struct mrt_dictionary_options *options,
                         bool full)
{
    struct mrt_bake_job *job = bake_plan_alloc(plan, 1, sizeof *job);
    struct stage_index *shape[MRT_MAX_CUBES];
    if (!job) return false;
    set_sizes(options, job);
    bake_plan_set_job(plan, &(struct bake_job){ .job = job,
                                                .prepare = prepare_job,
                                                .finish = finish_job,
                                                .bytes = (size_t)options->rays * 100 });
    bool ok = true;
    for (int i = 0; ok && i < job->shapes; i++)
        ok = (shape[i] = index_of_shape(plan, job, i)) != NULL;
    ok = ok && add_gathers(plan, job, shape);
    for (int i = 0; ok && i < job->baked; i++)
        ok = add_modes(plan, job, shape[i]) && (!full || add_spectrum(plan, job, shape[i]));
    return ok && add_directions(plan, job, shape) &&
           (job->maze != MRT_TUNNEL || mrt_tube_mirror_directions(plan, job)) &&
           mrt_interface_bake(plan, job);
}
