// Images of a scene file, decoded in parallel. Internal to src/scene/import.
#pragma once

#include "scene/import/import_context.h"

struct image_source {
    const char *name;    // in the scene's arena
    const uint8_t *data; // NULL: missing, and noted already
    size_t size;
    bool jpeg_and_png_only;
    bool is_tga; // TGA has no signature
};

// Appends the images to the scene in their order; scene_image[i] is the index of source i, -1 if it
// cannot be decoded (noted, no failure). Sources of the same bytes (by address) become one image.
// False when out of memory or over budget.
bool import_images(struct import *import, const struct image_source *sources, int count,
                   int *scene_image);
