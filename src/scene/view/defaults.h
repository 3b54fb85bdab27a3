// The default camera and lighting of a scene that has none. Deterministic.
#pragma once

#include "scene/pose.h"

// The default camera: outside an object; inside an interior, along its longest free view.
struct world_camera default_camera(const struct scene_pose *pose);

struct default_lighting {
    vec3s sun_direction; // unit, from the sun
    vec3s sun_lux;
    vec3s sky; // cd/m²
};
// A sun that reaches the interior, and a faint sky.
struct default_lighting default_lighting(const struct scene_pose *pose);
// Distance of the near plane for a scene of this size, metres.
float default_near(const struct scene_pose *pose);
