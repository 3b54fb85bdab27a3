#include "look.h"

#include "vectors.h"

#include <math.h>

static const float MAX_PITCH = 1.5533f; // 89 degrees
static const float PI = 3.14159265f;

void look_forward(const struct look *look, float out[3])
{
    out[0] = -sinf(look->yaw) * cosf(look->pitch);
    out[1] = sinf(look->pitch);
    out[2] = -cosf(look->yaw) * cosf(look->pitch);
}

static void right_of(const struct look *look, float out[3])
{
    out[0] = cosf(look->yaw);
    out[1] = 0;
    out[2] = -sinf(look->yaw);
}

void look_from_camera(struct look *look, const struct ag_camera *camera, float scene_size)
{
    float to[3];
    for (int i = 0; i < 3; i++) {
        look->eye[i] = camera->eye[i];
        to[i] = camera->target[i] - camera->eye[i];
    }
    const float distance = vec_length(to);
    look->yaw = atan2f(-to[0], -to[2]);
    look->pitch = asinf(fminf(fmaxf(to[1] / fmaxf(distance, 1e-20f), -1.0f), 1.0f));
    look->fov_deg = camera->vertical_fov_rad * 180.0f / PI;
    // The targets of many cameras are a metre ahead: orbits turn around something farther away.
    look->distance = fmaxf(distance, 0.1f * scene_size);
    look->speed = fmaxf(0.1f * scene_size, 1e-3f);
    look->moved = false;
}

void look_follow(struct look *look, const struct ag_camera *camera)
{
    const float speed = look->speed, distance = look->distance;
    look_from_camera(look, camera, 0.0f);
    look->speed = speed;
    look->distance = distance;
}

void look_target(const struct look *look, float out[3])
{
    float forward[3];
    look_forward(look, forward);
    for (int i = 0; i < 3; i++) out[i] = look->eye[i] + look->distance * forward[i];
}

void look_move(struct look *look, float right, float up, float forward)
{
    float x[3], z[3];
    right_of(look, x);
    look_forward(look, z);
    for (int i = 0; i < 3; i++) look->eye[i] += right * x[i] + forward * z[i];
    look->eye[1] += up;
    look->moved = true;
}

void look_turn(struct look *look, float yaw, float pitch)
{
    look->yaw = remainderf(look->yaw + yaw, 2.0f * PI);
    look->pitch = fminf(fmaxf(look->pitch + pitch, -MAX_PITCH), MAX_PITCH);
    look->moved = true;
}

static void place_before(struct look *look, const float target[3])
{
    float forward[3];
    look_forward(look, forward);
    for (int i = 0; i < 3; i++) look->eye[i] = target[i] - look->distance * forward[i];
}

void look_orbit(struct look *look, float yaw, float pitch)
{
    float target[3];
    look_target(look, target);
    look_turn(look, yaw, pitch);
    place_before(look, target);
}

void look_zoom(struct look *look, float steps)
{
    float target[3];
    look_target(look, target);
    look->distance = fminf(fmaxf(look->distance * powf(0.85f, steps), 1e-3f), 1e8f);
    look->moved = true;
    place_before(look, target);
}

void look_focus(struct look *look, const float centre[3], float radius)
{
    const float half = 0.5f * look->fov_deg * PI / 180.0f;
    look->distance = fmaxf(1.4f * radius / fmaxf(sinf(half), 1e-3f), 1e-3f);
    look->moved = true;
    place_before(look, centre);
}

bool look_project(const struct look *look, float aspect, const float point[3], float out[2])
{
    float right[3], forward[3], up[3], x = 0, y = 0, z = 0;
    right_of(look, right);
    look_forward(look, forward);
    vec_cross(right, forward, up);
    for (int i = 0; i < 3; i++) {
        const float to = point[i] - look->eye[i];
        x += to * right[i];
        y += to * up[i];
        z += to * forward[i];
    }
    const float half = tanf(0.5f * look->fov_deg * PI / 180.0f);
    if (!(z > 1e-4f)) return false; // also where it is no number
    out[0] = x / (z * half * aspect);
    out[1] = -y / (z * half);
    return true;
}

void look_ray(const struct look *look, float aspect, const float at[2], float out[3])
{
    float right[3], forward[3], up[3];
    right_of(look, right);
    look_forward(look, forward);
    vec_cross(right, forward, up);
    const float half = tanf(0.5f * look->fov_deg * PI / 180.0f);
    for (int i = 0; i < 3; i++)
        out[i] = forward[i] + at[0] * half * aspect * right[i] - at[1] * half * up[i];
    vec_normalize(out);
}
