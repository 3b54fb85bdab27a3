// Matrices of the tensors that a task reads and writes.
#include "bake_stages.h"

#include <stdio.h>

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
