// An encoded texture in memory: JPEG, PNG, BMP, TGA.
#include "fuzz/fuzz.h"

#include "scene/images/image_decode.h"

enum { MAX_TEXELS = 1 << 22 };

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    int width = 0, height = 0;
    char why[DECODE_WHY_SIZE];
    if (image_decode_size(data, size, &width, &height, why)) return 0;
    FUZZ_CHECK(width > 0 && height > 0);
    if ((int64_t)width * height > MAX_TEXELS) return 0;
    uint8_t *rgba = malloc((size_t)width * (size_t)height * 4);
    FUZZ_CHECK(rgba);
    (void)image_decode(data, size, width, height, rgba, why);
    free(rgba);
    return 0;
}
