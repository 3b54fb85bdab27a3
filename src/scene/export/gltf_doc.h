// A glTF 2.0 document in memory with one buffer, to be written as GLB: of a file, whose JSON and
// bytes it keeps, or of any scene.
#pragma once

#include "scene/scene.h"

#include <jansson.h>

// The place of a scene's instance in the document.
struct gltf_place {
    size_t node, mesh, primitive; // indices; primitive: in the mesh
};

// A JSON call that fails for lack of memory sets `failed`; gltf_doc_write then fails.
struct gltf_doc {
    struct host *host;
    json_t *root;
    uint8_t *binary; // the buffer 0
    size_t size, capacity;
    struct gltf_place *places; // [place_count] of the scene's first instances
    int place_count;
    bool *off_lights; // [off_light_count] of light definitions: none of the scene's lights uses it
    size_t off_light_count; // of the file; later definitions are of the scene's lights
    int file_place_count; // first ones, with the vertices of mesh.source; others with those of mesh
    bool failed;
};
// gltf_doc_finish accepts zero.
bool gltf_doc_init(struct gltf_doc *doc, struct host *host);
void gltf_doc_finish(struct gltf_doc *doc);

// The file that the scene was loaded from, with the lights, instances, sky and environment that the
// scene has beyond it, if it is glTF and otherwise unchanged. *same: it is.
bool gltf_doc_of_file(struct gltf_doc *doc, struct host *host, const struct scene *scene,
                      bool *same);
// The scene itself. Removed instances have the place of node SIZE_MAX.
bool gltf_doc_of_scene(struct gltf_doc *doc, struct host *host, const struct scene *scene);

// GLB, complete or not at all.
bool gltf_doc_write(struct gltf_doc *doc, const char *path);

// ---- Additions. All take over new references; NULL is out of memory.

json_t *gltf_doc_array(struct gltf_doc *doc, const char *name); // created where absent
// Returns its index.
size_t gltf_doc_add(struct gltf_doc *doc, const char *array, json_t *element);
void gltf_doc_set(struct gltf_doc *doc, json_t *object, const char *key, json_t *value);
// The member, an object, created where absent.
json_t *gltf_doc_child(struct gltf_doc *doc, json_t *object, const char *key);
void gltf_doc_use_extension(struct gltf_doc *doc, const char *name);
json_t *gltf_doc_text(const char *text); // bytes that are not UTF-8 become '?'
json_t *gltf_doc_floats(const float *values, size_t count);

enum gltf_component { GLTF_USHORT = 5123, GLTF_UINT = 5125, GLTF_FLOAT = 5126 };
size_t gltf_doc_add_view(struct gltf_doc *doc, const void *data, size_t size);
// type: "SCALAR", "VEC2", …
// A new accessor whose element i is element source[i] of a given one of `given` elements, with its
// range where that states one. False (host_fail) where the elements are not in the buffer, or their
// number is another one.
bool gltf_doc_gather_accessor(struct gltf_doc *doc, size_t accessor, size_t given,
                              const uint32_t *source, size_t count, size_t *out);
size_t gltf_doc_add_accessor(struct gltf_doc *doc, const void *data, enum gltf_component component,
                             const char *type, size_t count);
