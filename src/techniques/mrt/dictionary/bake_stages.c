// Arguments of stages, and matrices of the tensors that a task reads and writes.
#include "bake_stages.h"

#include "techniques/mrt/dictionary/cube_operators.h"
#include "techniques/mrt/dictionary/gather.h"
#include "techniques/mrt/dictionary/tube_symmetry.h"

#include <stdio.h>

const struct mrt_shape_stage *mrt_shape_stage(struct bake_plan *plan, int shape,
                                              enum mrt_measure measure)
{
    struct mrt_shape_stage *stage = bake_plan_alloc(plan, 1, sizeof *stage);
    if (stage) *stage = (struct mrt_shape_stage){ shape, measure };
    return stage;
}

static struct matrix_f32 matrix_over(void *at, int rank, const uint64_t *shape, uint64_t rows)
{
    size_t columns = (size_t)shape[rank - 1], all = (size_t)rows;
    for (int axis = 1; axis < rank - 1; axis++) all *= (size_t)shape[axis];
    return (struct matrix_f32){ at, all, columns, columns };
}

struct matrix_f32 mrt_tensor_matrix(const struct tensor *tensor)
{
    // Inputs are read only: the cast gives them the type that products take.
    return matrix_over((void *)(uintptr_t)tensor->data, tensor->rank, tensor->shape,
                       tensor->rank > 1 ? tensor->shape[0] : 1);
}

bool mrt_bake_input(const struct bake_task *task, const char *name, struct matrix_f32 *out)
{
    const struct tensor *tensor = bake_task_input(task, name);
    if (tensor) *out = mrt_tensor_matrix(tensor);
    return tensor != NULL;
}

struct matrix_f32 mrt_bake_output(const struct bake_task *task, int output, uint64_t *first_row)
{
    const struct bake_output *what = &task->outputs[output];
    uint64_t rows = what->rank > 1 ? what->shape[0] : 1;
    *first_row = 0;
    if (what->reduction == BAKE_ROWS && what->rank > 1)
        *first_row = bake_task_rows(task, output, &rows);
    return matrix_over(task->out[output], what->rank, what->shape, rows);
}

bool mrt_bake_shape_input(const struct bake_task *task, int shape, const char *what,
                          struct matrix_f32 *out)
{
    const struct mrt_bake_job *job = task->job;
    char name[32];
    snprintf(name, sizeof name, "%s/%d/%s", job->family, shape, what);
    return mrt_bake_input(task, name, out);
}

bool mrt_bake_gather(const struct bake_task *task, const struct mrt_shape *shape,
                     enum mrt_measure measure, const struct matrix_f32 *out)
{
    const struct mrt_bake_job *job = task->job;
    const struct mrt_rays *rays = &job->rays[measure];
    const bool orbits = shape->kind != MRT_CUBE && measure != MRT_PROBE;
    uint64_t points;
    const uint64_t first = bake_task_rows(task, 0, &points);
    for (uint64_t i = 0; i < points; i++) {
        const int at = (int)(first + i);
        if (bake_task_cancelled(task)) return false;
        mrt_gather(shape,
                   mrt_gather_point(shape, job->options.block_probes, measure,
                                    orbits ? tube_representative(shape, at) : at),
                   rays, out->at + i * (uint64_t)rays->values * out->stride, out->stride);
    }
    return true;
}
