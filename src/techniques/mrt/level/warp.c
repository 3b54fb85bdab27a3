// The trilinear warp of a block.
#include "block.h"

#include <math.h>

static float side(int corner, int axis, float x)
{
    return corner >> axis & 1 ? 0.5f + x : 0.5f - x;
}

vec3s mrt_warp_point(const vec3s corner[MRT_CORNERS], vec3s cell)
{
    vec3s sum = vec3_of(0, 0, 0);
    for (int c = 0; c < MRT_CORNERS; c++) {
        float weight = side(c, 0, cell.x) * side(c, 1, cell.y) * side(c, 2, cell.z);
        sum = glms_vec3_muladds(corner[c], weight, sum);
    }
    return sum;
}

mat3s mrt_warp_jacobian(const vec3s corner[MRT_CORNERS], vec3s cell)
{
    mat3s j = { 0 };
    for (int c = 0; c < MRT_CORNERS; c++) {
        for (int a = 0; a < 3; a++) {
            int b = (a + 1) % 3, d = (a + 2) % 3;
            float weight = side(c, b, cell.raw[b]) * side(c, d, cell.raw[d]);
            j.col[a] = glms_vec3_muladds(corner[c], c >> a & 1 ? weight : -weight, j.col[a]);
        }
    }
    return j;
}

struct box3 mrt_warp_bounds(const vec3s corner[MRT_CORNERS])
{
    struct box3 box = box3_empty();
    for (int c = 0; c < MRT_CORNERS; c++) box = box3_add_point(box, corner[c]);
    return box;
}

// The determinant has degree two in each coordinate. Five points per axis include the corners;
// between them it cannot fall far below its neighbours.
bool mrt_warp_folds(const vec3s corner[MRT_CORNERS])
{
    enum { POINTS = 5 };
    vec3s size = box3_size(mrt_warp_bounds(corner));
    // Relative to the volume of the bounding box: flat blocks are folded too.
    float least = 1e-6f * size.x * size.y * size.z;
    for (int i = 0; i < POINTS * POINTS * POINTS; i++) {
        vec3s cell = vec3_of((float)(i % POINTS), (float)(i / POINTS % POINTS),
                             (float)(i / (POINTS * POINTS)));
        cell = glms_vec3_subs(glms_vec3_divs(cell, (float)(POINTS - 1)), 0.5f);
        if (!(glms_mat3_det(mrt_warp_jacobian(corner, cell)) > least)) return true;
    }
    return false;
}

bool mrt_warp_is_affine(const vec3s corner[MRT_CORNERS])
{
    static const float ROUNDING = 1e-5f; // of the block's diagonal
    const float most = ROUNDING * glms_vec3_distance(corner[0], corner[MRT_CORNERS - 1]);
    for (int c = 0; c < MRT_CORNERS; c++) {
        vec3s sum = corner[0];
        for (int a = 0; a < 3; a++)
            if (c >> a & 1) sum = glms_vec3_add(sum, glms_vec3_sub(corner[1 << a], corner[0]));
        if (!(glms_vec3_distance(sum, corner[c]) <= most)) return false;
    }
    return true;
}

vec3s mrt_warp_face_normal(const vec3s corner[MRT_CORNERS], int face, vec3s cell)
{
    mat3s frame = cube_from_face(face), j = mrt_warp_jacobian(corner, cell);
    vec3s u = glms_mat3_mulv(j, frame.col[0]), v = glms_mat3_mulv(j, frame.col[1]);
    return vec3_unit(glms_vec3_cross(u, v));
}

bool mrt_warp_inverse(const vec3s corner[MRT_CORNERS], vec3s world, vec3s *cell)
{
    enum { STEPS = 20 };
    static const float FAR = 8.0f, CONVERGED = 1e-6f;
    vec3s p = vec3_of(0, 0, 0);
    for (int i = 0; i < STEPS; i++) {
        mat3s j = mrt_warp_jacobian(corner, p);
        vec3s residual = glms_vec3_sub(world, mrt_warp_point(corner, p));
        vec3s step = glms_mat3_mulv(glms_mat3_inv(j), residual);
        p = glms_vec3_add(p, step);
        float distance = glms_vec3_max(glms_vec3_abs(p));
        if (!(distance < FAR)) return false;
        if (glms_vec3_max(glms_vec3_abs(step)) > CONVERGED) continue;
        *cell = p;
        return true;
    }
    return false;
}
