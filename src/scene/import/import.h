// Imports scene files: glTF 2.0 and PLY by readers of this library, OBJ, FBX and X by
// the importer program.
// Files are untrusted.
#pragma once

#include "scene/scene.h"

// See scene_load; `path` is a file path.
struct scene *import_file(struct host *host, const char *path);
