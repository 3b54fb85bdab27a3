// A path of the camera through keys: Catmull-Rom splines of position, direction and field of view
// (Catmull and Rom 1974), a second or more from key to key.
#pragma once

#include "look.h"

enum { PATH_KEYS = 64 };

struct path_key {
    float eye[3];     // m
    float yaw, pitch; // radians, as in struct look
    float fov_deg;
};

struct path {
    int count;
    struct path_key keys[PATH_KEYS];
    float seconds; // from key to key
    int fps;       // images of a second
};

// False if it is full.
bool path_add(struct path *path, const struct look *look);
void path_remove(struct path *path, int key);
// Images of the whole path, that at the last key included; 0 without keys.
int path_frames(const struct path *path);
// The camera of an image, 0 … path_frames − 1; distance and speed stay.
void path_at(const struct path *path, int frame, struct look *look);
