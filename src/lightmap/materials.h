// The light map as a texture of a glTF document's materials: the extension MOZ_lightmap.
#pragma once

#include "scene/export/gltf_doc.h"

// Removes the light map of an earlier copy from materials and primitives; its texture stays.
void lightmap_forget(struct gltf_doc *doc);

struct lightmap_image {
    const uint8_t *png; // NULL: none; materials are divided alone
    size_t size;
    float range; // lux of the value 1
    const char *name;
};
// Gives the images of the map's pages to the materials of all primitives with coordinates of the
// map, whose extras state them and the page. A material that others use without the map, on another
// page, or with another set of coordinates, is copied for them. Unlit materials stay as they are.
bool lightmap_materials(struct gltf_doc *doc, const struct lightmap_image *pages,
                        uint32_t page_count);
