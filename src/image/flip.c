// FLIP. Andersson et al. 2020: a colour pipeline (section 4.1) and a feature pipeline for edges and
// points (section 4.2), combined as ΔE = ΔEc^(1 − ΔEf) (eq. 17). Andersson et al. 2021: the maximum
// over exposures, with a fit of the ACES tone mapper (Narkowicz 2015, "ACES Filmic Tone Mapping
// Curve"). Colours are stored as XYZ over the white point W, in which CIELAB and YCxCz are linear
// differences; constant offsets and factors are applied after the linear filters.
#include "image/flip.h"

#include "image/flip_filters.h"

#include <math.h>
#include <stdlib.h>

enum { BLOCK = 128 };
enum { LIGHTNESS, RED_GREEN, BLUE_YELLOW, SOURCES }; // Y, X − Y, Y − Z, over white

struct exposure {
    bool tone_mapped; // false: display values
    float scale;
};

struct job {
    const struct image *images[2], *out;
    struct exposure exposure;
    struct flip_filters filters;
    float largest_difference; // of two colours in the unit cube, to the power of COLOUR_POWER
};

static const float COLOUR_POWER = 0.7f;              // q_c
static const float KNEE_IN = 0.4f, KNEE_OUT = 0.95f; // p_c, p_t
static const float BRIGHT = 0.85f; // exposure target of the brightest pixel and the median (2021)

// ---- colours

// Linear Rec. 709 to XYZ over white (D65), and back.
static vec3s xyz_from_rgb(vec3s c)
{
    return vec3_of(0.43389539f * c.x + 0.37624237f * c.y + 0.18986224f * c.z,
                   0.21263682f * c.x + 0.71518298f * c.y + 0.07218020f * c.z,
                   0.01775242f * c.x + 0.10946563f * c.y + 0.87278195f * c.z);
}

static vec3s rgb_from_xyz(vec3s c)
{
    return vec3_of(3.08034199f * c.x - 1.53739897f * c.y - 0.54294302f * c.z,
                   -0.92117840f * c.x + 1.87592998f * c.y + 0.04524841f * c.z,
                   0.05288129f * c.x - 0.20401121f * c.y + 1.15112991f * c.z);
}

static float lab_curve(float t)
{
    const float delta = 6.0f / 29.0f;
    return t > delta * delta * delta ? cbrtf(t) : t / (3.0f * delta * delta) + 4.0f / 29.0f;
}

// CIELAB from XYZ over white, with a* and b* scaled by L*/100: the Hunt effect (section 4.1.2).
static vec3s hunt_lab(vec3s xyz)
{
    float x = lab_curve(xyz.x), y = lab_curve(xyz.y), z = lab_curve(xyz.z);
    float lightness = 116.0f * y - 16.0f, chroma = 0.01f * lightness;
    return vec3_of(lightness, chroma * 500.0f * (x - y), chroma * 200.0f * (y - z));
}

// HyAB (Abasi, Tehran & Fairchild 2020): city block between lightness and chroma, Euclidean in
// chroma.
static float hyab_power(vec3s p, vec3s q)
{
    float da = p.y - q.y, db = p.z - q.z;
    return powf(fabsf(p.x - q.x) + sqrtf(da * da + db * db), COLOUR_POWER);
}

// Green and blue have the largest distance in the unit cube.
static float largest_difference(void)
{
    return hyab_power(hunt_lab(xyz_from_rgb(vec3_of(0.0f, 1.0f, 0.0f))),
                      hunt_lab(xyz_from_rgb(vec3_of(0.0f, 0.0f, 1.0f))));
}

// ---- tone mapper of HDR-FLIP: (A x² + B x) / (C x² + D x + E), Narkowicz's fit for 0.6 x

static const double ACES_A = 0.36 * 2.51, ACES_B = 0.6 * 0.03;
static const double ACES_C = 0.36 * 2.43, ACES_D = 0.6 * 0.59, ACES_E = 0.14;

static float aces(float x)
{
    x = fminf(fmaxf(x, 0.0f), 1e6f); // saturated far below; keeps the square finite
    float above = (float)ACES_A * x * x + (float)ACES_B * x;
    float below = (float)ACES_C * x * x + (float)ACES_D * x + (float)ACES_E;
    return fminf(above / below, 1.0f);
}

// The x whose aces(x) is y.
static double aces_inverse(double y)
{
    double a = ACES_A - ACES_C * y, b = ACES_B - ACES_D * y, c = -ACES_E * y;
    return (-b + sqrt(b * b - 4.0 * a * c)) / (2.0 * a);
}

static vec3s display_value(const float *pixel, struct exposure exposure)
{
    if (!exposure.tone_mapped)
        return glms_vec3_clamp(vec3_of(pixel[0], pixel[1], pixel[2]), 0.0f, 1.0f);
    float s = exposure.scale;
    return vec3_of(aces(s * pixel[0]), aces(s * pixel[1]), aces(s * pixel[2]));
}

// ---- the passes: planes of image 1 follow those of image 0

