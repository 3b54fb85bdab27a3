// Texels, tangent frames and probes in the frames of blocks.
#include "operators.h"

#include "core/sh.h"

#include "techniques/mrt/dictionary/cube_operators.h"
#include "techniques/mrt/dictionary/cube_shapes.h"
#include "techniques/mrt/level/probes.h"

#include <math.h>

// A rotated shape has its probes in the same places.
static int rotated_probe(int p, const struct mrt_rotation *turn, int i)
{
    vec3s at = mrt_gather_point(&turn->to, p, MRT_PROBE, i).position;
    int nearest = 0;
    float least = INFINITY;
    at = glms_mat3_mulv(glms_mat3_transpose(turn->to_from), at);
    for (int k = 0; k < mrt_probes_of_block(p); k++) {
        float distance =
            glms_vec3_distance2(mrt_gather_point(&turn->from, p, MRT_PROBE, k).position, at);
        if (!(distance < least)) continue;
        least = distance;
        nearest = k;
    }
    return nearest;
}

// From the tangent frame of one texel to that of the other.
static mat3s tangent_turn(const struct mrt_rotation *turn, int from, int to)
{
    const mat3s from_frame = mrt_shape_texel(&turn->from, from).frame;
    const mat3s to_frame = mrt_shape_texel(&turn->to, to).frame;
    return glms_mat3_mul(glms_mat3_transpose(to_frame), glms_mat3_mul(turn->to_from, from_frame));
}

// Linear SH coefficients y, z, x turn like a vector.
static void turn_values(enum mrt_measure measure, mat3s to_from, const float *in, float *out)
{
    if (measure == MRT_PROBE) {
        sh_rotate(3, to_from, in, out);
        return;
    }
    out[0] = in[0];
    if (measure == MRT_IRRADIANCE) return;
    const vec3s v = glms_mat3_mulv(to_from, vec3_of(in[3], in[1], in[2]));
    out[1] = v.y;
    out[2] = v.z;
    out[3] = v.x;
}

bool mrt_rotate_light(struct host *host, const struct mrt_rotation *turn, int p,
                      enum mrt_measure measure, const struct matrix_f32 *from,
                      struct matrix_f32 *out)
{
    const int points = measure == MRT_PROBE ? mrt_probes_of_block(p) : mrt_shape_texels(&turn->to);
    const size_t values = (size_t)mrt_values_of(measure);
    if (!matrix_f32_init(host, out, (size_t)points * values, from->columns)) return false;
    for (int i = 0; i < points; i++) {
        const int source = measure == MRT_PROBE
                               ? rotated_probe(p, turn, i)
                               : mrt_rotated_texel(&turn->from, turn->to_from, &turn->to, i);
        if (source < 0) continue;
        const mat3s to_from = measure == MRT_VECTOR ? tangent_turn(turn, source, i) : turn->to_from;
        for (size_t c = 0; c < from->columns; c++) {
            float in[MRT_PROBE_VALUES], rotated[MRT_PROBE_VALUES];
            for (size_t k = 0; k < values; k++)
                in[k] = from->at[((size_t)source * values + k) * from->stride + c];
            turn_values(measure, to_from, in, rotated);
            for (size_t k = 0; k < values; k++)
                out->at[((size_t)i * values + k) * out->stride + c] = rotated[k];
        }
    }
    return true;
}

bool mrt_rotate_columns(struct host *host, const struct mrt_rotation *turn,
                        const struct matrix_f32 *from, struct matrix_f32 *out)
{
    const size_t texels = (size_t)mrt_shape_texels(&turn->to);
    if (!matrix_f32_init(host, out, from->rows, texels)) return false;
    for (size_t t = 0; t < texels; t++) {
        const int texel = mrt_rotated_texel(&turn->from, turn->to_from, &turn->to, (int)t);
        for (size_t m = 0; m < from->rows; m++)
            out->at[m * out->stride + t] = from->at[m * from->stride + (size_t)texel];
    }
    return true;
}
