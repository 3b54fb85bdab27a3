// The importer program: reads an OBJ, FBX or X file through Assimp and writes it as glTF
// (scene/import/import_stream.h). A process of its own, since hostile files end Assimp. It keeps
// nothing and never returns from a failure, so that memory is not freed.
#pragma once

#include <assimp/cfileio.h>
#include <assimp/cimport.h>
#include <assimp/scene.h>
#include <jansson.h>

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

// --- output.c
void output_open(void); // takes over the standard output
int output_descriptor(void);
void output_note(const char *feature);
void output_log(const char *format, ...) __attribute__((format(printf, 1, 2)));
_Noreturn void output_fail(const char *kind, const char *format, ...)
    __attribute__((format(printf, 2, 3)));
_Noreturn void output_glb(const char *json, const uint8_t *binary, size_t size); // ends the program

// Zeroed; fails where memory ends.
void *allocate(size_t count, size_t size);

// --- files.c: the imported file and others of its folder
struct files_options {
    bool from_input;   // the imported file's bytes are the standard input, a file in memory
    bool follow_links; // that lead out of the folder
};
struct aiFileIO files_of(const char *path, const struct files_options *options);
const char *files_extension(const char *path); // "obj", lower case, static storage

// --- glb.c: the parts of a glTF file
struct glb {
    json_t *root;
    uint8_t *binary;
    size_t size, capacity;
};
struct glb glb_begin(void);
// Appends to an array of the file ("nodes"); returns the index. Takes over the element.
size_t glb_add(struct glb *glb, const char *array, json_t *element);
size_t glb_count(const struct glb *glb, const char *array);
size_t glb_add_view(struct glb *glb, const void *data, size_t size);
enum { GLB_USHORT = 5123, GLB_UINT = 5125, GLB_FLOAT = 5126 };
size_t glb_add_accessor(struct glb *glb, const void *data, int component, const char *type,
                        size_t count);
void glb_set(json_t *object, const char *key, json_t *value); // fails where memory ends
json_t *glb_text(const char *text);                           // valid UTF-8 whatever it is
json_t *glb_floats(const float *values, size_t count);        // which are finite
_Noreturn void glb_write(struct glb *glb);

// --- the parts of a scene, in this order
struct importer {
    struct glb glb;
    const struct aiScene *from;
    const struct aiNode **nodes; // by glTF index, parents first
    size_t node_count;
    json_t *node_of; // name → glTF index of the first node
    int *mesh_of;    // aiMesh → glTF mesh, -1 without triangles
    int *skin_of;    // aiMesh → glTF skin, -1
    bool *animated;  // by glTF node
};
void import_materials(struct importer *importer);
void import_meshes(struct importer *importer);
void import_node_list(struct importer *importer); // fills nodes, node_count, node_of
void import_skins(struct importer *importer);
void import_animations(struct importer *importer); // fills animated
void import_nodes(struct importer *importer);
int importer_find_node(const struct importer *importer, const struct aiString *name); // -1: none
