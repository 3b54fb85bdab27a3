// FLIP's filters, Andersson et al. 2020, sections 4.1.1 and 4.2. The contrast sensitivity functions
// are sums of Gaussians a·exp(−b f²) over spatial frequency f; over visual angle x (degrees) the
// filters are a √(π/b) exp(−π² x²/b), separable in both axes. Truncation to a square and
// normalization on it follow the paper.
#include "image/flip_filters.h"

#include "core/vec.h"

#include <math.h>

// Table 1 of the paper.
static const double LIGHTNESS_B = 0.0047, RED_GREEN_B = 0.0053;
static const double WIDE_A = 34.1, WIDE_B = 0.04, NARROW_A = 13.5, NARROW_B = 0.025;
static const double FEATURE_WIDTH_DEG = 0.082; // between the extremes of the edge filter: 2 σ

enum { SIGMAS = 3, SIGMAS_KEPT = 6 }; // exp(−6²/2) is below float precision

// A Gaussian of standard deviation sigma_px, normalized to 1 and truncated where weights fall below
// float precision. Returns the sum before normalization.
static double make_gaussian(double sigma_px, int radius, struct filter *out)
{
    int kept = (int)ceil(SIGMAS_KEPT * sigma_px);
    double weights[FILTER_RADIUS_MAX + 1], sum = 0.0;
    *out = (struct filter){ .shape = FILTER_EVEN, .radius = kept < radius ? kept : radius };
    for (int k = 0; k <= out->radius; k++) {
        weights[k] = exp(-0.5 * k * k / (sigma_px * sigma_px));
        sum += k ? 2.0 * weights[k] : weights[k];
    }
    for (int k = 0; k <= out->radius; k++) out->weights[k] = (float)(weights[k] / sum);
    return sum;
}

static double sigma_deg(double b)
{
    return sqrt(b / 2.0) / GLM_PI;
}

static void make_contrast_sensitivity(double pixels_per_degree, struct flip_filters *out)
{
    int radius = (int)ceil(SIGMAS * sigma_deg(WIDE_B) * pixels_per_degree);
    make_gaussian(sigma_deg(LIGHTNESS_B) * pixels_per_degree, radius, &out->filter[FLIP_LIGHTNESS]);
    make_gaussian(sigma_deg(RED_GREEN_B) * pixels_per_degree, radius, &out->filter[FLIP_RED_GREEN]);
    double wide = make_gaussian(sigma_deg(WIDE_B) * pixels_per_degree, radius,
                                &out->filter[FLIP_BLUE_YELLOW_WIDE]);
    double narrow = make_gaussian(sigma_deg(NARROW_B) * pixels_per_degree, radius,
                                  &out->filter[FLIP_BLUE_YELLOW_NARROW]);
    wide *= wide * WIDE_A * sqrt(GLM_PI / WIDE_B);
    narrow *= narrow * NARROW_A * sqrt(GLM_PI / NARROW_B);
    out->wide_share = (float)(wide / (wide + narrow));
    out->radius = radius;
}

// Derivatives of a Gaussian. Positive weights sum to 1, negative ones to −1; the product with the
// normalized Gaussian of the other axis keeps these sums.
static void make_features(double pixels_per_degree, struct flip_filters *out)
{
    double sigma = 0.5 * FEATURE_WIDTH_DEG * pixels_per_degree, variance = sigma * sigma;
    int radius = (int)ceil(SIGMAS * sigma);
    make_gaussian(sigma, radius, &out->filter[FLIP_SMOOTH]);
    struct filter slope = { .shape = FILTER_ODD, .radius = radius };
    struct filter curvature = { .shape = FILTER_EVEN_ZERO_SUM, .radius = radius };
    double slopes = 0.0, positive = 0.0, negative = 1.0; // the centre's weight is −1
    for (int k = 1; k <= radius; k++) {
        double gaussian = exp(-0.5 * k * k / variance);
        double second = (k * k / variance - 1.0) * gaussian;
        slopes += k * gaussian;
        *(second > 0.0 ? &positive : &negative) += 2.0 * fabs(second);
    }
    for (int k = 1; k <= radius; k++) {
        double gaussian = exp(-0.5 * k * k / variance);
        double second = (k * k / variance - 1.0) * gaussian;
        slope.weights[k] = (float)(k * gaussian / slopes);
        curvature.weights[k] = (float)(second / (second > 0.0 ? positive : negative));
    }
    out->filter[FLIP_SLOPE] = slope;
    out->filter[FLIP_CURVATURE] = curvature;
    if (radius > out->radius) out->radius = radius;
}

void flip_filters_make(float pixels_per_degree, struct flip_filters *out)
{
    *out = (struct flip_filters){ 0 };
    make_contrast_sensitivity((double)pixels_per_degree, out);
    make_features((double)pixels_per_degree, out);
}
