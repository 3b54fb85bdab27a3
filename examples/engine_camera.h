// An engine's camera: its matrices, with a jitter of less than a pixel in each frame.
#ifndef ENGINE_CAMERA_H
#define ENGINE_CAMERA_H

#include <afterglow/renderer.h>

enum engine_depth {
    ENGINE_REVERSED, // 1 at the near plane, 0 at infinity
    ENGINE_FORWARD,  // 0 at the near plane, 1 at the far plane
};
struct engine_camera {
    struct ag_view_matrices matrices;
    float jitter[2]; // pixels by which the image moves, +x right, +y down
};
// View of a frame, counted from 1: the camera moves from the left to the right.
void engine_camera_set(int frame, enum engine_depth depth, int width, int height,
                       struct engine_camera *out);
// The ray through the centre of a pixel; its length along the view axis is 1.
void engine_camera_ray(const struct engine_camera *camera, const float pixel[2], int width,
                       int height, float eye[3], float ray[3]);
// Stored depth of a surface at this distance along the view axis; INFINITY: of no surface.
float engine_camera_depth(const struct engine_camera *camera, float distance);
// Pixel of a point in world space, without the jitter.
void engine_camera_project(const struct engine_camera *camera, const float point[3], int width,
                           int height, float pixel[2]);

#endif
