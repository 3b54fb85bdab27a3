// The camera of a view with its projection: perspective or orthographic, centred or not.
#pragma once

#include "frame/frame_shared.h"
#include "scene/pose.h"

// Sides of the image: on the plane at 1 m along the axis (perspective: tangents), or in metres from
// the axis (orthographic). left < right, bottom < top.
struct frame_camera {
    vec3s eye, forward, up; // position, then two orthogonal unit vectors
    float left, right, bottom, top;
    float near_m, far_m; // far_m: of the depth of orthographic views; else INFINITY
    bool orthographic;
};

// Perspective, centred.
struct frame_camera frame_camera_of(const struct world_camera *camera, uint32_t width,
                                    uint32_t height);
// Sides moved so that pixels sample their centre plus an offset in pixels, +y down.
struct frame_camera frame_camera_jittered(const struct frame_camera *camera, vec2s jitter,
                                          uint32_t width, uint32_t height);
bool frame_camera_equals(const struct frame_camera *a, const struct frame_camera *b);
vec3s frame_camera_right(const struct frame_camera *camera);

// Depth is reversed: near_m / distance, or (far_m − distance) / (far_m − near_m) if orthographic.
mat4s frame_camera_clip_from_world(const struct frame_camera *camera);
mat4s frame_camera_view_from_world(const struct frame_camera *camera);
// distance = (x + y · depth) / (z + w · depth), and depth = (x + y · distance) / (z + w ·
// distance).
vec4s frame_camera_distance_of_depth(const struct frame_camera *camera);
vec4s frame_camera_depth_of_distance(const struct frame_camera *camera);
// Metres along the axis; 0 where depth is: no surface.
float frame_camera_distance(const struct frame_camera *camera, float depth);

// The sight line through a point of the image: origin + distance · direction, with `direction` of
// length 1 along the axis. x, y: −1…1 from the left and the top.
struct frame_sight {
    vec3s origin, direction;
};
struct frame_sight frame_camera_sight(const struct frame_camera *camera, float x, float y);
// Width and height of a pixel at 1 m, or at any distance if orthographic: geometric mean, m.
float frame_camera_pixel(const struct frame_camera *camera, uint32_t width, uint32_t height);

// The plane of distance 0 along the axis: distance = xyz · position + w.
vec4s frame_camera_axis(const struct frame_camera *camera);

// Fills in what the block has of the camera but for the previous frame.
void frame_camera_constants(const struct frame_camera *camera, uint32_t width, uint32_t height,
                            struct frame_constants *out);
