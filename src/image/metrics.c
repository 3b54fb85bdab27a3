// Error measures between two images, and the picture of the error. Sums run in double, in row
// order, so that a result is the same on every run.
#include "image/metrics.h"

#include <math.h>
#include <stdlib.h>

static const double RELMSE_FLOOR =
    0.01; // of the reference's mean luminance: keeps black pixels finite

static bool check_finite(struct host *host, const struct image *image, const char *name)
{
    size_t bad = image_count_not_finite(image);
    if (!bad) return true;
    return host_fail(host, FAIL_ARGUMENT,
                     "cannot compare images: %zu of %zu pixels of %s are not finite", bad,
                     (size_t)image->width * (size_t)image->height, name);
}

static bool check_pair(struct host *host, const struct image *a, const struct image *b)
{
    if (a->width != b->width || a->height != b->height)
        return host_fail(host, FAIL_ARGUMENT, "cannot compare images: %dx%d against %dx%d",
                         a->width, a->height, b->width, b->height);
    if (a->channels < 3 || b->channels < 3)
        return host_fail(host, FAIL_ARGUMENT,
                         "cannot compare images: %d and %d channels, where each needs 3 or 4",
                         a->channels, b->channels);
    return check_finite(host, a, "the image") && check_finite(host, b, "the reference");
}

static void mean_rgb(const struct image *image, double mean[3])
{
    double sum[3] = { 0 };
    for (int y = 0; y < image->height; y++)
        for (int x = 0; x < image->width; x++)
            for (int c = 0; c < 3; c++) sum[c] += (double)image_at(image, x, y)[c];
    double pixels = (double)image->width * (double)image->height;
    for (int c = 0; c < 3; c++) mean[c] = sum[c] / pixels;
}

// The square of the floor of relmse's denominator.
static double relmse_floor_squared(const double mean_b[3])
{
    double m = 0.2126 * mean_b[0] + 0.7152 * mean_b[1] + 0.0722 * mean_b[2];
    if (m == 0.0) m = 1.0;
    return RELMSE_FLOOR * RELMSE_FLOOR * m * m;
}

bool metrics_compute(struct host *host, const struct image *a, const struct image *b,
                     struct metrics *out)
{
    *out = (struct metrics){ 0 };
    if (!check_pair(host, a, b)) return false;
    mean_rgb(a, out->mean_a);
    mean_rgb(b, out->mean_b);
    double floor_squared = relmse_floor_squared(out->mean_b);
    double squares = 0.0, absolutes = 0.0, relatives = 0.0;
    for (int y = 0; y < a->height; y++) {
        for (int x = 0; x < a->width; x++) {
            const float *p = image_at(a, x, y), *q = image_at(b, x, y);
            for (int c = 0; c < 3; c++) {
                double value = (double)q[c], difference = (double)p[c] - value;
                squares += difference * difference;
                absolutes += fabs(difference);
                relatives += difference * difference / (value * value + floor_squared);
            }
        }
    }
    double values = 3.0 * (double)a->width * (double)a->height;
    out->mse = squares / values;
    out->mae = absolutes / values;
    out->relmse = relatives / values;
    out->psnr = out->mse > 0.0 ? -10.0 * log10(out->mse) : (double)INFINITY;
    return true;
}

static int ascending(const void *a, const void *b)
{
    float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

// The 99th percentile (nearest rank), or the largest error where that is 0.
static bool usual_error(struct host *host, const float *errors, size_t count, float *out)
{
    float *sorted = host_alloc(host, count, sizeof *sorted);
    if (!sorted) return false;
    for (size_t i = 0; i < count; i++) sorted[i] = errors[i];
    qsort(sorted, count, sizeof *sorted, ascending);
    size_t rank = count - count / 100; // ⌈0.99 n⌉
    *out = sorted[rank - 1] > 0.0f ? sorted[rank - 1] : sorted[count - 1];
    host_free(host, sorted);
    return true;
}

// The colour scale, a path through OKLab (Ottosson 2020, "A perceptual color space for image
// processing") from black to white: the lightness is that of the grey of CIE L* = 100 t, the hue
// turns half a circle from blue-violet (280°) by red and orange to yellow (100°), and the chroma is
// a half wave as high, 0.18, as Rec. 709 can show all the way. So equal steps of error look about
// equally large and their order survives in grey.
static vec3s error_colour(float t)
{
    const float pi = 3.14159265f;
    float grey = t > 0.08f ? (100.0f * t + 16.0f) / 116.0f : cbrtf(100.0f * t / 903.3f);
    float chroma = 0.18f * sinf(pi * t);
    float hue_rad = (280.0f + 180.0f * t) * (pi / 180.0f);
    float a = chroma * cosf(hue_rad), b = chroma * sinf(hue_rad);
    float l = grey + 0.3963377774f * a + 0.2158037573f * b;
    float m = grey - 0.1055613458f * a - 0.0638541728f * b;
    float s = grey - 0.0894841775f * a - 1.2914855480f * b;
    l = l * l * l, m = m * m * m, s = s * s * s;
    vec3s rgb = vec3_of(4.0767416621f * l - 3.3077115913f * m + 0.2309699292f * s,
                        -1.2684380046f * l + 2.6097574011f * m - 0.3413193965f * s,
                        -0.0041960863f * l - 0.7034186147f * m + 1.7076147010f * s);
    return glms_vec3_clamp(rgb, 0.0f, 1.0f);
}

static float pixel_error(const float *a, const float *b)
{
    double sum = 0.0;
    for (int c = 0; c < 3; c++) sum += fabs((double)a[c] - (double)b[c]);
    return (float)fmin(sum / 3.0, 3.4e38);
}

bool metrics_error_map(struct host *host, const struct image *a, const struct image *b, float full,
                       struct image *out)
{
    *out = (struct image){ 0 };
    struct image errors = { 0 };
    if (isnan(full))
        return host_fail(host, FAIL_ARGUMENT,
                         "cannot map the error: the full scale is not a number");
    if (!check_pair(host, a, b)) goto fail;
    if (!image_init(&errors, host, a->width, a->height, 1)) goto fail;
    if (!image_init(out, host, a->width, a->height, 3)) goto fail;

    size_t count = (size_t)a->width * (size_t)a->height;
    for (int y = 0; y < a->height; y++)
        for (int x = 0; x < a->width; x++)
            *image_at(&errors, x, y) = pixel_error(image_at(a, x, y), image_at(b, x, y));
    if (!(full > 0.0f) && !usual_error(host, errors.pixels, count, &full)) goto fail;
    for (size_t i = 0; i < count; i++) {
        float t = full > 0.0f ? fminf(errors.pixels[i] / full, 1.0f) : 0.0f;
        vec3s colour = error_colour(t);
        for (int c = 0; c < 3; c++) out->pixels[3 * i + (size_t)c] = colour.raw[c];
    }
    image_finish(&errors, host);
    return true;
fail:
    image_finish(&errors, host);
    image_finish(out, host);
    return false;
}
