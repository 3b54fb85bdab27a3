// Operators of tubes by symmetry.
#include "tube_bake.h"

#include "techniques/mrt/dictionary/cube_operators.h"
#include "techniques/mrt/dictionary/prior.h"
#include "techniques/mrt/dictionary/tube_symmetry.h"

bool mrt_tube_operator(const struct bake_task *task, int i, struct matrix_f64 *out)
{
    const struct mrt_shape shape = mrt_bake_shape(task->job, i);
    const size_t n = (size_t)mrt_shape_texels(&shape);
    struct matrix_f32 rows;
    if (!mrt_bake_shape_input(task, i, "F", &rows) || !matrix_f64_init(task->host, out, n, n))
        return false;
    for (size_t t = 0; t < n; t++) {
        struct tube_motion motion;
        const float *row = rows.at + (size_t)tube_orbit_of(&shape, (int)t, &motion) * rows.stride;
        for (size_t k = 0; k < n; k++) {
            const int moved = tube_moved_texel(&shape, motion, (int)k);
            out->at[t * out->stride + (size_t)moved] = (double)row[k];
        }
    }
    return true;
}

// ---- directional light: operators are too large to keep, so their rows meet L_imp at once

static bool run_probes(const struct bake_task *task)
{
    const struct mrt_bake_job *job = task->job;
    const struct mrt_shape_stage *stage = task->argument;
    const struct mrt_shape shape = mrt_bake_shape(job, stage->shape);
    struct matrix_f32 l_imp, gather = { 0 };
    uint64_t unused;
    struct matrix_f32 out = mrt_bake_output(task, 0, &unused);
    bool ok = mrt_bake_shape_input(task, stage->shape, "L_imp", &l_imp) &&
              matrix_f32_init(task->host, &gather, out.rows, l_imp.rows) &&
              mrt_bake_gather(task, &shape, MRT_PROBE, &gather) &&
              matrix_f32_multiply(task->host, 1.0f, &gather, NOT_TRANSPOSED, &l_imp, NOT_TRANSPOSED,
                                  0.0f, &out);
    matrix_f32_finish(task->host, &gather);
    return ok;
}

static bool run_vector(const struct bake_task *task)
{
    const struct mrt_bake_job *job = task->job;
    const struct mrt_shape_stage *stage = task->argument;
    const struct mrt_shape shape = mrt_bake_shape(job, stage->shape);
    struct matrix_f32 l_imp, rows, moved = { 0 };
    uint64_t unused, points;
    struct matrix_f32 out = mrt_bake_output(task, 0, &unused);
    const uint64_t first = bake_task_rows(task, 0, &points);
    bool ok = mrt_bake_shape_input(task, stage->shape, "L_imp", &l_imp) &&
              mrt_bake_shape_input(task, stage->shape, "vector", &rows) &&
              matrix_f32_init(task->host, &moved, out.rows, l_imp.rows);
    for (uint64_t i = 0; ok && i < points; i++) {
        struct tube_motion motion;
        const int orbit = tube_orbit_of(&shape, (int)(first + i), &motion);
        struct matrix_f32 from = matrix_f32_block(&rows, (size_t)orbit * MRT_VECTOR_COEFFICIENTS, 0,
                                                  MRT_VECTOR_COEFFICIENTS, rows.columns);
        struct matrix_f32 to = matrix_f32_block(&moved, i * MRT_VECTOR_COEFFICIENTS, 0,
                                                MRT_VECTOR_COEFFICIENTS, moved.columns);
        tube_moved_rows(&shape, motion, MRT_VECTOR_COEFFICIENTS, &from, &to);
    }
    ok = ok && !bake_task_cancelled(task) &&
         matrix_f32_multiply(task->host, 1.0f, &moved, NOT_TRANSPOSED, &l_imp, NOT_TRANSPOSED, 0.0f,
                             &out);
    matrix_f32_finish(task->host, &moved);
    return ok;
}

// Rows of U_vec or U_bvol.
static bool add_directional(struct bake_plan *plan, const struct mrt_bake_job *job,
                            const struct mrt_shape_stage *stage, const char *what,
                            struct bake_stage added)
{
    const struct mrt_shape shape = mrt_bake_shape(job, stage->shape);
    const bool probes = stage->measure == MRT_PROBE;
    const uint64_t points = probes ? job->probes : (uint64_t)mrt_shape_texels(&shape);
    const uint64_t values = probes ? MRT_PROBE_COEFFICIENTS : MRT_VECTOR_COEFFICIENTS;
    const struct bake_output out = BAKE_F32(BAKE_ROWS, bake_plan_name(plan, what, stage->shape),
                                            BAKE_SAVED, points, values, job->k_b);
    added.wave = WAVE_ELEMENTS;
    added.task_count = mrt_point_tasks(points);
    added.argument = stage;
    added.outputs = &out;
    added.output_count = 1;
    return bake_plan_add(plan, &added);
}

