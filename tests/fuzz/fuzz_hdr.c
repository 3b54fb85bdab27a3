// A Radiance image in memory. Accepted images are finite, not negative and within the limits.
#include "fuzz/fuzz.h"

#include "image/hdr.h"

#include <math.h>

enum { MAX_BYTES = 64 << 20 }; // of one block: runs of a small file may be a large image

static void *limited_reallocate(void *user, void *old, size_t bytes)
{
    (void)user;
    if (bytes > MAX_BYTES) return NULL;
    if (bytes > 0) return realloc(old, bytes);
    free(old);
    return NULL;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct host host = *fuzz_host();
    struct image image;
    host.reallocate = limited_reallocate;
    const bool read = hdr_decode(&host, "input.hdr", data, size, &image);
    FUZZ_CHECK(read == (image.pixels != NULL));
    FUZZ_CHECK(read || host.failure != FAIL_NONE);
    const size_t values = (size_t)image.width * (size_t)image.height * (size_t)image.channels;
    FUZZ_CHECK(values * sizeof(float) <= MAX_BYTES);
    for (size_t i = 0; i < values; i++)
        FUZZ_CHECK(isfinite(image.pixels[i]) && image.pixels[i] >= 0.0f);
    image_finish(&image, &host);
    return 0;
}
