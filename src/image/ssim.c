// Structural similarity, Wang et al. 2004, eq. 13, with α = β = γ = 1 and the constants of section
// III.C. With d = a − b, a factor (2xy + C) / (x² + y² + C) is 1 − (x − y)² / (x² + y² + C), and
// σa² + σb² − 2 σab is the variance of d. In this form equal images give exactly 1, and four planes
// are filtered instead of five.
#include "image/ssim.h"

#include "image/filter.h"
#include "image/png_file.h"

#include <math.h>

enum { RADIUS = 5, BLOCK = 256 };
enum { GREY_A, GREY_B, SQUARES, DIFFERENCE_SQUARED, PLANES };

static const float C1 = 0.01f * 0.01f; // (K1 L)², K1 = 0.01, the range of values L = 1
static const float C2 = 0.03f * 0.03f; // (K2 L)², K2 = 0.03

struct job {
    const struct image *a, *b, *out;
    struct filter window;
};

static struct filter gaussian_window(void)
{
    const double sigma = 1.5;
    struct filter filter = { .shape = FILTER_EVEN, .radius = RADIUS };
    double weights[RADIUS + 1], sum = 0.0;
    for (int k = 0; k <= RADIUS; k++) {
        weights[k] = exp(-0.5 * k * k / (sigma * sigma));
        sum += k ? 2.0 * weights[k] : weights[k];
    }
    for (int k = 0; k <= RADIUS; k++) filter.weights[k] = (float)(weights[k] / sum);
    return filter;
}

static float grey_of(const float *pixel)
{
    vec3s display = glms_vec3_clamp(vec3_of(pixel[0], pixel[1], pixel[2]), 0.0f, 1.0f);
    return srgb_encode(luminance(display));
}

static void first_pass(const struct band *band, int row, int y)
{
    const struct job *job = band->user;
    float *grey_a = band_source(band, GREY_A, row), *grey_b = band_source(band, GREY_B, row);
    float *squares = band_source(band, SQUARES, row);
    float *difference = band_source(band, DIFFERENCE_SQUARED, row);
    for (int x = 0; x < band->width; x++) {
        float a = grey_of(image_at(job->a, x, y)), b = grey_of(image_at(job->b, x, y));
        grey_a[x] = a, grey_b[x] = b;
        squares[x] = a * a + b * b;
        difference[x] = (a - b) * (a - b);
    }
    for (int plane = 0; plane < PLANES; plane++) {
        band_pad_source(band, plane, row);
        filter_apply(&job->window, band_source(band, plane, row), 1, band->width,
                     band_middle(band, plane, row));
    }
}

static float similarity(float mean_a, float mean_b, float squares, float difference_squared)
{
    float means = mean_a * mean_a + mean_b * mean_b, d = mean_a - mean_b;
    float variances = fmaxf(squares - means, 0.0f);
    float variance_of_d = fmaxf(difference_squared - d * d, 0.0f);
    return (1.0f - d * d / (means + C1)) * (1.0f - variance_of_d / (variances + C2));
}

static void second_pass(const struct band *band, int row, int y)
{
    const struct job *job = band->user;
    for (int x0 = 0; x0 < band->width; x0 += BLOCK) {
        float sums[PLANES][BLOCK];
        int count = band->width - x0 < BLOCK ? band->width - x0 : BLOCK;
        for (int plane = 0; plane < PLANES; plane++)
            filter_apply(&job->window, band_middle(band, plane, row) + x0, (size_t)band->width,
                         count, sums[plane]);
        for (int i = 0; i < count; i++)
            *image_at(job->out, x0 + i, y) = similarity(
                sums[GREY_A][i], sums[GREY_B][i], sums[SQUARES][i], sums[DIFFERENCE_SQUARED][i]);
    }
}

bool ssim_map(struct host *host, const struct image *a, const struct image *b, struct image *out)
{
    if (!image_init(out, host, a->width, a->height, 1)) return false;
    struct job job = { a, b, out, gaussian_window() };
    struct band band = { .width = a->width,
                         .height = a->height,
                         .pad = RADIUS,
                         .source_count = PLANES,
                         .middle_count = PLANES,
                         .user = &job,
                         .first_pass = first_pass,
                         .second_pass = second_pass };
    if (band_run(&band, host)) return true;
    image_finish(out, host);
    return false;
}
