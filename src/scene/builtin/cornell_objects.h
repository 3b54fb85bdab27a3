// Objects of @cornell that move.
#pragma once

#include "scene/scene.h"

// The first `count`, at most 10. False on failure.
bool cornell_add_objects(struct scene *scene, int count);
