// Error metrics between two images, and error maps. Sums are in double and in row order, so results
// are reproducible.
#include "image/metrics.h"

#include "image/flip.h"
#include "image/metrics_pair.h"
#include "image/ssim.h"
#include "image/tonemap.h"

#include <math.h>
#include <stdlib.h>

// Relative to the reference's mean luminance. For images of mean 1 its square is the 0.01 of
// Rousselle, Knaus & Zwicker 2011; with less, noise in the reference's darkest pixels dominates.
static const double RELMSE_FLOOR = 0.1;

static const struct metrics_options NO_OPTIONS = { 0 };

static void mean_rgb(const struct image *image, const struct metrics_pair *pair, double mean[3])
{
    double sum[3] = { 0 };
    size_t pixels = (size_t)image->width * (size_t)image->height,
           channels = (size_t)image->channels;
    for (size_t i = 0; i < pixels; i++)
        for (size_t c = 0; c < 3 && pair->counts[i]; c++)
            sum[c] += (double)image->pixels[channels * i + c];
    for (int c = 0; c < 3; c++) mean[c] = sum[c] / (double)pair->counted;
}

// The square of the floor of relmse's denominator.
static double relmse_floor_squared(const double mean_b[3])
{
    double m = 0.2126 * mean_b[0] + 0.7152 * mean_b[1] + 0.0722 * mean_b[2];
    if (m == 0.0) m = 1.0;
    return RELMSE_FLOOR * RELMSE_FLOOR * m * m;
}

// Sums over a pixel's channels.
struct differences {
    double squares, absolutes, relatives;
};

static struct differences differences_at(const struct metrics_pair *pair, size_t i,
                                         double floor_squared)
{
    const float *p = pair->a.pixels + i * (size_t)pair->a.channels;
    const float *q = pair->b.pixels + i * (size_t)pair->b.channels;
    struct differences sum = { 0 };
    for (int c = 0; c < 3; c++) {
        double value = (double)q[c], difference = (double)p[c] - value;
        sum.squares += difference * difference;
        sum.absolutes += fabs(difference);
        sum.relatives += difference * difference / (value * value + floor_squared);
    }
    return sum;
}

static void sum_differences(const struct metrics_pair *pair, struct metrics *out)
{
    mean_rgb(&pair->a, pair, out->mean_a);
    mean_rgb(&pair->b, pair, out->mean_b);
    double floor_squared = relmse_floor_squared(out->mean_b);
    size_t pixels = (size_t)pair->a.width * (size_t)pair->a.height;
    double values = 3.0 * (double)pair->counted;
    for (size_t i = 0; i < pixels; i++) {
        if (!pair->counts[i]) continue;
        struct differences d = differences_at(pair, i, floor_squared);
        out->mse += d.squares, out->mae += d.absolutes, out->relmse += d.relatives;
    }
    out->mse /= values, out->mae /= values, out->relmse /= values;
    out->psnr = out->mse > 0.0 ? -10.0 * log10(out->mse) : (double)INFINITY;
}

// ---- one value per pixel

static bool difference_errors(struct host *host, const struct metrics_pair *pair,
                              enum metrics_error error, struct image *out)
{
    if (!image_init(out, host, pair->a.width, pair->a.height, 1)) return false;
    double mean_b[3];
    mean_rgb(&pair->b, pair, mean_b);
    double floor_squared = relmse_floor_squared(mean_b);
    size_t pixels = (size_t)out->width * (size_t)out->height;
    for (size_t i = 0; i < pixels; i++) {
        struct differences d = differences_at(pair, i, floor_squared);
        double sum = error == METRICS_SQUARED    ? d.squares
                     : error == METRICS_RELATIVE ? d.relatives
                                                 : d.absolutes;
        out->pixels[i] = (float)fmin(sum / 3.0, 3.4e38);
    }
    return true;
}

// Both images tone-mapped, for ssim and flip.
static bool tonemap_pair(struct host *host, const struct metrics_pair *pair,
                         const struct metrics_options *options, struct image out[2])
{
    return image_tonemap(&out[0], host, &pair->a, options->ev, TONEMAP_NEUTRAL) &&
           image_tonemap(&out[1], host, &pair->b, options->ev, TONEMAP_NEUTRAL);
}

static float pixels_per_degree(const struct metrics_options *options)
{
    return options->pixels_per_degree != 0.0f ? options->pixels_per_degree : FLIP_PIXELS_PER_DEGREE;
}

static bool ssim_errors(struct host *host, const struct image *a, const struct image *b,
                        struct image *out)
{
    if (!ssim_map(host, a, b, out)) return false;
    size_t pixels = (size_t)out->width * (size_t)out->height;
    for (size_t i = 0; i < pixels; i++) out->pixels[i] = 1.0f - out->pixels[i];
    return true;
}

static bool display_errors(struct host *host, const struct metrics_pair *pair,
                           const struct metrics_options *options, enum metrics_error error,
                           struct image *out)
{
    struct image displayed[2] = { { 0 } };
    bool ok = !options->radiance || tonemap_pair(host, pair, options, displayed);
    const struct image *a = options->radiance ? &displayed[0] : &pair->a;
    const struct image *b = options->radiance ? &displayed[1] : &pair->b;
    if (ok)
        ok = error == METRICS_SSIM ? ssim_errors(host, a, b, out)
                                   : flip_map(host, a, b, pixels_per_degree(options), out);
    image_finish(&displayed[0], host);
    image_finish(&displayed[1], host);
    return ok;
}

