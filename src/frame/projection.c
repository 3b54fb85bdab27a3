// View and projection matrices.
#include "frame/projection.h"

#include <math.h>

mat4s projection_view_from_world(vec3s eye, vec3s forward, vec3s up)
{
    vec3s right = glms_vec3_normalize(glms_vec3_cross(forward, up));
    vec3s true_up = glms_vec3_cross(right, forward);
    mat4s m = glms_mat4_identity();
    for (int i = 0; i < 3; i++) {
        m.raw[i][0] = right.raw[i];
        m.raw[i][1] = true_up.raw[i];
        m.raw[i][2] = -forward.raw[i];
    }
    m.raw[3][0] = -glms_vec3_dot(right, eye);
    m.raw[3][1] = -glms_vec3_dot(true_up, eye);
    m.raw[3][2] = glms_vec3_dot(forward, eye);
    return m;
}

mat4s projection_perspective(float tan_half_x, float tan_half_y, float near_m)
{
    mat4s m = glms_mat4_zero();
    m.raw[0][0] = 1.0f / tan_half_x;
    m.raw[1][1] = -1.0f / tan_half_y;
    m.raw[2][3] = -1.0f;
    m.raw[3][2] = near_m;
    return m;
}

mat4s projection_orthographic(float half_m, float near_m, float far_m)
{
    mat4s m = glms_mat4_zero();
    m.raw[0][0] = 1.0f / half_m;
    m.raw[1][1] = -1.0f / half_m;
    // z = −distance: (far − distance) / (far − near)
    m.raw[2][2] = 1.0f / (far_m - near_m);
    m.raw[3][2] = far_m / (far_m - near_m);
    m.raw[3][3] = 1.0f;
    return m;
}

vec3s projection_cube_forward(int face)
{
    vec3s v = vec3_of(0, 0, 0);
    v.raw[face / 2] = face % 2 ? -1.0f : 1.0f;
    return v;
}

vec3s projection_cube_up(int face)
{
    return face / 2 == 1 ? vec3_of(0, 0, 1) : vec3_of(0, 1, 0);
}

// Gauss-Jordan with row pivots; `a` is [row][column], its right half becomes the inverse.
static void eliminate(double a[4][8])
{
    for (int c = 0; c < 4; c++) {
        int pivot = c;
        for (int r = c + 1; r < 4; r++) {
            if (fabs(a[r][c]) > fabs(a[pivot][c])) pivot = r;
        }
        for (int k = 0; k < 8; k++) {
            double t = a[c][k];
            a[c][k] = a[pivot][k];
            a[pivot][k] = t;
        }
        double scale = a[c][c] != 0.0 ? 1.0 / a[c][c] : 0.0;
        for (int k = 0; k < 8; k++) a[c][k] *= scale;
        for (int r = 0; r < 4; r++) {
            if (r == c) continue;
            double factor = a[r][c];
            for (int k = 0; k < 8; k++) a[r][k] -= factor * a[c][k];
        }
    }
}

mat4s projection_inverse(mat4s m)
{
    double a[4][8] = { 0 };
    for (int r = 0; r < 4; r++) {
        for (int c = 0; c < 4; c++) a[r][c] = (double)m.raw[c][r];
        a[r][4 + r] = 1.0;
    }
    eliminate(a);
    mat4s inverse;
    for (int r = 0; r < 4; r++) {
        for (int c = 0; c < 4; c++) inverse.raw[c][r] = (float)a[r][4 + c];
    }
    return inverse;
}

bool projection_may_see(mat4s clip_from_world, struct box3 box)
{
    if (box3_is_empty(box)) return false;
    // Culled if all corners are outside of one plane: x < −w, x > w, y < −w, y > w, z > w (near).
    // The far plane is not tested: it is infinite for cameras and behind the scene for suns.
    int outside[5] = { 0 };
    for (int i = 0; i < 8; i++) {
        vec4s corner = { { (i & 1 ? box.max : box.min).x, (i & 2 ? box.max : box.min).y,
                           (i & 4 ? box.max : box.min).z, 1.0f } };
        vec4s c = glms_mat4_mulv(clip_from_world, corner);
        outside[0] += c.x < -c.w;
        outside[1] += c.x > c.w;
        outside[2] += c.y < -c.w;
        outside[3] += c.y > c.w;
        outside[4] += c.z > c.w;
    }
    for (int i = 0; i < 5; i++) {
        if (outside[i] == 8) return false;
    }
    return true;
}
