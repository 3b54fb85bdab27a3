// Accumulation of sparse rows.
#include "sparse_row.h"

#include <string.h>

bool sparse_row_init(struct host *host, struct sparse_row *row, size_t columns)
{
    *row = (struct sparse_row){ .columns = columns };
    row->weight = host_alloc(host, columns, sizeof *row->weight);
    row->touched = host_alloc(host, columns, sizeof *row->touched);
    row->is_touched = host_alloc(host, columns, sizeof *row->is_touched);
    if (row->weight && row->touched && row->is_touched) return true;
    sparse_row_finish(host, row);
    return false;
}

void sparse_row_finish(struct host *host, struct sparse_row *row)
{
    host_free(host, row->weight);
    host_free(host, row->touched);
    host_free(host, row->is_touched);
    *row = (struct sparse_row){ 0 };
}

void sparse_row_add(struct sparse_row *row, size_t column, float weight)
{
    if (!row->is_touched[column]) {
        row->is_touched[column] = 1;
        row->touched[row->count++] = (uint32_t)column;
    }
    row->weight[column] += weight;
}

void sparse_row_apply(struct sparse_row *row, float scale, const struct matrix_f32 *matrix,
                      float *out)
{
    memset(out, 0, matrix->columns * sizeof *out);
    for (size_t i = 0; i < row->count; i++) {
        size_t column = row->touched[i];
        const float *from = matrix->at + column * matrix->stride;
        float weight = scale * row->weight[column];
        for (size_t c = 0; c < matrix->columns; c++) out[c] += weight * from[c];
        row->weight[column] = 0.0f;
        row->is_touched[column] = 0;
    }
    row->count = 0;
}
