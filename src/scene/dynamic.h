// Which instances are dynamic: expected to move or to be deformed.
#pragma once

#include "scene/scene.h"

// [instance_count]: instances that are marked movable, and those that an animation of the scene
// moves or deforms, played or not. The caller frees it. NULL without memory.
bool *scene_dynamic_instances(struct host *host, const struct scene *scene);
