// Parts of a document that has a scene's content, for gltf_doc_scene*.c.
#pragma once

#include "scene/export/gltf_doc.h"

struct scene_export {
    struct gltf_doc *doc;
    const struct scene *scene;
    json_t **attributes; // [meshes] of the primitive, once it is exported; borrowed
    json_t **primitives; // [meshes] likewise
};

void gltf_doc_materials(struct scene_export *out); // with images, textures and samplers
void gltf_doc_animations(struct scene_export *out);
// A material, which refers to the scene's images by their index.
json_t *gltf_doc_material(struct gltf_doc *doc, const struct material *material);
// A node with its name, transform and extras.
json_t *gltf_doc_node(struct gltf_doc *doc, const struct node *node);
// States at a node that its instance is movable.
void gltf_doc_mobility(struct gltf_doc *doc, json_t *node, const struct instance *instance);
// Defines the light and refers to it at a node without one.
void gltf_doc_light(struct gltf_doc *doc, json_t *node, const struct light *light);
// The environment's map and its sun, in a scene of the document that has none.
void gltf_doc_environment(struct gltf_doc *doc, json_t *scene,
                          const struct environment *environment);
void gltf_doc_remove_environment(struct gltf_doc *doc, json_t *scene);
// Appends an index to a member, an array, created where absent.
void gltf_doc_append(struct gltf_doc *doc, json_t *object, const char *key, size_t value);
// The primitive of a mesh; borrowed. Meshes that are used twice share its accessors.
json_t *gltf_doc_primitive(struct scene_export *out, int mesh);
void gltf_doc_finish_primitives(struct scene_export *out);

// ---- gltf_doc_added.c: what the scene has that the file of the document has not

struct gltf;
// Whether gltf_doc_add_rest can write all of it. file_nodes: nodes of the file.
bool gltf_doc_can_add(const struct gltf_doc *doc, const struct scene *scene, size_t file_nodes);
// Lights, instances, the sky and the environment; finds off_lights. Needs places for all instances
// of the scene.
bool gltf_doc_add_rest(struct gltf_doc *doc, struct gltf *gltf, const struct scene *scene);
