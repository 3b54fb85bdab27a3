// Stages of a dictionary's bake: the closed cube, the light prior and the transfer of each shape.
// interface_bake.c adds the interfaces.
#include "dictionary.h"

#include "techniques/mrt/dictionary/bake_stages.h"
#include "techniques/mrt/dictionary/cube_operators.h"
#include "techniques/mrt/dictionary/prior.h"
#include "techniques/mrt/dictionary/transfer.h"
#include "techniques/mrt/dictionary/tube_bake.h"
#include "techniques/mrt/dictionary/tube_symmetry.h"

#include <math.h>
#include <string.h>

static const char *const OPERATORS[] = { "closed/F", "closed/vector", "closed/probe" };

// ---- gathers: of the closed cube, or by symmetry of a straight tube and a left bend

static struct mrt_shape gathered_shape(const struct mrt_bake_job *job, int i)
{
    return job->maze == MRT_TUNNEL ? mrt_bake_shape(job, i) : mrt_cube(job->options.texels, 0);
}

static bool run_gather(const struct bake_task *task)
{
    const struct mrt_shape_stage *stage = task->argument;
    const struct mrt_shape shape = gathered_shape(task->job, stage->shape);
    uint64_t first;
    const struct matrix_f32 out = mrt_bake_output(task, 0, &first);
    return mrt_bake_gather(task, &shape, stage->measure, &out);
}

static bool add_gather(struct bake_plan *plan, const struct mrt_bake_job *job, const char *name,
                       const char *output, int i, enum mrt_measure measure)
{
    static const uint64_t values[] = { 1, MRT_VECTOR_COEFFICIENTS, MRT_PROBE_COEFFICIENTS };
    const struct mrt_shape shape = gathered_shape(job, i);
    const uint64_t texels = (uint64_t)mrt_shape_texels(&shape);
    const uint64_t points = measure == MRT_PROBE      ? job->probes
                            : job->maze == MRT_TUNNEL ? (uint64_t)tube_orbits(&shape)
                                                      : texels;
    const double per_task = (double)points / (double)mrt_point_tasks(points);
    const bool irradiance = measure == MRT_IRRADIANCE;
    const struct mrt_shape_stage *stage = mrt_shape_stage(plan, i, measure);
    return stage &&
           bake_plan_add(plan, &(struct bake_stage){
                                   .name = name,
                                   .wave = WAVE_GATHER,
                                   .task_count = mrt_point_tasks(points),
                                   .run = run_gather,
                                   .argument = stage,
                                   BAKE_OUTPUTS(BAKE_F32(BAKE_ROWS, output,
                                                         irradiance ? WAVE_MODES : WAVE_ELEMENTS,
                                                         points, values[measure], texels)),
                                   .rays = per_task * job->options.rays,
                                   .texels = irradiance ? per_task : 0 });
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
    const struct mrt_shape_stage *stage = task->argument;
    const struct mrt_shape shape = mrt_bake_shape(job, stage->shape);
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
                       const struct mrt_shape_stage *stage)
{
    enum { LIGHTS_PER_TASK = 36, TUBE_LIGHTS_PER_TASK = 12 };
    const struct mrt_shape shape = mrt_bake_shape(job, stage->shape);
    const uint64_t lights = (uint64_t)traced_lights(&shape);
    const uint64_t per_task = shape.kind == MRT_CUBE ? LIGHTS_PER_TASK : TUBE_LIGHTS_PER_TASK;
    const char *direct = bake_plan_name(plan, "%s/%d/direct", job->family, stage->shape);
    return bake_plan_add(
        plan,
        &(struct bake_stage){
            .name = bake_plan_name(plan, "%s %d lights", job->family, stage->shape),
            .wave = WAVE_GATHER,
            .task_count = (size_t)(lights / per_task),
            .run = run_direct,
            .argument = stage,
            BAKE_OUTPUTS(BAKE_F32(BAKE_ROWS, direct, WAVE_MODES, lights,
                                  (uint64_t)mrt_shape_texels(&shape))),
            .rays = mrt_prior_rays(&shape) * (double)per_task / mrt_prior_light_count(&shape) });
}

// ---- the modes of a shape

static bool operator_of(const struct bake_task *task, enum mrt_measure measure, int i,
                        struct matrix_f64 *out)
{
    const struct mrt_shape shape = mrt_bake_shape(task->job, i);
    struct mrt_cube_operators closed = { 0 };
    if (shape.kind != MRT_CUBE) return mrt_tube_operator(task, i, out);
    return mrt_bake_input(task, OPERATORS[measure], &closed.by_measure[measure]) &&
           mrt_cube_operator_of(task->host, &closed, measure, &shape, out);
}

