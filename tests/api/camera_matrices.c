#include "api/camera_matrices.h"

#include <math.h>

struct matrix_options matrix_options_default(void)
{
    return (struct matrix_options){ .far_m = 50, .left = -1, .right = 1, .bottom = -1, .top = 1 };
}

static void subtract(const float a[3], const float b[3], float out[3])
{
    for (int i = 0; i < 3; i++) out[i] = a[i] - b[i];
}

static void cross(const float a[3], const float b[3], float out[3])
{
    for (int i = 0; i < 3; i++)
        out[i] = a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
}

static void normalize(float v[3])
{
    const float length = sqrtf(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    for (int i = 0; i < 3; i++) v[i] /= length;
}

static void set_view(const struct ag_camera *camera, const struct matrix_options *o, float m[16])
{
    float forward[3], right[3], up[3];
    subtract(camera->target, camera->eye, forward);
    normalize(forward);
    cross(forward, camera->up, right);
    normalize(right);
    cross(right, forward, up);
    const bool along_z = o->left_handed || o->opencv;
    for (int i = 0; i < 3; i++) {
        m[4 * i] = right[i];
        m[4 * i + 1] = o->opencv ? -up[i] : up[i];
        m[4 * i + 2] = along_z ? forward[i] : -forward[i];
    }
    for (int r = 0; r < 3; r++) {
        m[12 + r] = 0;
        for (int i = 0; i < 3; i++) m[12 + r] -= m[4 * i + r] * camera->eye[i];
    }
    m[15] = 1;
}

// depth = a + b/d, or a + b d.
static void depth_line(const struct ag_camera *camera, const struct matrix_options *o, float *a,
                       float *b)
{
    const float n = camera->near_m, f = o->far_m;
    const bool forward = o->depth == FORWARD_FINITE || o->depth == FORWARD_INFINITE;
    const bool infinite = o->depth == REVERSED_INFINITE || o->depth == FORWARD_INFINITE;
    if (o->orthographic_half_m > 0) {
        *a = f / (f - n);
        *b = -1 / (f - n);
    } else {
        *a = infinite ? 0 : -n / (f - n);
        *b = infinite ? n : n * f / (f - n);
    }
    if (!forward) return;
    *a = 1 - *a;
    *b = -*b;
}

float depth_at(const struct ag_camera *camera, const struct matrix_options *o, float distance_m)
{
    float a, b;
    depth_line(camera, o, &a, &b);
    return o->orthographic_half_m > 0 ? a + b * distance_m : a + b / distance_m;
}

struct ag_view_matrices matrices_of(const struct ag_camera *camera, float width, float height,
                                    const struct matrix_options *o)
{
    struct ag_view_matrices m = { .y_up = o->y_up };
    float a, b, *p = m.clip_from_view;
    set_view(camera, o, m.view_from_world);
    depth_line(camera, o, &a, &b);
    const bool flat = o->orthographic_half_m > 0;
    const float half_y = flat ? o->orthographic_half_m : tanf(0.5f * camera->vertical_fov_rad);
    const float half_x = half_y * width / height;
    const float z = o->left_handed || o->opencv ? 1.0f : -1.0f; // of a point in front
    const float up = (o->y_up ? 1.0f : -1.0f) * (o->opencv ? -1.0f : 1.0f);
    const float centre_x = (o->right + o->left) / (o->right - o->left);
    const float centre_y = (o->top + o->bottom) / (o->top - o->bottom) * (o->y_up ? 1.0f : -1.0f);
    const int divisor = flat ? 12 : 8; // the column of what divides
    p[0] = 2 / (half_x * (o->right - o->left));
    p[5] = up * 2 / (half_y * (o->top - o->bottom));
    p[divisor] = -centre_x * (flat ? 1 : z);
    p[divisor + 1] = -centre_y * (flat ? 1 : z);
    p[10] = (flat ? b : a) * z;
    p[14] = flat ? a : b;
    p[11] = flat ? 0 : z;
    p[15] = flat ? 1 : 0;
    return m;
}
