// Automatic exposure of an image; exposure_finish.comp is the GPU's version of the same rule.
#include "image/exposure.h"
#include "image/exposure_shared.h"

#include <math.h>
#include <string.h>

enum { BINS = 255 << EXPOSURE_OCTAVE_BITS }; // every finite float

struct histogram {
    uint32_t lit[BINS];
    uint32_t lit_count, black_count;
};

uint32_t exposure_stride(uint32_t width, uint32_t height)
{
    uint32_t stride = 1;
    while ((uint64_t)((width + stride - 1) / stride) * ((height + stride - 1) / stride) >
           EXPOSURE_SAMPLES)
        stride++;
    return stride;
}

static void count_pixel(struct histogram *h, const struct image *image, int x, int y)
{
    const float *p = image_at(image, x, y);
    if (image->channels >= 4 && p[3] == 0.0f) return;
    float value = image->channels >= 3 ? luminance(vec3_of(p[0], p[1], p[2])) : p[0];
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    if (value > 0.0f && isfinite(value))
        h->lit[bits >> EXPOSURE_BIN_SHIFT]++, h->lit_count++;
    else
        h->black_count++;
}

// Lowest bin up to which more than a share of the lit pixels lie.
static int percentile_bin(const struct histogram *h, float share)
{
    float wanted = share * (float)h->lit_count;
    uint32_t sum = 0;
    int bin = 0;
    while ((float)(sum += h->lit[bin]) <= wanted && bin < BINS - 1) bin++;
    return bin;
}

// log2 of the luminance in the middle of a bin.
static float bin_log2(int bin)
{
    const int octave = 1 << EXPOSURE_OCTAVE_BITS;
    float fraction = ((float)(bin % octave) + 0.5f) / (float)octave;
    return (float)(bin / octave - EXPOSURE_BIAS) + log2f(1.0f + fraction);
}

static double mean_log2(const struct histogram *h)
{
    int low = percentile_bin(h, EXPOSURE_LOW), high = percentile_bin(h, EXPOSURE_HIGH);
    double sum = (double)h->black_count * (double)bin_log2(low);
    for (int i = 0; i < BINS; i++) {
        if (h->lit[i] == 0) continue;
        int bin = i < low ? low : i > high ? high : i;
        sum += (double)h->lit[i] * (double)bin_log2(bin);
    }
    return sum / ((double)h->lit_count + (double)h->black_count);
}

// Middle of a cell of the grid, within the image.
static int middle_of(int begin, int stride, int size)
{
    int middle = begin + stride / 2;
    return middle < size ? middle : size - 1;
}

// log2 of the luminance that becomes middle grey.
static double metered_log2(const struct histogram *h, enum exposure_metering metering)
{
    const double mean = mean_log2(h);
    if (metering != METERING_HIGHLIGHTS) return mean;
    // Exposed to 1 by middle grey: the luminance of highlights times the latter.
    const double bright = (double)bin_log2(percentile_bin(h, EXPOSURE_HIGHLIGHTS)) +
                          log2((double)EXPOSURE_MIDDLE_GREY);
    return fmin(fmax(mean, bright), mean + (double)EXPOSURE_HIGHLIGHTS_LOSS);
}

float auto_exposure(const struct image *radiance, enum exposure_metering metering)
{
    struct histogram h;
    memset(&h, 0, sizeof h);
    int width = radiance->width, height = radiance->height;
    int stride = (int)exposure_stride((uint32_t)width, (uint32_t)height);
    for (int y = 0; y < height; y += stride)
        for (int x = 0; x < width; x += stride)
            count_pixel(&h, radiance, middle_of(x, stride, width), middle_of(y, stride, height));
    if (h.lit_count == 0) return 0.0f;
    // exposure_scale(EV) · metered = middle grey, solved for EV. Rounded so that twice the light
    // adds exactly 1.
    double solved = metered_log2(&h, metering) - log2(1.2 * (double)EXPOSURE_MIDDLE_GREY);
    float ev = (float)(round(solved * EXPOSURE_EV_STEPS) / EXPOSURE_EV_STEPS);
    return fmaxf(-EXPOSURE_EV_LIMIT, fminf(EXPOSURE_EV_LIMIT, ev));
}
