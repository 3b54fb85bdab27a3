#include "scene/images/image_source.h"

#include "scene/scene_check.h"

#include <string.h>

// Texels that are missing a channel: colours are equal, alpha is 1, as in PNG files.
static void expand_row(const uint8_t *from, int width, int channels, uint8_t *rgba)
{
    const bool grey = channels < 3, alpha = channels == 2 || channels == 4;
    for (int x = 0; x < width; x++, from += channels, rgba += 4) {
        for (int c = 0; c < 3; c++) rgba[c] = from[grey ? 0 : c];
        rgba[3] = alpha ? from[channels - 1] : 255;
    }
}

uint8_t *scene_alloc_texels(struct scene *scene, const char *name, int width, int height)
{
    if (width >= 1 && height >= 1 && width <= SCENE_MAX_IMAGE_SIZE &&
        height <= SCENE_MAX_IMAGE_SIZE)
        return host_alloc(scene->host, (size_t)width * (size_t)height, 4);
    scene_refuse(scene, "image", name, "its size is not 1 to 8192 texels");
    return NULL;
}

int scene_add_texels(struct scene *scene, const char *name, const struct texels *texels,
                     bool linear)
{
    struct scene_image image = {
        .name = name, .width = texels->width, .height = texels->height, .linear = linear
    };
    image.rgba = scene_alloc_texels(scene, name, image.width, image.height);
    if (!image.rgba) return -1;
    for (size_t y = 0; y < (size_t)image.height; y++)
        expand_row(texels->bytes + y * texels->row_bytes, image.width, texels->channels,
                   image.rgba + y * (size_t)image.width * 4);
    const int index = scene_add_image(scene, &image);
    host_free(scene->host, image.rgba);
    return index;
}
