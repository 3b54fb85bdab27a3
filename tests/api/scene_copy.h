// A scene built by calls that equals another one.
#pragma once

#include <afterglow/scene.h>

// A new scene in the context of `from`, with the meshes, materials, images, instances, lights and
// sky of its rest pose. `from` has no skins and no morph targets.
struct ag_scene *scene_copy_by_calls(struct ag_scene *from);
