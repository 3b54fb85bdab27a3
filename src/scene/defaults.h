// What a scene gets that brings no light or no camera. Deterministic.
#pragma once

#include "scene/pose.h"

// A camera for a scene without one: from outside where the scene is an object; from inside, along
// its longest clear view, where geometry surrounds its middle.
struct world_camera default_camera(const struct scene_pose *pose);

// True where the scene has neither punctual lights nor emission nor a sky.
bool scene_is_dark(const struct scene *scene);

struct default_lighting {
    vec3s sun_direction; // the way the light shines, unit
    vec3s sun_lux;
    vec3s sky; // cd/m²
};
// A sun that reaches the scene's inside and a faint sky.
struct default_lighting default_lighting(const struct scene_pose *pose);
// Near plane that suits a scene of this size, metres.
float default_near(const struct scene_pose *pose);
