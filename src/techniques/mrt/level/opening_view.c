// Form factors of openings.
#include "opening_view.h"

#include <math.h>

// The part of a cosine-weighted hemisphere that a polygon above the horizon covers (Lambert).
static float form_factor(vec3s point, vec3s normal, const vec3s corner[4])
{
    float sum = 0.0f;
    for (int i = 0; i < 4; i++) {
        const vec3s a = vec3_unit(glms_vec3_sub(corner[i], point));
        const vec3s b = vec3_unit(glms_vec3_sub(corner[(i + 1) % 4], point));
        const vec3s across = glms_vec3_cross(a, b);
        const float sine = glms_vec3_norm(across);
        if (sine > 0.0f)
            sum += atan2f(sine, glms_vec3_dot(a, b)) * glms_vec3_dot(across, normal) / sine;
    }
    return fabsf(sum) / (2.0f * GLM_PIf);
}

static void corners_of(int face, vec3s corner[4])
{
    const int axis = face / 2;
    for (int i = 0; i < 4; i++) {
        corner[i].raw[axis] = face & 1 ? 0.5f : -0.5f;
        corner[i].raw[(axis + 1) % 3] = i == 1 || i == 2 ? 0.5f : -0.5f;
        corner[i].raw[(axis + 2) % 3] = i >= 2 ? 0.5f : -0.5f;
    }
}

void mrt_opening_ratios(const struct mrt_shape *closed, mat3s block_from_cell, int face,
                        float *ratios)
{
    const mat3s normals = glms_mat3_transpose(glms_mat3_inv(block_from_cell));
    vec3s in_cube[4], in_block[4];
    corners_of(face, in_cube);
    for (int i = 0; i < 4; i++) in_block[i] = glms_mat3_mulv(block_from_cell, in_cube[i]);
    for (int t = 0; t < mrt_shape_texels(closed); t++) {
        const struct mrt_point at = mrt_shape_texel(closed, t);
        const float cube = form_factor(at.position, at.frame.col[2], in_cube);
        const float block =
            form_factor(glms_mat3_mulv(block_from_cell, at.position),
                        vec3_unit(glms_mat3_mulv(normals, at.frame.col[2])), in_block);
        const bool is_wall = t / (closed->resolution * closed->resolution) != face;
        ratios[t] = is_wall && cube > 0.0f ? block / cube : 1.0f;
    }
}
