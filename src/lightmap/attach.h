// Light-map coordinates of a scene's instances in a glTF document.
#pragma once

#include "lightmap/lightmap.h"
#include "scene/export/gltf_doc.h"

// Each instance with charts gets a mesh of its own, which shares its accessors with the others
// where the charts divide no vertex. Its primitives get the coordinates as the first TEXCOORD set
// from 1 on that their materials do not use, which their extras state.
bool lightmap_attach(struct gltf_doc *doc, const struct charts *charts, const struct scene *scene);

#define LIGHTMAP_EXTRAS "afterglow_lightmap"
