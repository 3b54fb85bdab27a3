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
#include "scene/rescale.h"

#include "core/hash.h"

#include <string.h>

static const size_t MAX_FILE_BYTES = (size_t)4 << 30;

static bool is_one_of(const char *extension, const char *const *list, size_t count)
{
    for (size_t i = 0; i < count; i++)
        if (strcmp(extension, list[i]) == 0) return true;
    return false;
}

#define IS_ONE_OF(extension, list) is_one_of((extension), (list), sizeof(list) / sizeof *(list))

static const char *const gltf_formats[] = { "gltf", "glb" };
static const char *const program_formats[] = { "obj", "fbx", "x" };

static bool dispatch(struct import *import, const char *format, const struct file_bytes *bytes)
{
    if (IS_ONE_OF(format, gltf_formats)) return import_gltf(import, bytes);
    if (strcmp(format, "ply") == 0) return import_ply(import, bytes);
    if (IS_ONE_OF(format, program_formats)) return import_program(import, bytes);
    return host_fail(import->host, FAIL_UNSUPPORTED,
                     "%s: unknown kind of scene file; use glTF, GLB, OBJ, PLY, FBX or X",
                     import->path);
}

// Fills a new scene. `import` has host, path, and where other files come from.
static struct scene *import_scene(struct import *import, const char *format,
                                  const struct file_bytes *bytes, float scale)
{
    import->source_bytes = bytes->size;
    import->scene = scene_create(import->host, import->path);
    if (!import->scene) return NULL;
    import->scene->content_hash = hash_bytes(bytes->data, bytes->size, 0);
    const bool ok = dispatch(import, format, bytes);
    if (ok) scene_rescale(import->scene, scale);
    if (ok && limits_scene(import->scene)) {
        import_log_notes(import);
        return import->scene;
    }
    scene_destroy(import->scene);
    return NULL;
}

struct scene *import_file(struct host *host, const char *path, float scale)
{
    struct import import = { .host = host, .path = path };
    struct file_bytes bytes = { 0 };
    char format[16];
    if (!file_read(host, path, MAX_FILE_BYTES, &bytes)) return NULL;
    file_extension(path, format);
    struct scene *scene = import_scene(&import, format, &bytes, scale);
    file_bytes_finish(host, &bytes);
    return scene;
}

// ---- Files in memory

static bool begins_with(const struct file_bytes *bytes, const char *text)
{
    const size_t n = strlen(text);
    return bytes->size >= n && memcmp(bytes->data, text, n) == 0;
}

// JSON text; a byte order mark is allowed before it.
static bool is_json(const struct file_bytes *bytes)
{
    size_t at = begins_with(bytes, "\xef\xbb\xbf") ? 3 : 0;
    while (at < bytes->size && memchr(" \t\r\n", bytes->data[at], 4)) at++;
    return at < bytes->size && bytes->data[at] == '{';
}

// Wavefront OBJ has no signature.
static const char *format_of(const struct file_bytes *bytes)
{
    if (begins_with(bytes, "glTF")) return "glb";
    if (begins_with(bytes, "ply\n") || begins_with(bytes, "ply\r")) return "ply";
    if (begins_with(bytes, "Kaydara FBX")) return "fbx";
    if (begins_with(bytes, "xof ")) return "x";
    return is_json(bytes) ? "gltf" : "";
}

// The path, with an extension that states the format: from the bytes where the name has none.
static char *path_in_memory(struct host *host, const struct import_bytes *from,
                            const struct file_bytes *bytes, char format[16])
{
    const char *slash = strrchr(from->name, '/'), *name = slash ? slash + 1 : from->name;
    const char *folder = from->read || !from->folder ? "" : from->folder;
    file_extension(name, format);
    const bool known = IS_ONE_OF(format, gltf_formats) || IS_ONE_OF(format, program_formats) ||
                       strcmp(format, "ply") == 0;
    if (!known) strcpy(format, format_of(bytes));
    return host_sprintf(host, "%s%s%s%s%s", folder, folder[0] ? "/" : "", name,
                        known || !format[0] ? "" : ".", known ? "" : format);
}

struct scene *import_memory(struct host *host, const struct import_bytes *from)
{
    struct file_bytes bytes = { 0 };
    struct scene *scene = NULL;
    char format[16];
    // A zero byte follows the last, as in a file that was read.
    if (!file_bytes_copy(host, from->data, from->size, &bytes)) return NULL;
    char *path = path_in_memory(host, from, &bytes, format);
    if (path) {
        struct import import = { .host = host, .path = path, .memory = from };
        scene = import_scene(&import, format, &bytes, from->scale > 0.0f ? from->scale : 1.0f);
    }
    file_bytes_finish(host, &bytes);
    host_free(host, path);
    return scene;
}
