// What 32-bit floats can trace. Scenes beyond it are refused when they are loaded, and a moment of
// an animation when it is posed.
#pragma once

#include "scene/pose.h"

// Coordinates, metres. Ray differentials multiply squared lengths: the fourth power of the diagonal
// of the largest scene, 1.4e38, is finite.
#define SCENE_MAX_COORDINATE_M 1e9f
// Of emissive surfaces and the sky (cd/m²), of suns (lux) and of other lights (candela). Flux from
// the largest scene, 1e34 lumens, is finite. The sun's disc has 1.6e9 cd/m².
#define SCENE_MAX_RADIANCE 1e15f

bool limits_position(vec3s position); // finite, and within SCENE_MAX_COORDINATE_M
bool limits_light(vec3s intensity);   // each from 0 to SCENE_MAX_RADIANCE

// Each is false after a failure that names the limit. limits_scene covers the rest pose.
bool limits_scene(const struct scene *scene);
bool limits_pose(const struct scene_pose *pose);
