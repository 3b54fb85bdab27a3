// Scene files: glTF 2.0 and PLY by our own readers, OBJ, FBX and X through Assimp's C API. Files
// are untrusted.
#pragma once

#include "scene/scene.h"

// See scene_load. `path` is a file's.
struct scene *import_file(struct host *host, const char *path);
