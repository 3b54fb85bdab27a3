// Images of a scene from other texel layouts and from encoded files.
#pragma once

#include "scene/scene.h"

#include <stddef.h>

// Texels of 1 to 4 bytes: grey, grey and alpha, RGB, RGBA; top row first.
struct texels {
    const uint8_t *bytes;
    int width, height, channels;
    size_t row_bytes; // at least width · channels
};

// RGBA, owned by the caller (host_free). NULL: the size is beyond SCENE_MAX_IMAGE_SIZE, or out of
// memory; the message says so.
uint8_t *scene_alloc_texels(struct scene *scene, const char *name, int width, int height);

// Each returns the index of the new image, -1 on failure.
int scene_add_texels(struct scene *scene, const char *name, const struct texels *texels,
                     bool linear);
// A PNG or JPEG file; untrusted.
int scene_add_encoded_image(struct scene *scene, const char *name, const void *data, size_t size,
                            bool linear);
