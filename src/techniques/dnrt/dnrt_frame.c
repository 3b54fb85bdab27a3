// The frame of an object: polar decomposition by Newton's iteration (Higham 1986, "Computing the
// Polar Decomposition – with Applications").
#include "techniques/dnrt/dnrt_object.h"

#include <math.h>

mat4s dnrt_world_from_object(const struct dnrt_frame *frame)
{
    mat4s m = glms_mat4_identity();
    for (int i = 0; i < 3; i++) {
        const vec3s axis = glms_vec3_scale(frame->rotation.col[i], frame->scale);
        m.col[i] = vec4_of(axis, 0);
    }
    m.col[3] = vec4_of(frame->origin, 1);
    return m;
}

// The orthogonal factor of a matrix whose determinant is of the size of 1.
static mat3s orthogonal_factor(mat3s m)
{
    enum { MOST_STEPS = 32 };
    for (int step = 0; step < MOST_STEPS; step++) {
        const mat3s other = glms_mat3_transpose(glms_mat3_inv(m));
        float change = 0.0f;
        for (int i = 0; i < 3; i++) {
            const vec3s mean = glms_vec3_lerp(m.col[i], other.col[i], 0.5f);
            change = fmaxf(change, glms_vec3_distance(mean, m.col[i]));
            m.col[i] = mean;
        }
        if (change < 1e-6f) break;
    }
    return m;
}

// A bake must not depend on the rounding errors of a rotation.
static const float STRETCH_STEPS = 4096.0f;

bool dnrt_frame_of(mat4s world_from_mesh, struct dnrt_frame *frame, mat3s *stretch)
{
    mat3s linear = glms_mat4_pick3(world_from_mesh);
    const float volume = glms_mat3_det(linear);
    const float size = cbrtf(fabsf(volume));
    if (!(size > 0.0f) || !isfinite(size)) return false;
    linear = glms_mat3_scale(linear, 1.0f / size);
    const mat3s factor = orthogonal_factor(linear);
    *frame = (struct dnrt_frame){
        .origin = vec3_xyz(world_from_mesh.col[3]),
        .rotation = glms_mat3_scale(factor, volume < 0.0f ? -1.0f : 1.0f),
        .scale = size,
    };
    *stretch = glms_mat3_mul(glms_mat3_transpose(frame->rotation), linear);
    for (int i = 0; i < 9; i++) {
        float *entry = &stretch->raw[i / 3][i % 3];
        if (!isfinite(*entry)) return false;
        *entry = roundf(*entry * STRETCH_STEPS) / STRETCH_STEPS + 0.0f; // not −0
    }
    return true;
}
