// The viewer's camera: it flies (keys and mouse) or turns around a point (orbit).
#pragma once

#include <afterglow/afterglow.h>

struct look {
    float eye[3];
    float yaw, pitch; // radians: yaw 0 looks along −z, positive to the left; pitch up
    float fov_deg;    // vertical
    float distance;   // to the point that orbits turn around, m
    float speed;      // m/s
    bool moved;       // differs from the camera that it began with
};

// Takes over a camera. scene_size: diagonal of the scene's bounds in m, for the speed.
void look_from_camera(struct look *look, const struct ag_camera *camera, float scene_size);
// The same for a camera that moves: speed and distance stay.
void look_follow(struct look *look, const struct ag_camera *camera);
void look_target(const struct look *look, float out[3]);
void look_forward(const struct look *look, float out[3]);
// right, up, forward: metres along the axes of the view.
void look_move(struct look *look, float right, float up, float forward);
void look_turn(struct look *look, float yaw, float pitch);  // around the camera
void look_orbit(struct look *look, float yaw, float pitch); // around the target
void look_zoom(struct look *look, float steps);             // towards the target
// Looks at a point from a distance at which a sphere of this radius fills most of the image.
void look_focus(struct look *look, const float centre[3], float radius);
// The direction, a unit vector, that projects to a place, −1…1 from the left and the top.
void look_ray(const struct look *look, float aspect, const float at[2], float out[3]);
// Projects a point to −1…1 from the left and the top; false: it is behind the camera.
bool look_project(const struct look *look, float aspect, const float point[3], float out[2]);
