// Images in memory: bounded allocation and basic operations.
#include "image/image.h"

#include <string.h>

bool image_init(struct image *image, struct host *host, int width, int height, int channels)
{
    *image = (struct image){ 0 };
    if (width < 1 || height < 1 || width > IMAGE_MAX_SIZE || height > IMAGE_MAX_SIZE)
        return host_fail(host, FAIL_ARGUMENT,
                         "cannot make an image of %dx%d: each side must be 1 to %d", width, height,
                         IMAGE_MAX_SIZE);
    if (channels < 1 || channels > 4)
        return host_fail(host, FAIL_ARGUMENT,
                         "cannot make an image of %d channels: 1 to 4 are possible", channels);
    size_t values;
    if (!size_mul((size_t)width, (size_t)height, &values) ||
        !size_mul(values, (size_t)channels, &values))
        return host_fail(host, FAIL_MEMORY, "cannot make an image of %dx%d: too large", width,
                         height);
    float *pixels = host_alloc(host, values, sizeof *pixels);
    if (!pixels) return false;
    *image = (struct image){ width, height, channels, pixels };
    return true;
}

void image_finish(struct image *image, struct host *host)
{
    host_free(host, image->pixels);
    *image = (struct image){ 0 };
}

bool image_part(struct image *out, struct host *host, const struct image *from, int x, int y,
                int width, int height)
{
    if (!image_init(out, host, width, height, from->channels)) return false;
    const size_t row_bytes = (size_t)width * (size_t)from->channels * sizeof(float);
    for (int row = 0; row < height; row++)
        memcpy(image_at(out, 0, row), image_at(from, x, y + row), row_bytes);
    return true;
}

static void copy_rows(struct image *out, const struct image *in, int x)
{
    size_t row_bytes = (size_t)in->width * (size_t)in->channels * sizeof(float);
    for (int y = 0; y < in->height; y++) memcpy(image_at(out, x, y), image_at(in, 0, y), row_bytes);
}

bool image_side_by_side(struct image *out, struct host *host, const struct image *a,
                        const struct image *b, int gap)
{
    *out = (struct image){ 0 };
    if (a->height != b->height || a->channels != b->channels)
        return host_fail(
            host, FAIL_ARGUMENT,
            "cannot put images side by side: %dx%d of %d channels and %dx%d of %d channels "
            "differ in height or channels",
            a->width, a->height, a->channels, b->width, b->height, b->channels);
    if (gap < 0 || gap > IMAGE_MAX_SIZE)
        return host_fail(host, FAIL_ARGUMENT,
                         "cannot put images side by side: a gap of %d columns is not in 0 to %d",
                         gap, IMAGE_MAX_SIZE);
    if (!image_init(out, host, a->width + gap + b->width, a->height, a->channels)) return false;
    copy_rows(out, a, 0);
    copy_rows(out, b, a->width + gap);
    return true;
}
