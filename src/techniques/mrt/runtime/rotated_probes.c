// Probes in the frames of blocks.
#include "rotated_probes.h"

#include "core/sh.h"

#include "techniques/mrt/dictionary/cube_operators.h"
#include "techniques/mrt/level/probes.h"

#include <math.h>

// A rotated shape has its probes in the same places.
static int rotated_probe(int p, const struct mrt_probe_turn *turn, int i)
{
    vec3s at = mrt_gather_point(turn->to, p, MRT_PROBE, i).position;
    int nearest = 0;
    float least = INFINITY;
    at = glms_mat3_mulv(glms_mat3_transpose(turn->to_from), at);
    for (int k = 0; k < mrt_probes_of_block(p); k++) {
        float distance =
            glms_vec3_distance2(mrt_gather_point(turn->from, p, MRT_PROBE, k).position, at);
        if (!(distance < least)) continue;
        least = distance;
        nearest = k;
    }
    return nearest;
}

static void turn_probe(mat3s to_from, const float *from, size_t from_stride, float *to,
                       size_t to_stride, size_t columns)
{
    for (size_t c = 0; c < columns; c++) {
        float in[MRT_PROBE_VALUES], out[MRT_PROBE_VALUES];
        for (size_t i = 0; i < MRT_PROBE_VALUES; i++) in[i] = from[i * from_stride + c];
        sh_rotate(3, to_from, in, out);
        for (size_t i = 0; i < MRT_PROBE_VALUES; i++) to[i * to_stride + c] = out[i];
    }
}

bool mrt_turn_probes(struct host *host, int p, const struct mrt_probe_turn *turn,
                     const struct matrix_f32 *from, struct matrix_f32 *out)
{
    const int probes = mrt_probes_of_block(p);
    if (!matrix_f32_init(host, out, (size_t)(MRT_PROBE_VALUES * probes), from->columns))
        return false;
    for (int i = 0; i < probes; i++) {
        size_t row = MRT_PROBE_VALUES * (size_t)i;
        size_t source = MRT_PROBE_VALUES * (size_t)rotated_probe(p, turn, i);
        turn_probe(turn->to_from, from->at + source * from->stride, from->stride,
                   out->at + row * out->stride, out->stride, from->columns);
    }
    return true;
}