static void read_row(const struct band *band, const struct image *image, int first_plane, int row,
                     int y)
{
    const struct job *job = band->user;
    float *planes[SOURCES];
    for (int i = 0; i < SOURCES; i++) planes[i] = band_source(band, first_plane + i, row);
    for (int x = 0; x < band->width; x++) {
        vec3s xyz = xyz_from_rgb(display_value(image_at(image, x, y), job->exposure));
        planes[LIGHTNESS][x] = xyz.y;
        planes[RED_GREEN][x] = xyz.x - xyz.y;
        planes[BLUE_YELLOW][x] = xyz.y - xyz.z;
    }
    for (int i = 0; i < SOURCES; i++) band_pad_source(band, first_plane + i, row);
}

static void first_pass(const struct band *band, int row, int y)
{
    static const int source_of[FLIP_FILTERS] = { LIGHTNESS, RED_GREEN, BLUE_YELLOW, BLUE_YELLOW,
                                                 LIGHTNESS, LIGHTNESS, LIGHTNESS };
    const struct job *job = band->user;
    for (int i = 0; i < 2; i++) {
        read_row(band, job->images[i], i * SOURCES, row, y);
        for (int f = 0; f < FLIP_FILTERS; f++)
            filter_apply(&job->filters.filter[f],
                         band_source(band, i * SOURCES + source_of[f], row), 1, band->width,
                         band_middle(band, i * FLIP_FILTERS + f, row));
    }
}

// A pixel after the filters.
struct filtered {
    vec3s colour;      // Hunt-adjusted CIELAB
    float edge, point; // feature magnitudes
};

enum column {
    COLUMN_LIGHTNESS,
    COLUMN_RED_GREEN,
    COLUMN_WIDE,
    COLUMN_NARROW,
    COLUMN_EDGE_X,
    COLUMN_EDGE_Y,
    COLUMN_POINT_X,
    COLUMN_POINT_Y,
    COLUMNS
};

static struct filtered filtered_pixel(float columns[COLUMNS][BLOCK], int i, float wide_share)
{
    float y = columns[COLUMN_LIGHTNESS][i], x = columns[COLUMN_RED_GREEN][i] + y;
    float z = y - (wide_share * columns[COLUMN_WIDE][i] +
                   (1.0f - wide_share) * columns[COLUMN_NARROW][i]);
    vec3s rgb = glms_vec3_clamp(rgb_from_xyz(vec3_of(x, y, z)), 0.0f, 1.0f);
    float edge_x = columns[COLUMN_EDGE_X][i], edge_y = columns[COLUMN_EDGE_Y][i];
    float point_x = columns[COLUMN_POINT_X][i], point_y = columns[COLUMN_POINT_Y][i];
    return (struct filtered){ .colour = hunt_lab(xyz_from_rgb(rgb)),
                              .edge = sqrtf(edge_x * edge_x + edge_y * edge_y),
                              .point = sqrtf(point_x * point_x + point_y * point_y) };
}

static void filter_block(const struct band *band, int image, int row, int x0, int count,
                         struct filtered out[BLOCK])
{
    // The horizontal filter (first pass) and the vertical filter applied to its result.
    static const struct {
        enum flip_filter across, along;
    } steps[COLUMNS] = {
        { FLIP_LIGHTNESS, FLIP_LIGHTNESS },
        { FLIP_RED_GREEN, FLIP_RED_GREEN },
        { FLIP_BLUE_YELLOW_WIDE, FLIP_BLUE_YELLOW_WIDE },
        { FLIP_BLUE_YELLOW_NARROW, FLIP_BLUE_YELLOW_NARROW },
        { FLIP_SLOPE, FLIP_SMOOTH },
        { FLIP_SMOOTH, FLIP_SLOPE },
        { FLIP_CURVATURE, FLIP_SMOOTH },
        { FLIP_SMOOTH, FLIP_CURVATURE },
    };
    const struct job *job = band->user;
    float columns[COLUMNS][BLOCK];
    for (int c = 0; c < COLUMNS; c++) {
        const float *in = band_middle(band, image * FLIP_FILTERS + (int)steps[c].across, row) + x0;
        filter_apply(&job->filters.filter[steps[c].along], in, (size_t)band->width, count,
                     columns[c]);
    }
    for (int i = 0; i < count; i++) out[i] = filtered_pixel(columns, i, job->filters.wide_share);
}

// Redistribution: small colour differences take most of the range 0…1 (section 4.1.3).
static float colour_error(vec3s p, vec3s q, float largest)
{
    float power = hyab_power(p, q), knee = KNEE_IN * largest;
    if (power < knee) return KNEE_OUT * power / knee;
    return fminf(KNEE_OUT + (1.0f - KNEE_OUT) * (power - knee) / (largest - knee), 1.0f);
}

static float feature_error(const struct filtered *p, const struct filtered *q)
{
    float largest = fmaxf(fabsf(p->edge - q->edge), fabsf(p->point - q->point));
    return fminf(sqrtf(largest * 0.70710678f), 1.0f); // q_f = 0.5
}

