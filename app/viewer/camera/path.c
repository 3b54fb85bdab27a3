#include "path.h"

#include <math.h>
#include <string.h>

static const float TURN = 6.28318531f;

bool path_add(struct path *path, const struct look *look)
{
    if (path->count == PATH_KEYS) return false;
    struct path_key *key = &path->keys[path->count++];
    memcpy(key->eye, look->eye, sizeof key->eye);
    key->yaw = look->yaw;
    key->pitch = look->pitch;
    key->fov_deg = look->fov_deg;
    return true;
}

void path_remove(struct path *path, int key)
{
    path->count--;
    memmove(path->keys + key, path->keys + key + 1,
            (size_t)(path->count - key) * sizeof *path->keys);
}

int path_frames(const struct path *path)
{
    if (path->count == 0) return 0;
    return (int)lroundf((float)(path->count - 1) * path->seconds * (float)path->fps) + 1;
}

// At t = 0 that of p[1], at 1 that of p[2].
static float spline(const float p[4], float t)
{
    const float a = -0.5f * p[0] + 1.5f * p[1] - 1.5f * p[2] + 0.5f * p[3];
    const float b = p[0] - 2.5f * p[1] + 2.0f * p[2] - 0.5f * p[3];
    const float c = 0.5f * (p[2] - p[0]);
    return ((a * t + b) * t + c) * t + p[1];
}

// The shorter way around from key to key.
static void unwind(float yaw[4])
{
    for (int i = 1; i < 4; i++) yaw[i] = yaw[i - 1] + remainderf(yaw[i] - yaw[i - 1], TURN);
}

void path_at(const struct path *path, int frame, struct look *look)
{
    const struct path_key *keys[4];
    const int last = path->count - 1;
    const float at = fminf((float)frame / (path->seconds * (float)path->fps), (float)last);
    const int first = last > 0 && (int)at == last ? last - 1 : (int)at;
    const float t = at - (float)first;
    for (int i = 0; i < 4; i++) {
        const int key = first + i - 1;
        keys[i] = &path->keys[key < 0 ? 0 : key > last ? last : key];
    }
    for (int axis = 0; axis < 3; axis++) {
        const float p[4] = { keys[0]->eye[axis], keys[1]->eye[axis], keys[2]->eye[axis],
                             keys[3]->eye[axis] };
        look->eye[axis] = spline(p, t);
    }
    float yaw[4] = { keys[0]->yaw, keys[1]->yaw, keys[2]->yaw, keys[3]->yaw };
    const float pitch[4] = { keys[0]->pitch, keys[1]->pitch, keys[2]->pitch, keys[3]->pitch };
    const float fov[4] = { keys[0]->fov_deg, keys[1]->fov_deg, keys[2]->fov_deg, keys[3]->fov_deg };
    unwind(yaw);
    look->yaw = remainderf(spline(yaw, t), TURN);
    look->pitch = 0;
    look_turn(look, 0.0f, spline(pitch, t)); // within its bounds
    look->fov_deg = fminf(fmaxf(spline(fov, t), 1.0f), 170.0f);
}