static bool direct_light(const struct bake_task *task, int i, const struct mrt_shape *shape,
                         struct matrix_f64 *out)
{
    struct matrix_f32 direct;
    const size_t lights = (size_t)mrt_prior_light_count(shape);
    if (!mrt_bake_shape_input(task, i, "direct", &direct) ||
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
    const struct mrt_shape_stage *stage = task->argument;
    const struct mrt_shape shape = mrt_bake_shape(job, stage->shape);
    const struct mrt_transfer_options options = { .k_d = job->options.prior_modes,
                                                  .k_b = job->options.modes,
                                                  .enrich = job->options.enrich };
    struct matrix_f64 f = { 0 }, direct = { 0 };
    struct mrt_transfer transfer = { 0 };
    bool ok = operator_of(task, MRT_IRRADIANCE, stage->shape, &f) &&
              direct_light(task, stage->shape, &shape, &direct) &&
              mrt_transfer_init(task->host, &shape, &f, &direct, &options, &transfer);
    if (ok) store_transfer(&transfer, task->out);
    mrt_transfer_finish(task->host, &transfer);
    matrix_f64_finish(task->host, &direct);
    matrix_f64_finish(task->host, &f);
    return ok;
}

static bool add_modes(struct bake_plan *plan, const struct mrt_bake_job *job,
                      const struct mrt_shape_stage *stage)
{
    const struct mrt_shape shape = mrt_bake_shape(job, stage->shape);
    const uint64_t n = (uint64_t)mrt_shape_texels(&shape), k_b = job->k_b;
    const uint64_t lights = (uint64_t)mrt_prior_light_count(&shape);
    const uint64_t k_d = (uint64_t)job->options.prior_modes, small = n < lights ? n : lights;
    const char *names[] = { "U_b", "T_db", "L_imp", "sigma_L", "sigma_M", "checks" };
    for (int i = 0; i <= OUT_CHECKS; i++)
        names[i] = bake_plan_name(plan, "%s/%d/%s", job->family, stage->shape, names[i]);
    const double flops = 10.0 * (double)(n * lights * small) + 6.0 * (double)(n * n * k_d);
    return bake_plan_add(
        plan, &(struct bake_stage){
                  .name = bake_plan_name(plan, "%s %d modes", job->family, stage->shape),
                  .wave = WAVE_MODES,
                  .task_count = 1,
                  .run = run_modes,
                  .argument = stage,
                  BAKE_OUTPUTS(BAKE_F32(BAKE_ROWS, names[OUT_U_B], BAKE_SAVED, n, k_b),
                               BAKE_F32(BAKE_ROWS, names[OUT_T_DB], BAKE_SAVED, k_b, n),
                               BAKE_F32(BAKE_ROWS, names[OUT_L_IMP], BAKE_SAVED, n, k_b),
                               BAKE_F32(BAKE_ROWS, names[OUT_SIGMA_L], BAKE_SAVED, small),
                               BAKE_F32(BAKE_ROWS, names[OUT_SIGMA_M], BAKE_SAVED, k_d),
                               BAKE_F32(BAKE_ROWS, names[OUT_CHECKS], BAKE_SAVED, 2)),
                  .flops = flops,
                  .scratch_bytes = (size_t)(8 * (n * n + 4 * n * lights)) });
}

// ---- singular values of F, for the report

static bool run_spectrum(const struct bake_task *task)
{
    const struct mrt_shape_stage *stage = task->argument;
    struct matrix_f64 f = { 0 }, gram = { 0 };
    struct linalg_eigen eigen = { 0 };
    bool ok =
        operator_of(task, MRT_IRRADIANCE, stage->shape, &f) &&
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
                         const struct mrt_shape_stage *stage)
{
    const struct mrt_shape shape = mrt_bake_shape(job, stage->shape);
    const uint64_t n = (uint64_t)mrt_shape_texels(&shape);
    const char *sigma = bake_plan_name(plan, "%s/%d/sigma_F", job->family, stage->shape);
    return bake_plan_add(
        plan, &(struct bake_stage){
                  .name = bake_plan_name(plan, "%s %d spectrum", job->family, stage->shape),
                  .wave = WAVE_MODES,
                  .task_count = 1,
                  .run = run_spectrum,
                  .argument = stage,
                  BAKE_OUTPUTS(BAKE_F32(BAKE_ROWS, sigma, BAKE_REPORTED, n)),
                  .flops = 12.0 * (double)(n * n * n),
                  .scratch_bytes = (size_t)(40 * n * n) });
}

// ---- directional light of a shape

// U_vec and U_bvol: gathering L_imp.
static bool gather_implicit(const struct bake_task *task, enum mrt_measure measure, int output,
                            const struct matrix_f64 *l_imp)
{
    const struct mrt_shape_stage *stage = task->argument;
    struct matrix_f64 gather = { 0 }, out = { 0 };
    bool ok = operator_of(task, measure, stage->shape, &gather) &&
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
    const struct mrt_shape_stage *stage = task->argument;
    struct matrix_f32 narrow;
    struct matrix_f64 l_imp = { 0 };
    bool ok = mrt_bake_shape_input(task, stage->shape, "L_imp", &narrow) &&
              matrix_f64_from_f32(task->host, &narrow, &l_imp) &&
              gather_implicit(task, MRT_VECTOR, 0, &l_imp) &&
              gather_implicit(task, MRT_PROBE, 1, &l_imp);
    matrix_f64_finish(task->host, &l_imp);
    return ok;
}

static bool add_directional(struct bake_plan *plan, const struct mrt_bake_job *job,
                            const struct mrt_shape_stage *stage)
{
    const struct mrt_shape shape = mrt_bake_shape(job, stage->shape);
    const uint64_t n = (uint64_t)mrt_shape_texels(&shape);
    const char *vec = bake_plan_name(plan, "%s/%d/U_vec", job->family, stage->shape);
    const char *vol = bake_plan_name(plan, "%s/%d/U_bvol", job->family, stage->shape);
    return bake_plan_add(
        plan,
        &(struct bake_stage){
            .name = bake_plan_name(plan, "%s %d directions", job->family, stage->shape),
            .wave = WAVE_ELEMENTS,
            .task_count = 1,
            .run = run_directional,
            .argument = stage,
            BAKE_OUTPUTS(BAKE_F32(BAKE_ROWS, vec, BAKE_SAVED, n, MRT_VECTOR_COEFFICIENTS, job->k_b),
                         BAKE_F32(BAKE_ROWS, vol, BAKE_SAVED, job->probes, MRT_PROBE_COEFFICIENTS,
                                  job->k_b)),
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

static bool add_gathers(struct bake_plan *plan, const struct mrt_bake_job *job)
{
    static const char *const names[] = { "gather irradiance", "gather vector irradiance",
                                         "gather probes" };
    bool ok = true;
    if (job->maze != MRT_TUNNEL) {
        for (int m = 0; ok && m < 3; m++)
            ok = add_gather(plan, job, names[m], OPERATORS[m], 0, (enum mrt_measure)m);
        return ok;
    }
    for (int i = 0; ok && i < job->baked; i++)
        ok = add_gather(plan, job, bake_plan_name(plan, "tube %d gather", i),
                        bake_plan_name(plan, "tube/%d/F", i), i, MRT_IRRADIANCE) &&
             add_gather(plan, job, bake_plan_name(plan, "tube %d gather by normal", i),
                        bake_plan_name(plan, "tube/%d/vector", i), i, MRT_VECTOR);
    return ok;
}

// For each shape; the right bend is the left one in a mirror.
static bool add_shapes(struct bake_plan *plan, const struct mrt_bake_job *job, bool full)
{
    const bool tubes = job->maze == MRT_TUNNEL;
    const struct mrt_shape_stage *shape[MRT_MAX_CUBES];
    bool ok = true;
    for (int i = 0; ok && i < job->baked; i++)
        ok = (shape[i] = mrt_shape_stage(plan, i, MRT_IRRADIANCE)) != NULL &&
             add_direct(plan, job, shape[i]);
    for (int i = 0; ok && i < job->baked; i++)
        ok = add_modes(plan, job, shape[i]) && (!full || add_spectrum(plan, job, shape[i]));
    for (int i = 0; ok && i < job->baked; i++)
        ok = tubes ? mrt_tube_directions(plan, job, i) : add_directional(plan, job, shape[i]);
    return ok &&
           (!tubes || (mrt_tube_mirror_modes(plan, job) && mrt_tube_mirror_directions(plan, job)));
}

bool mrt_dictionary_bake(struct bake_plan *plan, const struct mrt_dictionary_options *options,
                         bool full)
{
    struct mrt_bake_job *job = bake_plan_alloc(plan, 1, sizeof *job);
    if (!job) return false;
    set_sizes(options, job);
    bake_plan_set_job(plan, &(struct bake_job){ .job = job,
                                                .prepare = prepare_job,
                                                .finish = finish_job,
                                                .bytes = (size_t)options->rays * 100 });
    return add_gathers(plan, job) && add_shapes(plan, job, full) && mrt_interface_bake(plan, job);
}
