// Stages of a dictionary's bake for holes in walls, such as doors: the lightfields of the implicit
// lights at closed faces, and what a part of an interface lets pass.
//
// Light of a wall does not pass its own plane, so the lightfield at a closed face is that of the
// other walls. A lightfield with coefficients c is H c, H = H_rlf = U Σ. Of that, part (i, j) of
// the square lets pass M_ij H c, M_ij being 1 at positions in the part and 0 elsewhere, with the
// coefficients Σ⁻² Hᵀ M_ij H c. A hole is the sum of its parts.
#include "techniques/mrt/dictionary/bake_stages.h"
#include "techniques/mrt/dictionary/basis.h"

#include <math.h>

static bool has_hole_light(const struct mrt_bake_job *job, int shape, int face)
{
    const struct mrt_shape of = mrt_bake_shape(job, shape);
    return !mrt_shape_is_open(&of, face) && mrt_wall_may_have_holes(job->maze, face);
}

static size_t walls_of(const struct mrt_bake_job *job, int shape)
{
    size_t count = 0;
    for (int f = 0; f < CUBE_FACES; f++) count += has_hole_light(job, shape, f);
    return count;
}

// ---- products with the basis

// Adds those of the lightfields at a closed face, rows first … of the samples.
static bool project_wall(const struct bake_task *task, int i, int face,
                         const struct matrix_f32 *basis, size_t first, struct matrix_f32 *sum)
{
    const struct mrt_bake_job *job = task->job;
    const struct mrt_shape shape = mrt_bake_shape(job, i);
    struct matrix_f32 l_imp, light = { 0 };
    const bool ok = mrt_bake_shape_input(task, i, "L_imp", &l_imp) &&
                    matrix_f32_init(task->host, &light, basis->rows, l_imp.columns) &&
                    mrt_lightfield_of_surfaces(task->host, job->lightfield, &shape, face, &l_imp,
                                               first, &light) &&
                    mrt_project_add(task->host, basis, &light, 0, basis->rows, sum);
    matrix_f32_finish(task->host, &light);
    return ok;
}

static bool run_walls(const struct bake_task *task)
{
    const struct mrt_bake_job *job = task->job;
    const struct mrt_last_basis *last = task->argument;
    struct matrix_f32 basis;
    uint64_t rows, unused;
    const struct matrix_f32 out = mrt_bake_output(task, 0, &unused);
    if (!mrt_bake_input(task, last->basis, &basis)) return false;
    const uint64_t first = bake_rows(basis.rows, task->index, task->count, &rows);
    const struct matrix_f32 part =
        matrix_f32_block(&basis, (size_t)first, 0, (size_t)rows, basis.columns);
    const size_t k_b = (size_t)job->k_b;
    size_t column = 0;
    for (int i = 0; i < job->shapes; i++)
        for (int f = 0; f < CUBE_FACES; f++) {
            if (!has_hole_light(job, i, f)) continue;
            struct matrix_f32 sum = matrix_f32_block(&out, 0, column, out.rows, k_b);
            if (bake_task_cancelled(task) || !project_wall(task, i, f, &part, (size_t)first, &sum))
                return false;
            column += k_b;
        }
    return true;
}

// The share of position i of n in part `part` of an edge.
static float overlap(int i, int n, int part)
{
    const float low = fmaxf((float)i / (float)n, (float)part / MRT_HOLES);
    const float high = fminf((float)(i + 1) / (float)n, (float)(part + 1) / MRT_HOLES);
    return fmaxf(high - low, 0.0f) * (float)n;
}

// Task j: positions of row j.
static bool run_parts(const struct bake_task *task)
{
    const struct mrt_bake_job *job = task->job;
    const struct mrt_last_basis *last = task->argument;
    const int n = job->lightfield.positions;
    const size_t at_position = (size_t)(job->samples / (uint64_t)(n * n));
    struct matrix_f32 basis;
    uint64_t unused;
    const struct matrix_f32 out = mrt_bake_output(task, 0, &unused);
    if (!mrt_bake_input(task, last->basis, &basis)) return false;
    for (int i = 0; i < n; i++) {
        const size_t first = (task->index * (size_t)n + (size_t)i) * at_position;
        const struct matrix_f32 rows =
            matrix_f32_block(&basis, first, 0, at_position, basis.columns);
        for (int p = 0; p < MRT_HOLE_PARTS; p++) {
            const float share =
                overlap(i, n, p % MRT_HOLES) * overlap((int)task->index, n, p / MRT_HOLES);
            struct matrix_f32 sum =
                matrix_f32_block(&out, 0, (size_t)p * basis.columns, out.rows, basis.columns);
            if (share > 0.0f && !matrix_f32_multiply(task->host, share, &rows, TRANSPOSED, &rows,
                                                     NOT_TRANSPOSED, 1.0f, &sum))
                return false;
        }
    }
    return true;
}

