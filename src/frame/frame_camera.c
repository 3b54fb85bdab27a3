#include "frame/frame_camera.h"

#include "frame/projection.h"

#include <math.h>
#include <string.h>

struct frame_camera frame_camera_of(const struct world_camera *camera, uint32_t width,
                                    uint32_t height)
{
    const float tan_y = tanf(camera->vertical_fov_rad * 0.5f);
    const float tan_x = tan_y * (float)width / (float)height;
    return (struct frame_camera){ .eye = camera->eye,
                                  .forward = camera->forward,
                                  .up = camera->up,
                                  .left = -tan_x,
                                  .right = tan_x,
                                  .bottom = -tan_y,
                                  .top = tan_y,
                                  .near_m = camera->near_m,
                                  .far_m = INFINITY };
}

struct frame_camera frame_camera_jittered(const struct frame_camera *c, vec2s jitter,
                                          uint32_t width, uint32_t height)
{
    const float x = jitter.x * (c->right - c->left) / (float)width;
    const float y = jitter.y * (c->top - c->bottom) / (float)height;
    struct frame_camera moved = *c;
    moved.left += x;
    moved.right += x;
    moved.bottom -= y;
    moved.top -= y;
    return moved;
}

static bool same(vec3s a, vec3s b)
{
    return a.x == b.x && a.y == b.y && a.z == b.z;
}

bool frame_camera_equals(const struct frame_camera *a, const struct frame_camera *b)
{
    return same(a->eye, b->eye) && same(a->forward, b->forward) && same(a->up, b->up) &&
           a->left == b->left && a->right == b->right && a->bottom == b->bottom &&
           a->top == b->top && a->near_m == b->near_m && a->far_m == b->far_m &&
           a->orthographic == b->orthographic;
}

vec3s frame_camera_right(const struct frame_camera *camera)
{
    return glms_vec3_cross(camera->forward, camera->up);
}

mat4s frame_camera_view_from_world(const struct frame_camera *camera)
{
    return projection_view_from_world(camera->eye, camera->forward, camera->up);
}

// View space looks along −z; clip space has y down. A centre off the axis is in the column of what
// divides: z of the view, or 1.
mat4s frame_camera_clip_from_world(const struct frame_camera *c)
{
    const float width = c->right - c->left, height = c->top - c->bottom;
    const float x = (c->right + c->left) / width, y = (c->top + c->bottom) / height;
    mat4s m = glms_mat4_zero();
    m.raw[0][0] = 2.0f / width;
    m.raw[1][1] = -2.0f / height;
    if (c->orthographic) {
        m.raw[3][0] = -x;
        m.raw[3][1] = y;
        m.raw[2][2] = 1.0f / (c->far_m - c->near_m);
        m.raw[3][2] = c->far_m / (c->far_m - c->near_m);
        m.raw[3][3] = 1.0f;
    } else {
        m.raw[2][0] = x;
        m.raw[2][1] = -y;
        m.raw[2][3] = -1.0f;
        m.raw[3][2] = c->near_m;
    }
    return glms_mat4_mul(m, frame_camera_view_from_world(c));
}

vec4s frame_camera_distance_of_depth(const struct frame_camera *c)
{
    return c->orthographic ? vec4_of(vec3_of(c->far_m, c->near_m - c->far_m, 1.0f), 0.0f)
                           : vec4_of(vec3_of(c->near_m, 0.0f, 0.0f), 1.0f);
}

vec4s frame_camera_depth_of_distance(const struct frame_camera *c)
{
    const float range = c->far_m - c->near_m;
    return c->orthographic ? vec4_of(vec3_of(c->far_m / range, -1.0f / range, 1.0f), 0.0f)
                           : vec4_of(vec3_of(c->near_m, 0.0f, 0.0f), 1.0f);
}

float frame_camera_distance(const struct frame_camera *c, float depth)
{
    if (!(depth > 0.0f)) return 0.0f;
    const vec4s m = frame_camera_distance_of_depth(c);
    return (m.x + m.y * depth) / (m.z + m.w * depth);
}

// A point of the image as an offset from the axis, at 1 m or at any distance.
static vec3s spread(const struct frame_camera *c, float x, float y)
{
    const float across = 0.5f * (c->left + c->right) + 0.5f * x * (c->right - c->left);
    const float upwards = 0.5f * (c->bottom + c->top) - 0.5f * y * (c->top - c->bottom);
    return glms_vec3_muladds(frame_camera_right(c), across, glms_vec3_scale(c->up, upwards));
}

struct frame_sight frame_camera_sight(const struct frame_camera *c, float x, float y)
{
    const vec3s from_axis = spread(c, x, y);
    if (c->orthographic)
        return (struct frame_sight){ glms_vec3_add(c->eye, from_axis), c->forward };
    return (struct frame_sight){ c->eye, glms_vec3_add(c->forward, from_axis) };
}

float frame_camera_pixel(const struct frame_camera *c, uint32_t width, uint32_t height)
{
    return sqrtf((c->right - c->left) / (float)width * (c->top - c->bottom) / (float)height);
}

vec4s frame_camera_axis(const struct frame_camera *c)
{
    return vec4_of(c->forward, -glms_vec3_dot(c->forward, c->eye));
}

void frame_camera_constants(const struct frame_camera *c, uint32_t width, uint32_t height,
                            struct frame_constants *out)
{
    const float pixel_x = (c->right - c->left) / (float)width;
    const float pixel_y = (c->top - c->bottom) / (float)height;
    const vec3s x = glms_vec3_scale(frame_camera_right(c), 0.5f * (c->right - c->left));
    const vec3s y = glms_vec3_scale(c->up, -0.5f * (c->top - c->bottom));
    const vec3s none = vec3_of(0, 0, 0);
    const struct frame_sight centre = frame_camera_sight(c, 0.0f, 0.0f);
    out->clip_from_world = frame_camera_clip_from_world(c);
    out->world_from_clip = projection_inverse(out->clip_from_world);
    out->view_from_world = frame_camera_view_from_world(c);
    out->viewer =
        c->orthographic ? vec4_of(glms_vec3_negate(c->forward), 0.0f) : vec4_of(c->eye, 1.0f);
    out->distance_of_depth = frame_camera_distance_of_depth(c);
    out->axis = frame_camera_axis(c);
    out->image_plane =
        (vec4s){ { c->left + 0.5f * pixel_x, 0.5f * pixel_y - c->top, pixel_x, pixel_y } };
    out->camera_position = c->eye;
    out->near_m = c->near_m;
    out->origin = centre.origin;
    out->origin_x = c->orthographic ? x : none;
    out->origin_y = c->orthographic ? y : none;
    out->ray = centre.direction;
    out->ray_x = c->orthographic ? none : x;
    out->ray_y = c->orthographic ? none : y;
}