bool mrt_tube_directions(struct bake_plan *plan, const struct mrt_bake_job *job, int i)
{
    const struct mrt_shape_stage *vector = mrt_shape_stage(plan, i, MRT_VECTOR);
    const struct mrt_shape_stage *probe = mrt_shape_stage(plan, i, MRT_PROBE);
    const struct mrt_shape shape = mrt_bake_shape(job, i);
    const double texels = (double)mrt_shape_texels(&shape);
    return vector && probe &&
           add_directional(plan, job, vector, "tube/%d/U_vec",
                           (struct bake_stage){
                               .name = bake_plan_name(plan, "tube %d directions", i),
                               .run = run_vector,
                               .flops = 8.0 * MRT_POINTS_PER_TASK * texels * (double)job->k_b }) &&
           add_directional(
               plan, job, probe, "tube/%d/U_bvol",
               (struct bake_stage){ .name = bake_plan_name(plan, "tube %d probes", i),
                                    .run = run_probes,
                                    .rays = (double)MRT_POINTS_PER_TASK * job->options.rays });
}

// ---- the right bend

static const struct {
    const char *name;
    bool by_texel, by_column;
} mirrored[] = {
    { "U_b", true, false },      { "T_db", false, true },     { "L_imp", true, false },
    { "sigma_L", false, false }, { "sigma_M", false, false }, { "checks", false, false },
};
enum { MIRRORED = sizeof mirrored / sizeof *mirrored };

static bool run_mirror_modes(const struct bake_task *task)
{
    const struct mrt_shape tube = mrt_bake_shape(task->job, MRT_TUBE_RIGHT - MRT_TUBE);
    for (int i = 0; i < MIRRORED; i++) {
        struct matrix_f32 from;
        uint64_t unused;
        struct matrix_f32 to = mrt_bake_output(task, i, &unused);
        if (!mrt_bake_shape_input(task, MRT_TUBE_LEFT - MRT_TUBE, mirrored[i].name, &from))
            return false;
        for (size_t r = 0; r < to.rows; r++)
            for (size_t c = 0; c < to.columns; c++) {
                size_t row = mirrored[i].by_texel ? (size_t)tube_mirrored_texel(&tube, (int)r) : r;
                size_t column =
                    mirrored[i].by_column ? (size_t)tube_mirrored_texel(&tube, (int)c) : c;
                to.at[r * to.stride + c] = from.at[row * from.stride + column];
            }
    }
    return true;
}

static bool run_mirror_directions(const struct bake_task *task)
{
    const struct mrt_bake_job *job = task->job;
    const struct mrt_shape tube = mrt_bake_shape(job, MRT_TUBE_RIGHT - MRT_TUBE);
    static const char *const names[] = { "U_vec", "U_bvol" };
    static const int values[] = { MRT_VECTOR_COEFFICIENTS, MRT_PROBE_COEFFICIENTS };
    for (int i = 0; i < 2; i++) {
        struct matrix_f32 from;
        uint64_t unused;
        struct matrix_f32 to = mrt_bake_output(task, i, &unused);
        if (!mrt_bake_shape_input(task, MRT_TUBE_LEFT - MRT_TUBE, names[i], &from)) return false;
        for (size_t r = 0; r < to.rows; r++) {
            const int point = (int)r / values[i], value = (int)r % values[i];
            const int source = i == 0 ? tube_mirrored_texel(&tube, point)
                                      : tube_mirrored_probe(job->options.block_probes, point);
            const size_t row = (size_t)(source * values[i] + value);
            for (size_t c = 0; c < to.columns; c++)
                to.at[r * to.stride + c] =
                    tube_mirrored_sign(values[i], value) * from.at[row * from.stride + c];
        }
    }
    return true;
}

bool mrt_tube_mirror_modes(struct bake_plan *plan, const struct mrt_bake_job *job)
{
    enum { RIGHT = MRT_TUBE_RIGHT - MRT_TUBE };
    const struct mrt_shape shape = mrt_bake_shape(job, RIGHT);
    const uint64_t n = (uint64_t)mrt_shape_texels(&shape), k_b = job->k_b;
    const uint64_t lights = (uint64_t)mrt_prior_light_count(&shape);
    const uint64_t rows[MIRRORED] = {
        n, k_b, n, n < lights ? n : lights, (uint64_t)job->options.prior_modes, 2
    };
    const uint64_t columns[MIRRORED] = { k_b, n, k_b };
    struct bake_output outputs[MIRRORED];
    for (int i = 0; i < MIRRORED; i++)
        outputs[i] = (struct bake_output){ bake_plan_name(plan, "tube/2/%s", mirrored[i].name),
                                           TENSOR_F32,
                                           columns[i] ? 2 : 1,
                                           { rows[i], columns[i] },
                                           BAKE_ROWS,
                                           BAKE_SAVED };
    return bake_plan_add(plan, &(struct bake_stage){ .name = "tube 2 modes",
                                                     .wave = WAVE_ELEMENTS,
                                                     .task_count = 1,
                                                     .run = run_mirror_modes,
                                                     .outputs = outputs,
                                                     .output_count = MIRRORED });
}

bool mrt_tube_mirror_directions(struct bake_plan *plan, const struct mrt_bake_job *job)
{
    return bake_plan_add(
        plan, &(struct bake_stage){
                  .name = "tube 2 directions",
                  .wave = WAVE_LIGHTFIELDS,
                  .task_count = 1,
                  .run = run_mirror_directions,
                  BAKE_OUTPUTS(BAKE_F32(BAKE_ROWS, "tube/2/U_vec", BAKE_SAVED, job->entered_texels,
                                        MRT_VECTOR_COEFFICIENTS, job->k_b),
                               BAKE_F32(BAKE_ROWS, "tube/2/U_bvol", BAKE_SAVED, job->probes,
                                        MRT_PROBE_COEFFICIENTS, job->k_b)) });
}