// ---- operators

static bool run_operators(const struct bake_task *task)
{
    const struct mrt_bake_job *job = task->job;
    const struct mrt_last_basis *last = task->argument;
    struct matrix_f32 walls, parts, sigma;
    if (!mrt_bake_input(task, "interface/product/walls", &walls) ||
        !mrt_bake_input(task, "interface/product/holes", &parts) ||
        !mrt_bake_input(task, last->sigma, &sigma))
        return false;
    mrt_project_finish(&parts, &sigma, 0, (size_t)job->k_l, MRT_HOLE_PARTS, task->out[0]);
    int output = 1;
    size_t first = 0;
    for (int i = 0; i < job->shapes; i++) {
        const size_t count = walls_of(job, i);
        if (count == 0) continue;
        mrt_project_finish(&walls, &sigma, first, (size_t)job->k_b, count, task->out[output++]);
        first += count * (size_t)job->k_b;
    }
    return true;
}

enum { WALL_TASKS = 16 };

static uint64_t all_walls(const struct mrt_bake_job *job)
{
    uint64_t walls = 0;
    for (int i = 0; i < job->shapes; i++) walls += walls_of(job, i);
    return walls;
}

bool mrt_hole_products(struct bake_plan *plan, const struct mrt_bake_job *job,
                       const struct mrt_last_basis *last)
{
    const int wave = job->wave_final + 1;
    const uint64_t walls = all_walls(job), columns = walls * job->k_b;
    const double k_l = (double)job->k_l, samples = (double)job->samples;
    const double rays = samples * (double)walls * mrt_lightfield_subsamples(job->lightfield);
    const int rows = job->lightfield.positions;
    if (walls == 0) return true;
    return bake_plan_add(
               plan,
               &(struct bake_stage){ .name = "lightfields at walls",
                                     .wave = wave,
                                     .task_count = WALL_TASKS,
                                     .run = run_walls,
                                     .argument = last,
                                     BAKE_OUTPUTS(BAKE_F32(BAKE_SUM, "interface/product/walls",
                                                           wave + 1, job->k_l, columns)),
                                     .rays = rays / WALL_TASKS,
                                     .flops = 2.0 * samples * k_l * (double)columns / WALL_TASKS,
                                     .scratch_bytes =
                                         (size_t)(4 * job->samples * job->k_b / WALL_TASKS) }) &&
           bake_plan_add(plan,
                         &(struct bake_stage){
                             .name = "parts of interfaces",
                             .wave = wave,
                             .task_count = (size_t)rows,
                             .run = run_parts,
                             .argument = last,
                             BAKE_OUTPUTS(BAKE_F32(BAKE_SUM, "interface/product/holes", wave + 1,
                                                   job->k_l, MRT_HOLE_PARTS * job->k_l)),
                             .flops = 2.0 * samples * k_l * k_l / rows });
}

bool mrt_hole_operators(struct bake_plan *plan, const struct mrt_bake_job *job,
                        const struct mrt_last_basis *last)
{
    struct bake_output outputs[1 + MRT_MAX_CUBES] = {
        BAKE_F32(BAKE_ROWS, "interface/R_hole", BAKE_SAVED, MRT_HOLE_PARTS, job->k_l, job->k_l),
    };
    int count = 1;
    if (all_walls(job) == 0) return true;
    for (int i = 0; i < job->shapes; i++)
        if (walls_of(job, i) > 0)
            outputs[count++] =
                BAKE_F32(BAKE_ROWS, bake_plan_name(plan, "%s/%d/R_wall", job->family, i),
                         BAKE_SAVED, walls_of(job, i), job->k_l, job->k_b);
    return bake_plan_add(plan, &(struct bake_stage){ .name = "hole operators",
                                                     .wave = job->wave_final + 2,
                                                     .task_count = 1,
                                                     .run = run_operators,
                                                     .argument = last,
                                                     .outputs = outputs,
                                                     .output_count = count });
}