static bool hdr_errors(struct host *host, const struct metrics_pair *pair,
                       const struct metrics_options *options, struct image *out)
{
    struct flip_exposures exposures;
    if (!options->radiance)
        return host_fail(host, FAIL_ARGUMENT,
                         "cannot compute HDR-FLIP: the images hold display values, not radiance");
    return flip_exposures_of(host, &pair->b, pair->counts, &exposures) &&
           flip_map_hdr(host, &pair->a, &pair->b, &exposures, pixels_per_degree(options), out);
}

static bool errors_of(struct host *host, const struct metrics_pair *pair,
                      const struct metrics_options *options, enum metrics_error error,
                      struct image *out)
{
    if (error == METRICS_FLIP_HDR) return hdr_errors(host, pair, options, out);
    if (error == METRICS_SSIM || error == METRICS_FLIP)
        return display_errors(host, pair, options, error, out);
    return difference_errors(host, pair, error, out);
}

static bool mean_error(struct host *host, const struct metrics_pair *pair,
                       const struct metrics_options *options, enum metrics_error error, double *out)
{
    struct image errors = { 0 };
    double sum = 0.0;
    if (!errors_of(host, pair, options, error, &errors)) return false;
    size_t pixels = (size_t)errors.width * (size_t)errors.height;
    for (size_t i = 0; i < pixels; i++)
        if (pair->counts[i]) sum += (double)errors.pixels[i];
    *out = sum / (double)pair->counted;
    image_finish(&errors, host);
    return true;
}

bool metrics_compute(struct host *host, const struct image *a, const struct image *b,
                     const struct metrics_options *options, struct metrics *out)
{
    struct metrics_pair pair = { 0 };
    struct metrics m = { .flip_hdr = (double)NAN };
    double dissimilarity = 0.0;
    *out = (struct metrics){ 0 };
    if (!options) options = &NO_OPTIONS;
    bool ok = metrics_pair_init(host, a, b, options, &pair);
    if (ok) sum_differences(&pair, &m);
    if (ok) ok = mean_error(host, &pair, options, METRICS_SSIM, &dissimilarity);
    if (ok) ok = mean_error(host, &pair, options, METRICS_FLIP, &m.flip);
    if (ok && options->radiance)
        ok = mean_error(host, &pair, options, METRICS_FLIP_HDR, &m.flip_hdr);
    m.ssim = 1.0 - dissimilarity;
    m.counted = pair.counted;
    m.ignored = pair.ignored;
    if (ok) *out = m;
    metrics_pair_finish(&pair, host);
    return ok;
}

bool metrics_errors(struct host *host, const struct image *a, const struct image *b,
                    const struct metrics_options *options, enum metrics_error error,
                    struct image *out)
{
    struct metrics_pair pair = { 0 };
    *out = (struct image){ 0 };
    if (!options) options = &NO_OPTIONS;
    bool ok = metrics_pair_init(host, a, b, options, &pair) &&
              errors_of(host, &pair, options, error, out);
    size_t pixels = ok ? (size_t)a->width * (size_t)a->height : 0;
    for (size_t i = 0; i < pixels; i++)
        if (!pair.counts[i]) out->pixels[i] = 0.0f;
    metrics_pair_finish(&pair, host);
    return ok;
}

// ---- error maps

static int ascending(const void *a, const void *b)
{
    float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

// The 99th percentile (nearest rank) of all pixels, or the maximum where that is 0.
static bool percentile_error(struct host *host, const float *errors, size_t count, float *out)
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

// A perceptually uniform colour map through OKLab (Ottosson 2020, "A perceptual color space for
// image processing") from black to white: lightness of CIE L* = 100 t, hue from blue-violet (280°)
// through red and orange to yellow (100°), chroma a half sine wave with the largest amplitude that
// stays inside Rec. 709 (0.18). Its order is preserved in grey.
static vec3s error_colour(float t)
{
    float grey = t > 0.08f ? (100.0f * t + 16.0f) / 116.0f : cbrtf(100.0f * t / 903.3f);
    float chroma = 0.18f * sinf(GLM_PIf * t);
    float hue_rad = (280.0f + 180.0f * t) * (GLM_PIf / 180.0f);
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

bool metrics_error_map(struct host *host, const struct image *a, const struct image *b,
                       const struct metrics_options *options, enum metrics_error error, float full,
                       struct image *out)
{
    *out = (struct image){ 0 };
    struct image errors = { 0 };
    bool bounded = error == METRICS_SSIM || error == METRICS_FLIP || error == METRICS_FLIP_HDR;
    if (isnan(full))
        return host_fail(host, FAIL_ARGUMENT,
                         "cannot map the error: the full scale is not a number");
    if (!metrics_errors(host, a, b, options, error, &errors)) goto fail;
    if (!image_init(out, host, a->width, a->height, 3)) goto fail;

    size_t count = (size_t)a->width * (size_t)a->height;
    if (!(full > 0.0f) && bounded) full = 1.0f;
    if (!(full > 0.0f) && !percentile_error(host, errors.pixels, count, &full)) goto fail;
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
