// A camera by matrices: checks them, and finds what the frame needs of them.
//
// With the projection P (rows x, y, z, w) and the view matrix V (rows r0, r1, r2), in view space
// at the distance d along the axis, w = |s| d in a perspective and w = k in an orthographic
// projection, where s = P[2][3] and k = P[3][3]. So
//
//     x_ndc = (P[0][0] x + P[2][0] z + P[3][0]) / w,
//
// whose zeros at −1 and +1 are the sides of the image, and likewise for y. Depth is A + B/d or
// A + B d.
#include "api/renderer/view_matrices.h"

#include "scene/limits.h"

#include <float.h>
#include <math.h>

enum { X, Y, Z, W };

struct projection {
    double at[4][4]; // [column][row]
};

// An entry that is 0 but for rounding, relative to the largest of its row.
static bool is_zero(const struct projection *p, int column, int row)
{
    double largest = 0.0;
    for (int c = 0; c < 4; c++) largest = fmax(largest, fabs(p->at[c][row]));
    return fabs(p->at[column][row]) <= 1e-6 * largest;
}

static void read_projection(const struct ag_view_matrices *m, struct projection *p)
{
    for (int c = 0; c < 4; c++)
        for (int r = 0; r < 4; r++)
            p->at[c][r] = (double)m->clip_from_view[4 * c + r] * (r == Y && m->y_up ? -1.0 : 1.0);
}

static vec3s row_of(const struct ag_view_matrices *m, int row)
{
    return vec3_of(m->view_from_world[row], m->view_from_world[4 + row],
                   m->view_from_world[8 + row]);
}

static bool is_rigid(const struct ag_view_matrices *m)
{
    const float *v = m->view_from_world;
    for (int a = 0; a < 3; a++)
        for (int b = a; b < 3; b++) {
            const float expected = a == b ? 1.0f : 0.0f;
            if (!(fabsf(glms_vec3_dot(row_of(m, a), row_of(m, b)) - expected) < 1e-3f))
                return false;
        }
    return v[3] == 0.0f && v[7] == 0.0f && v[11] == 0.0f && v[15] == 1.0f;
}

static vec3s eye_of(const struct ag_view_matrices *m)
{
    vec3s eye = vec3_of(0, 0, 0);
    for (int i = 0; i < 3; i++)
        eye = glms_vec3_muladds(row_of(m, i), -m->view_from_world[12 + i], eye);
    return eye;
}

// The axes of the image in world space: columns x, y (down) and the viewing direction, from the
// signs of the projection.
static void find_axes(const struct ag_view_matrices *m, const struct projection *p,
                      struct frame_camera *out, vec3s *right)
{
    const vec3s x = row_of(m, 0), y = row_of(m, 1);
    *right = glms_vec3_normalize(p->at[0][X] > 0.0 ? x : glms_vec3_negate(x));
    out->up = glms_vec3_normalize(p->at[1][Y] > 0.0 ? glms_vec3_negate(y) : y);
    out->forward = glms_vec3_normalize(glms_vec3_cross(out->up, *right));
    out->up = glms_vec3_normalize(glms_vec3_cross(*right, out->forward));
}

// Sides of the image: struct frame_camera.
static void find_sides(const struct projection *p, struct frame_camera *out)
{
    const double s = p->at[2][W], scale = out->orthographic ? p->at[3][W] : fabs(s);
    const double x = out->orthographic ? p->at[3][X] / p->at[3][W] : p->at[2][X] / s;
    const double y = out->orthographic ? p->at[3][Y] / p->at[3][W] : p->at[2][Y] / s;
    const double width = scale / fabs(p->at[0][X]), height = scale / fabs(p->at[1][Y]);
    out->left = (float)((-1.0 - x) * width);
    out->right = (float)((1.0 - x) * width);
    out->top = (float)((1.0 + y) * height);
    out->bottom = (float)((-1.0 + y) * height);
}

