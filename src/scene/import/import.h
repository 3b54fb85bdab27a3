// Imports scene files: glTF 2.0 and PLY by readers of this library, OBJ, FBX and X by
// the importer program.
// Files are untrusted.
#pragma once

#include "scene/scene.h"

// See scene_load_scaled; `path` is a file path.
struct scene *import_file(struct host *host, const char *path, float scale);

// A scene file in memory, and the files that it refers to. The bytes are needed during the call.
struct import_bytes {
    const void *data;
    size_t size;
    const char *name;   // its extension states the format; without a known one the bytes do
    const char *folder; // of other files; NULL: none
    // A file by its path relative to the scene, instead of `folder`; false: there is none. NULL:
    // `folder` is used. The bytes stay until import_memory returns.
    bool (*read)(void *user, const char *path, const void **bytes, size_t *size);
    void *user;
    float scale; // rescale.h; 0: 1
};
struct scene *import_memory(struct host *host, const struct import_bytes *from);
