// Images of a scene from encoded files.
#include "scene/images/image_decode.h"
#include "scene/images/image_source.h"

// NULL, or the reason of failure.
static const char *find_size(const void *data, size_t size, struct scene_image *image,
                             char reason[DECODE_WHY_SIZE])
{
    const enum image_kind kind = image_kind_of(data, size);
    if (kind != IMAGE_JPEG && kind != IMAGE_PNG) return "neither JPEG nor PNG";
    return image_decode_size(data, size, &image->width, &image->height, reason);
}

int scene_add_encoded_image(struct scene *scene, const char *name, const void *data, size_t size,
                            bool linear)
{
    struct scene_image image = { .name = name, .linear = linear };
    char reason[DECODE_WHY_SIZE];
    const char *why = find_size(data, size, &image, reason);
    if (!why) {
        image.rgba = scene_alloc_texels(scene, name, image.width, image.height);
        if (!image.rgba) return -1;
        why = image_decode(data, size, image.width, image.height, image.rgba, reason);
    }
    if (why) // the decoder's reason may be empty
        host_fail(scene->host, FAIL_FORMAT, "image \"%s\" in %s: %s", name, scene->name,
                  why[0] ? why : "cannot be decoded");
    const int index = why ? -1 : scene_add_image(scene, &image);
    host_free(scene->host, image.rgba);
    return index;
}
