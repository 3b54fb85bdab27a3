// Limits within which 32-bit floats can trace a scene. Scenes beyond them are refused when they are
// loaded, and a moment of an animation when it is posed.
#pragma once

#include "scene/pose.h"

// Coordinates of geometry, metres. Ray differentials multiply three lengths in the scene, 3.5e8 at
// most, by a distance from the camera: 4e34 is finite.
#define SCENE_MAX_COORDINATE_M 1e8f
// Coordinates of cameras, points and spots. A camera that shows all of the largest scene is 6e8 m
// away.
#define SCENE_MAX_DISTANCE_M 1e9f
// Strength of emissive surfaces and the sky (cd/m²), of suns (lux) and of other lights (candela).
// Flux from the largest scene, 1e33 lumens, is finite. The sun's disc has 1.6e9 cd/m².
#define SCENE_MAX_RADIANCE 1e15f

bool limits_vertex(vec3s position);   // finite, and within SCENE_MAX_COORDINATE_M
bool limits_position(vec3s position); // finite, and within SCENE_MAX_DISTANCE_M
bool limits_light(vec3s intensity);   // each from 0 to SCENE_MAX_RADIANCE

// Each is false after a failure that names the limit. limits_scene covers the rest pose.
bool limits_scene(const struct scene *scene);
bool limits_pose(const struct scene_pose *pose);
