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
// The primitive of a mesh; borrowed. Meshes that are used twice share its accessors.
json_t *gltf_doc_primitive(struct scene_export *out, int mesh);
