// Images of a scene file, decoded on all cores. Internal to src/scene.
#pragma once

#include "scene/import/import_context.h"

struct image_source {
    const char *name;    // in the scene's arena
    const uint8_t *data; // NULL: not there, and noted already
    size_t size;
    bool jpeg_and_png_only;
    bool is_tga; // which cannot be told from the bytes
};

// Appends the images to the scene in their order; scene_image[i] is the index of source i, -1 where
// it cannot be decoded (that is noted, not a failure). False when memory is out, or more than the
// file justifies.
bool import_images(struct import *import, const struct image_source *sources, int count,
                   int *scene_image);
