// Chooses an importer by file extension: glTF 2.0 is read from its JSON and accessors (gltf/), PLY
// by ply.c, OBJ, FBX and X by the importer program (import_program.c), which uses Assimp.
//
// Assimp reads glTF too, but loses data, and its result cannot be matched to the JSON afterwards:
//
// - bones and animation channels refer to nodes by name; glTF names are optional and not unique,
// and
//   the order of nodes and meshes differs from the file's;
// - all animation keys are linear: step and cubic interpolation are lost;
// - lights have no range, and candela cannot be distinguished from lux;
// - input is not fully validated: indices, node cycles, sparse accessors.
//
// A reader with bounds checks is less code than working around this.
#include "scene/import/import.h"

#include "scene/import/importers.h"

#include "scene/limits.h"

#include "core/hash.h"

#include <string.h>

static const size_t MAX_FILE_BYTES = (size_t)4 << 30;

static bool dispatch(struct import *import, const struct file_bytes *bytes)
{
    char extension[16];
    file_extension(import->path, extension);
    if (strcmp(extension, "gltf") == 0 || strcmp(extension, "glb") == 0) {
        return import_gltf(import, bytes);
    }
    if (strcmp(extension, "ply") == 0) return import_ply(import, bytes);
    static const char *const by_program[] = { "obj", "fbx", "x" };
    for (size_t i = 0; i < sizeof by_program / sizeof *by_program; i++) {
        if (strcmp(extension, by_program[i]) == 0) return import_program(import, bytes);
    }
    return host_fail(import->host, FAIL_UNSUPPORTED,
                     "%s: unknown kind of scene file; use glTF, GLB, OBJ, PLY, FBX or X",
                     import->path);
}

struct scene *import_file(struct host *host, const char *path)
{
    struct import import = { .host = host, .path = path };
    struct file_bytes bytes = { 0 };
    if (!file_read(host, path, MAX_FILE_BYTES, &bytes)) return NULL;
    import.source_bytes = bytes.size;
    import.scene = scene_create(host, path);
    if (!import.scene) goto fail;
    import.scene->content_hash = hash_bytes(bytes.data, bytes.size, 0);
    if (!dispatch(&import, &bytes) || !limits_scene(import.scene)) goto fail;
    import_log_notes(&import);
    file_bytes_finish(host, &bytes);
    return import.scene;
fail:
    file_bytes_finish(host, &bytes);
    scene_destroy(import.scene);
    return NULL;
}