// Distances at which depth is 1 and 0. false: they are no near and far plane.
static bool find_planes(const struct projection *p, double along_z, struct api_view *out)
{
    struct frame_camera *c = &out->camera;
    double at_one, at_zero;
    if (c->orthographic) {
        const double a = p->at[3][Z] / p->at[3][W], b = p->at[2][Z] * along_z / p->at[3][W];
        at_one = (1.0 - a) / b;
        at_zero = -a / b;
    } else {
        // An entry of about 0 or 1 is an infinite far plane.
        const double a = p->at[2][Z] / p->at[2][W], b = p->at[3][Z] / fabs(p->at[2][W]);
        at_one = fabs(1.0 - a) < 1e-7 ? HUGE_VAL : b / (1.0 - a);
        at_zero = fabs(a) < 1e-7 ? HUGE_VAL : -b / a;
        if (!(at_one > 0.0 && at_zero > 0.0)) return false;
    }
    out->forward_depth = at_zero < at_one;
    const double near_m = fmin(at_one, at_zero), far_m = fmax(at_one, at_zero);
    out->host_far_m = (float)far_m;
    c->near_m = (float)near_m;
    c->far_m = c->orthographic ? (float)far_m : INFINITY;
    return isfinite(c->near_m) && c->near_m < out->host_far_m &&
           (c->orthographic || c->near_m >= FLT_MIN);
}

// The position of an orthographic view may be anywhere on its axis. In front of the near plane, all
// distances are positive.
static void move_before_near_plane(struct api_view *out)
{
    struct frame_camera *c = &out->camera;
    const float range = c->far_m - c->near_m, before = 0.01f * range;
    c->eye = glms_vec3_muladds(c->forward, c->near_m - before, c->eye);
    c->near_m = before;
    c->far_m = out->host_far_m = before + range;
}

enum ag_result api_view_of_matrices(struct ag_context *context, const char *function,
                                    const struct ag_view_matrices *m, struct api_view *out)
{
    *out = (struct api_view){ 0 };
    struct frame_camera *c = &out->camera;
    AG_REQUIRE_KNOWN(function, context, m);
    AG_REQUIRE_FOR(function, context,
                   api_finite(m->view_from_world, 16) && api_finite(m->clip_from_view, 16),
                   "matrices are not finite");
    AG_REQUIRE_FOR(function, context, is_rigid(m),
                   "view_from_world is not a rotation with a translation, column by column");
    c->eye = eye_of(m);
    AG_REQUIRE_FOR(function, context, limits_position(c->eye),
                   "the position in view_from_world is not within %g m of the origin",
                   (double)SCENE_MAX_DISTANCE_M);
    struct projection read;
    const struct projection *p = &read;
    read_projection(m, &read);
    c->orthographic = p->at[2][W] == 0.0;
    AG_REQUIRE_FOR(function, context,
                   p->at[0][X] != 0.0 && p->at[1][Y] != 0.0 && is_zero(p, 1, X) &&
                       is_zero(p, 0, Y) && is_zero(p, 0, W) && is_zero(p, 1, W) &&
                       (c->orthographic ? p->at[3][W] > 0.0 && is_zero(p, 2, X) && is_zero(p, 2, Y)
                                        : is_zero(p, 3, W) && is_zero(p, 3, X) && is_zero(p, 3, Y)),
                   "clip_from_view is neither a perspective nor an orthographic projection, column "
                   "by column");
    AG_REQUIRE_FOR(function, context, is_zero(p, 0, Z) && is_zero(p, 1, Z),
                   "clip_from_view has an oblique near plane; clip in your own G-buffer instead");
    vec3s right;
    find_axes(m, p, c, &right);
    const double along_z = glms_vec3_dot(c->forward, row_of(m, 2)) < 0.0f ? -1.0 : 1.0;
    AG_REQUIRE_FOR(function, context, c->orthographic || along_z * p->at[2][W] > 0.0,
                   "clip_from_view mirrors the image, or is row by row; if its viewport has a "
                   "negative height, set y_up");
    AG_REQUIRE_FOR(function, context, find_planes(p, along_z, out),
                   "the depth of clip_from_view is not 0 and 1 at a near and a far plane");
    find_sides(p, c);
    AG_REQUIRE_FOR(function, context,
                   isfinite(c->left) && isfinite(c->right) && isfinite(c->bottom) &&
                       isfinite(c->top) && c->left < c->right && c->bottom < c->top,
                   "clip_from_view has an image without an area");
    if (c->orthographic) move_before_near_plane(out);
    AG_REQUIRE_FOR(function, context, limits_position(c->eye),
                   "the near plane of clip_from_view is not within %g m of the origin",
                   (double)SCENE_MAX_DISTANCE_M);
    return AG_OK;
}
