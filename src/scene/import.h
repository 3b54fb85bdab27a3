// Scene files through Assimp's C API, after our own checks of what it does not check.
#pragma once

#include "scene/scene.h"

// See scene_load. `path` is a file's.
struct scene *import_file(struct host *host, const char *path);
