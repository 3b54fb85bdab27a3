// Operators of the dictionary's shapes, rotated to the blocks of a level.
#pragma once

#include "core/linalg.h"
#include "core/vec.h"

#include "techniques/mrt/dictionary/rays.h"
#include "techniques/mrt/dictionary/shape.h"

// Texels and probes of `from`, rotated by to_from, are those of `to`.
struct mrt_rotation {
    struct mrt_shape from, to;
    mat3s to_from;
};

// Rows of light for each quantity of a measure.
static inline int mrt_values_of(enum mrt_measure measure)
{
    static const int values[MRT_MEASURES] = { 1, MRT_VECTOR_COEFFICIENTS, MRT_PROBE_COEFFICIENTS };
    return values[measure];
}

// Rows of light at the texels, or at p³ probes. Openings of `from` stay 0.
bool mrt_rotate_light(struct host *host, const struct mrt_rotation *turn, int p,
                      enum mrt_measure measure, const struct matrix_f32 *from,
                      struct matrix_f32 *out);
// Columns of the texels.
bool mrt_rotate_columns(struct host *host, const struct mrt_rotation *turn,
                        const struct matrix_f32 *from, struct matrix_f32 *out);
