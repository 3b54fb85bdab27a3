// PNG in memory through libpng's simplified interface.
#include "image/png_file.h"

#include <png.h>

bool png_encode(struct host *host, const uint8_t *rgba, int width, int height, uint8_t **out,
                size_t *size)
{
    png_image image = { .version = PNG_IMAGE_VERSION,
                        .width = (png_uint_32)width,
                        .height = (png_uint_32)height,
                        .format = PNG_FORMAT_RGBA };
    png_alloc_size_t bytes = 0;
    *out = NULL;
    bool ok = png_image_write_to_memory(&image, NULL, &bytes, 0, rgba, 0, NULL);
    if (ok) *out = host_alloc(host, bytes, 1);
    ok = *out && png_image_write_to_memory(&image, *out, &bytes, 0, rgba, 0, NULL);
    if (!ok) host_fail(host, FAIL_MEMORY, "PNG of %dx%d pixels: %s", width, height, image.message);
    png_image_free(&image);
    *size = bytes;
    return ok;
}