static void second_pass(const struct band *band, int row, int y)
{
    const struct job *job = band->user;
    for (int x0 = 0; x0 < band->width; x0 += BLOCK) {
        struct filtered filtered[2][BLOCK];
        int count = band->width - x0 < BLOCK ? band->width - x0 : BLOCK;
        for (int i = 0; i < 2; i++) filter_block(band, i, row, x0, count, filtered[i]);
        for (int i = 0; i < count; i++) {
            const struct filtered *p = &filtered[0][i], *q = &filtered[1][i];
            float colour = colour_error(p->colour, q->colour, job->largest_difference);
            float error = colour > 0.0f ? powf(colour, 1.0f - feature_error(p, q)) : 0.0f;
            float *out = image_at(job->out, x0 + i, y);
            *out = fmaxf(*out, error); // maximum over exposures
        }
    }
}

static bool begin(struct host *host, const struct image *a, const struct image *b,
                  float pixels_per_degree, struct image *out, struct job *job)
{
    *out = (struct image){ 0 };
    if (!(pixels_per_degree >= FLIP_PIXELS_PER_DEGREE_MIN &&
          pixels_per_degree <= FLIP_PIXELS_PER_DEGREE_MAX))
        return host_fail(host, FAIL_ARGUMENT,
                         "cannot compute FLIP: %g pixels per degree are not %g to %g",
                         (double)pixels_per_degree, (double)FLIP_PIXELS_PER_DEGREE_MIN,
                         (double)FLIP_PIXELS_PER_DEGREE_MAX);
    if (!image_init(out, host, a->width, a->height, 1)) return false;
    *job =
        (struct job){ .images = { a, b }, .out = out, .largest_difference = largest_difference() };
    flip_filters_make(pixels_per_degree, &job->filters);
    return true;
}

static bool run(struct host *host, struct job *job)
{
    struct band band = { .width = job->out->width,
                         .height = job->out->height,
                         .pad = job->filters.radius,
                         .source_count = 2 * SOURCES,
                         .middle_count = 2 * FLIP_FILTERS,
                         .user = job,
                         .first_pass = first_pass,
                         .second_pass = second_pass };
    return band_run(&band, host);
}

bool flip_map(struct host *host, const struct image *a, const struct image *b,
              float pixels_per_degree, struct image *out)
{
    struct job job;
    if (!begin(host, a, b, pixels_per_degree, out, &job)) return false;
    if (run(host, &job)) return true;
    image_finish(out, host);
    return false;
}

// ---- exposures

static int ascending(const void *a, const void *b)
{
    float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

static float luminance_of(const float *pixel)
{
    return luminance(vec3_of(fmaxf(pixel[0], 0.0f), fmaxf(pixel[1], 0.0f), fmaxf(pixel[2], 0.0f)));
}

// The median; of the non-black pixels where most are black, since log 0 gives no exposure.
static double median_of(const float *sorted, size_t count)
{
    double median = 0.5 * ((double)sorted[(count - 1) / 2] + (double)sorted[count / 2]);
    if (median > 0.0) return median;
    size_t black = 0;
    while (black < count && sorted[black] <= 0.0f) black++;
    if (black == count) return 0.0;
    size_t lit = count - black;
    return 0.5 * ((double)sorted[black + (lit - 1) / 2] + (double)sorted[black + lit / 2]);
}

bool flip_exposures_of(struct host *host, const struct image *reference,
                       const unsigned char *counts, struct flip_exposures *out)
{
    enum { MAX_STOPS = 24 }; // the range from candlelight to the sun's disk; bounds dark medians
    *out = (struct flip_exposures){ 0.0, 0.0, 1 };
    size_t pixels = (size_t)reference->width * (size_t)reference->height, count = 0;
    float *sorted = host_alloc(host, pixels, sizeof *sorted);
    if (!sorted) return false;
    for (size_t i = 0; i < pixels; i++)
        if (!counts || counts[i])
            sorted[count++] =
                fminf(luminance_of(reference->pixels + i * (size_t)reference->channels), 3e38f);
    qsort(sorted, count, sizeof *sorted, ascending);
    double brightest = count ? (double)sorted[count - 1] : 0.0;
    if (brightest > 0.0) {
        double x = aces_inverse((double)BRIGHT);
        out->start = log2(x / brightest);
        out->stop = fmin(log2(x / median_of(sorted, count)), out->start + MAX_STOPS);
        if (out->stop > out->start) out->count = (int)fmax(2.0, ceil(out->stop - out->start));
    }
    host_free(host, sorted);
    return true;
}

bool flip_map_hdr(struct host *host, const struct image *a, const struct image *b,
                  const struct flip_exposures *exposures, float pixels_per_degree,
                  struct image *out)
{
    struct job job;
    if (!begin(host, a, b, pixels_per_degree, out, &job)) return false;
    double step =
        exposures->count > 1 ? (exposures->stop - exposures->start) / (exposures->count - 1) : 0.0;
    for (int i = 0; i < exposures->count; i++) {
        double stops = fmin(fmax(exposures->start + step * i, -126.0), 126.0);
        job.exposure = (struct exposure){ .tone_mapped = true, .scale = (float)exp2(stops) };
        if (!run(host, &job)) goto fail;
    }
    return true;
fail:
    image_finish(out, host);
    return false;
}
