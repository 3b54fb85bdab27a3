// An image file of the format FUZZ_EXTENSION, read as `diff` reads it.
#include "fuzz/fuzz.h"

#include <afterglow/image.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static const char *const layers[] = { NULL, "albedo", "depth" };
    struct ag_context *context = fuzz_context();
    const char *path = fuzz_file(data, size, FUZZ_EXTENSION);
    char text[64];
    int width = 0, height = 0;
    const enum ag_result sized = ag_image_read_size(context, path, &width, &height);
    for (size_t i = 0; i < sizeof layers / sizeof *layers; i++) {
        struct ag_image *image = NULL;
        const enum ag_result result = ag_image_read(context, path, layers[i], &image);
        FUZZ_CHECK((result == AG_OK) == (image != NULL));
        FUZZ_CHECK(!image || (sized == AG_OK && image->width == width && image->height == height));
        ag_image_destroy(context, image);
    }
    (void)ag_image_read_attribute(context, path, "afterglow.scene", text, sizeof text);
    ag_context_destroy(context);
    return 0;
}
