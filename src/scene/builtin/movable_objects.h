// Objects of built-in scenes that move, of about 1500 triangles.
#pragma once

#include "scene/scene.h"

// A solid of revolution with the profile sin(πt) (1 + wave sin(2π cycles t)), or a closed pipe
// along a knot.
struct movable_object {
    vec3s centre; // m
    float radius; // of a solid, and of a knot's path with the pipe
    float height; // of a solid; 0: a knot
    float wave, cycles;
    vec3s reflectance;
};
// False on failure.
bool movable_object_add(struct scene *scene, const struct movable_object *object);

// The first `count` of @cornell, at most 10. False on failure.
bool cornell_add_objects(struct scene *scene, int count);
bool cornell_add_bowl(struct scene *scene); // concave: its inside lights itself
