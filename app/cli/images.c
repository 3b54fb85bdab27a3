// Reads images and checks them for NaN.
#include "images.h"

#include <math.h>

enum status image_load(struct session *session, const char *path, const char *layer,
                       struct ag_image **out)
{
    enum ag_result result = ag_image_read(session->context, path, layer, out);
    if (result == AG_OK) return DONE;
    fail_library(session->context, result);
    return FAILED;
}

double image_luminance(const float rgb[3])
{
    return 0.2126 * (double)rgb[0] + 0.7152 * (double)rgb[1] + 0.0722 * (double)rgb[2];
}

enum ag_result image_exposure(const struct session *session, const struct ag_image *radiance,
                              const struct ag_image *depth, float *ev)
{
    struct ag_image *metered = NULL;
    enum ag_result result =
        ag_image_create(session->context, radiance->width, radiance->height, 4, &metered);
    if (result != AG_OK) return result;
    size_t count = (size_t)radiance->width * (size_t)radiance->height;
    for (size_t i = 0; i < count; i++) {
        const float *rgb = &radiance->pixels[i * (size_t)radiance->channels];
        for (size_t k = 0; k < 3; k++) metered->pixels[4 * i + k] = rgb[k];
        metered->pixels[4 * i + 3] = depth->pixels[i * (size_t)depth->channels] > 0.0f;
    }
    *ev = ag_image_metered_exposure(metered, session->arguments->metering);
    ag_image_destroy(session->context, metered);
    return AG_OK;
}

static size_t count_not_finite(const struct ag_image *image, const struct ag_image *mask)
{
    size_t count = 0, channels = (size_t)image->channels;
    size_t pixels = (size_t)image->width * (size_t)image->height;
    for (size_t i = 0; i < pixels; i++) {
        bool finite = true;
        for (size_t c = 0; c < channels; c++)
            finite &= isfinite(image->pixels[channels * i + c]) != 0;
        count += !finite && (!mask || mask->pixels[i] > 0.0f);
    }
    return count;
}

enum status image_check(const struct session *session, const struct ag_image *image,
                        const struct ag_image *mask, const char *name)
{
    size_t bad = count_not_finite(image, mask);
    if (bad == 0) return DONE;
    if (!session->arguments->ignore_nan)
        return fail("cannot compare %s: %zu of its pixels are NaN or infinite", name, bad);
    note("%s: %zu of its pixels are NaN or infinite and do not count", name, bad);
    return DONE;
}
