// The state of a glTF 2.0 import. Internal to src/scene/import/gltf: gltf_file.c opens the file,
// gltf_check.c checks version, extensions and nodes, gltf_accessor.c decodes arrays, the other
// files fill the scene in the order of import_gltf.
#pragma once

#include "scene/import/import_context.h"

#include <jansson.h>

// An environment in the extras of the default scene, and the mark of the light that is its sun:
// readers that do not know the former have the latter.
#define GLTF_ENVIRONMENT     "afterglow_environment"
#define GLTF_ENVIRONMENT_SUN "afterglow_environment_sun"

struct gltf_buffer {
    const uint8_t *data;
    size_t size;
    char *path;  // of an external file, else NULL; buffers of the same path share data
    void *owned; // memory to free; NULL if data is shared
};

struct gltf_cached { // an accessor's array, decoded once
    void *array;
    int width;
};

struct gltf {
    struct import *import;
    json_t *root;
    json_t *empty; // an empty array, for absent ones
    json_t *accessors, *views, *nodes, *meshes, *materials, *textures, *images, *samplers, *skins,
        *cameras, *lights, *animations; // arrays, empty where absent; borrowed from root
    const uint8_t *binary;              // the BIN chunk of a GLB, else NULL
    size_t binary_size;
    struct gltf_buffer *buffers;
    size_t buffer_count;
    struct gltf_cached *cached;   // per accessor
    uint32_t *scene_node;         // glTF node → scene node (parents first)
    uint8_t *in_scene;            // glTF node → 1 if it belongs to the default scene
    int *first_mesh, *mesh_parts; // glTF mesh → its scene meshes (one per triangle primitive)
    int *image_of;                // glTF image → scene image, -1
    int default_material;         // scene material for primitives without, -1 until needed
    bool failed;                  // a value was invalid; the message has been logged
};

// --- gltf_json.c: JSON values with type and range checks. An invalid value logs one message and
// sets `failed`; the result is then the fallback, so that callers can check `failed` once at the
// end.

struct gltf_object {
    struct gltf *gltf;
    json_t *json; // an object; NULL: all members are absent
    const char *kind;
    size_t index; // "materials", 3
};

struct gltf_object gltf_element(struct gltf *gltf, json_t *array, const char *kind, size_t i);
struct gltf_object gltf_child(struct gltf_object object, const char *key);
struct gltf_object gltf_extension(struct gltf_object object, const char *name);
bool gltf_has(struct gltf_object object, const char *key);
json_t *gltf_array(struct gltf_object object, const char *key); // never NULL
// Fails with a message that begins with the object's kind and index. Always false; a macro, so that
// static analysers know the value.
#define gltf_wrong(...) gltf_false(gltf_set_wrong(__VA_ARGS__))
bool gltf_set_wrong(struct gltf_object object, const char *format, ...)
    __attribute__((format(printf, 2, 3)));
static inline bool gltf_false(bool failed)
{
    (void)failed;
    return false;
}
int gltf_index(struct gltf_object object, const char *key, json_t *of); // -1: absent
int gltf_index_value(struct gltf_object object, const char *key, json_t *value, json_t *of);
size_t gltf_size(struct gltf_object object, const char *key, size_t fallback, size_t max);
float gltf_float(struct gltf_object object, const char *key, float fallback, float min, float max);
bool gltf_bool(struct gltf_object object, const char *key, bool fallback);
// True when present and valid.
bool gltf_floats(struct gltf_object object, const char *key, int count, float *out);
const char *gltf_string(struct gltf_object object, const char *key); // NULL: absent

// --- gltf_file.c
bool gltf_open(struct gltf *gltf, struct import *import, const struct file_bytes *bytes);
void gltf_close(struct gltf *gltf);
bool gltf_load_buffers(struct gltf *gltf);
// The bytes of the base64 payload of a data URI of `object`, owned by the caller; NULL after a
// failure.
uint8_t *gltf_data_uri(struct gltf_object object, const char *uri, size_t *size);

// --- gltf_check.c
bool gltf_check_asset(struct gltf *gltf); // version, extensions
bool gltf_order_nodes(struct gltf *gltf); // fills scene_node and in_scene; refuses loops

// --- gltf_accessor.c
struct gltf_view {
    const uint8_t *data;
    size_t size, stride; // stride 0: tight
};
bool gltf_view(struct gltf *gltf, int index, struct gltf_view *out);
// The number of elements, 0 on failure.
size_t gltf_accessor_count(struct gltf *gltf, int accessor);
// Components per element: 1, 2, 3, 4, 16; 0 on failure.
int gltf_accessor_width(struct gltf *gltf, int accessor);
// All elements as floats: normalised integers as fractions, sparse values applied. In the scene's
// arena, cached per accessor. `width`: expected components per element. NULL on failure.
float *gltf_floats_of(struct gltf *gltf, int accessor, int width);
// Unsigned integers (indices, joints) in the scene's arena, not cached. NULL on failure.
uint32_t *gltf_integers_of(struct gltf *gltf, int accessor, int width);

// --- gltf_image.c
struct import_files;
struct image_source;
// The encoded bytes of an image, from a buffer, a data URI (*owned, to be freed) or a file.
bool gltf_find_image(struct gltf *gltf, size_t i, struct import_files *files,
                     struct image_source *out, void **owned);

// --- parts of the scene, in this order
bool gltf_load_materials(struct gltf *gltf); // with their images
// The scene material of primitives without a material; -1 on failure.
int gltf_material_default(struct gltf *gltf);
bool gltf_load_meshes(struct gltf *gltf);
bool gltf_load_nodes(struct gltf *gltf); // nodes, instances, lights, cameras
bool gltf_load_skins(struct gltf *gltf);
bool gltf_load_animations(struct gltf *gltf);
bool gltf_load_environment(struct gltf *gltf);
// Whether the light is the sun of an environment in extras.
bool gltf_is_environment_sun(const json_t *light);
// The environment in the extras of a scene, which has it (gltf_environment_extras.c).
bool gltf_load_environment_extras(struct gltf_object scene);

// The cube map of an image-based light (gltf_cube.c) as a map of the environment. NULL: it is not
// usable, and noted, or *ok is false.
struct environment_map;
const struct environment_map *gltf_cube_map(struct gltf *gltf, struct gltf_object light,
                                            versors world_from_cube, bool *ok);
