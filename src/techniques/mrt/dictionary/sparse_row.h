// A row of a sparse operator: weights are added in any order, then applied to the rows of a dense
// matrix.
#pragma once

#include "core/linalg.h"

#include <stdint.h>

struct sparse_row {
    float *weight;     // columns, 0 where nothing was added
    uint32_t *touched; // the first `count` columns added to, in order
    uint8_t *is_touched;
    size_t columns, count;
};

bool sparse_row_init(struct host *host, struct sparse_row *row, size_t columns);
void sparse_row_finish(struct host *host, struct sparse_row *row);
void sparse_row_add(struct sparse_row *row, size_t column, float weight);
// out[0 … matrix->columns) = scale · row · matrix; the row is empty afterwards.
void sparse_row_apply(struct sparse_row *row, float scale, const struct matrix_f32 *matrix,
                      float *out);
