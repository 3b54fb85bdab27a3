#include "test_images.h"

#include "image/flip.h"

#include <math.h>
#include <omp.h>
#include <string.h>

static const float PPD = FLIP_PIXELS_PER_DEGREE;

static void map_of(const struct image *a, const struct image *b, float ppd, struct image *map)
{
    CHECK(flip_map(test_host(), a, b, ppd, map));
    CHECK(map->width == a->width && map->height == a->height && map->channels == 1);
}

static double mean_of(const struct image *map)
{
    double sum = 0.0;
    size_t pixels = (size_t)map->width * (size_t)map->height;
    for (size_t i = 0; i < pixels; i++) sum += (double)map->pixels[i];
    return sum / (double)pixels;
}

static double mean_flip(const struct image *a, const struct image *b, float ppd)
{
    struct image map;
    map_of(a, b, ppd, &map);
    double mean = mean_of(&map);
    image_finish(&map, test_host());
    return mean;
}

static void finish_all(struct image *const images[], int count)
{
    for (int i = 0; i < count; i++) image_finish(images[i], test_host());
}
#define FINISH(...)                                                                                \
    finish_all((struct image *const[]){ __VA_ARGS__ },                                             \
               (int)(sizeof(struct image *[]){ __VA_ARGS__ } / sizeof(struct image *)))

static void fill_rgb(struct image *image, const double rgb[3])
{
    for (size_t i = 0; i < (size_t)image->width * (size_t)image->height; i++)
        for (size_t c = 0; c < 3; c++) image->pixels[3 * i + c] = (float)rgb[c];
}

// ---- twin of FLIP in double, straight from the papers: two-dimensional convolutions, XYZ from the
// chromaticities of Rec. 709

struct twin {
    double xyz_from_rgb[3][3], rgb_from_xyz[3][3], white[3], largest;
};

static void invert(double m[3][3], double out[3][3])
{
    double det = 0.0;
    for (int i = 0; i < 3; i++)
        det += m[0][i] *
               (m[1][(i + 1) % 3] * m[2][(i + 2) % 3] - m[1][(i + 2) % 3] * m[2][(i + 1) % 3]);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            out[j][i] = (m[(i + 1) % 3][(j + 1) % 3] * m[(i + 2) % 3][(j + 2) % 3] -
                         m[(i + 1) % 3][(j + 2) % 3] * m[(i + 2) % 3][(j + 1) % 3]) /
                        det;
}

static void multiply(double m[3][3], const double v[3], double out[3])
{
    for (int i = 0; i < 3; i++) out[i] = m[i][0] * v[0] + m[i][1] * v[1] + m[i][2] * v[2];
}

static double lab_f(double t)
{
    return t > 216.0 / 24389.0 ? cbrt(t) : (24389.0 / 27.0 * t + 16.0) / 116.0;
}

static void hunt(struct twin *t, const double rgb[3], double out[3])
{
    double xyz[3], f[3];
    multiply(t->xyz_from_rgb, rgb, xyz);
    for (int i = 0; i < 3; i++) f[i] = lab_f(xyz[i] / t->white[i]);
    out[0] = 116 * f[1] - 16;
    out[1] = 0.01 * out[0] * 500 * (f[0] - f[1]);
    out[2] = 0.01 * out[0] * 200 * (f[1] - f[2]);
}

static double hyab(const double p[3], const double q[3])
{
    return fabs(p[0] - q[0]) + hypot(p[1] - q[1], p[2] - q[2]);
}

static struct twin make_twin(void)
{
    const double xy[3][2] = { { 0.64, 0.33 }, { 0.30, 0.60 }, { 0.15, 0.06 } };
    struct twin t = { .white = { 0.3127 / 0.3290, 1.0, (1 - 0.3127 - 0.3290) / 0.3290 } };
    double primaries[3][3], inverse[3][3], scale[3], green[3], blue[3];
    for (int c = 0; c < 3; c++) {
        primaries[0][c] = xy[c][0] / xy[c][1];
        primaries[1][c] = 1.0;
        primaries[2][c] = (1 - xy[c][0] - xy[c][1]) / xy[c][1];
    }
    invert(primaries, inverse);
    multiply(inverse, t.white, scale);
    for (int i = 0; i < 3; i++)
        for (int c = 0; c < 3; c++) t.xyz_from_rgb[i][c] = primaries[i][c] * scale[c];
    invert(t.xyz_from_rgb, t.rgb_from_xyz);
    hunt(&t, (double[]){ 0, 1, 0 }, green);
    hunt(&t, (double[]){ 0, 0, 1 }, blue);
    t.largest = pow(hyab(green, blue), 0.7);
    return t;
}

static double redistribute(const struct twin *t, double distance)
{
    double power = pow(distance, 0.7), knee = 0.4 * t->largest;
    return power < knee ? 0.95 / knee * power : 0.95 + 0.05 * (power - knee) / (t->largest - knee);
}

// Y, Cx and Cz of a pixel, clamped to the border.
static void opponent(struct twin *t, const struct image *image, int x, int y, double out[3])
{
    x = x < 0 ? 0 : x >= image->width ? image->width - 1 : x;
    y = y < 0 ? 0 : y >= image->height ? image->height - 1 : y;
    const float *p = image_at(image, x, y);
    double xyz[3];
    multiply(t->xyz_from_rgb, (double[]){ (double)p[0], (double)p[1], (double)p[2] }, xyz);
    for (int i = 0; i < 3; i++) xyz[i] /= t->white[i];
    out[0] = 116 * xyz[1] - 16;
    out[1] = 500 * (xyz[0] - xyz[1]);
    out[2] = 200 * (xyz[1] - xyz[2]);
}

static double sensitivity(int channel, double squared_deg)
{
    static const double a1[] = { 1, 1, 34.1 }, b1[] = { 0.0047, 0.0053, 0.04 };
    static const double a2[] = { 0, 0, 13.5 }, b2[] = { 1e-5, 1e-5, 0.025 };
    const double pi = acos(-1.0);
    return a1[channel] * sqrt(pi / b1[channel]) * exp(-pi * pi * squared_deg / b1[channel]) +
           a2[channel] * sqrt(pi / b2[channel]) * exp(-pi * pi * squared_deg / b2[channel]);
}

static void twin_colour(struct twin *t, const struct image *image, int x, int y, double ppd,
                        double out[3])
{
    int radius = (int)ceil(3 * sqrt(0.04 / (2 * acos(-1.0) * acos(-1.0))) * ppd);
    double sum[3] = { 0 }, weight[3] = { 0 }, xyz[3], rgb[3];
    for (int v = -radius; v <= radius; v++)
        for (int u = -radius; u <= radius; u++) {
            double values[3];
            opponent(t, image, x + u, y + v, values);
            for (int c = 0; c < 3; c++) {
                double w = sensitivity(c, (u * u + v * v) / (ppd * ppd));
                sum[c] += w * values[c], weight[c] += w;
            }
        }
    for (int c = 0; c < 3; c++) sum[c] /= weight[c];
    double yn = (sum[0] + 16) / 116;
    xyz[0] = (yn + sum[1] / 500) * t->white[0];
    xyz[1] = yn * t->white[1];
    xyz[2] = (yn - sum[2] / 200) * t->white[2];
    multiply(t->rgb_from_xyz, xyz, rgb);
    for (int c = 0; c < 3; c++) rgb[c] = fmin(fmax(rgb[c], 0), 1);
    hunt(t, rgb, out);
}

// The magnitude of the edge (order 1) or point (order 2) filter's response.
static double twin_feature(struct twin *t, const struct image *image, int x, int y, double ppd,
                           int order)
{
    double sigma = 0.5 * 0.082 * ppd, answer[2] = { 0 }, above = 0, below = 0;
    int radius = (int)ceil(3 * sigma);
    for (int pass = 0; pass < 2; pass++)
        for (int v = -radius; v <= radius; v++)
            for (int u = -radius; u <= radius; u++) {
                double g = exp(-(u * u + v * v) / (2 * sigma * sigma)), values[3];
                double wx = (order == 1 ? -u : u * u / (sigma * sigma) - 1) * g;
                double wy = (order == 1 ? -v : v * v / (sigma * sigma) - 1) * g;
                if (pass == 0) {
                    *(wx > 0 ? &above : &below) += fabs(wx);
                    continue;
                }
                opponent(t, image, x + u, y + v, values);
                answer[0] += wx / (wx > 0 ? above : below) * (values[0] + 16) / 116;
                answer[1] += wy / (wy > 0 ? above : below) * (values[0] + 16) / 116;
            }
    return hypot(answer[0], answer[1]);
}

static double twin_flip(struct twin *t, const struct image *a, const struct image *b, int x, int y,
                        double ppd)
{
    double p[3], q[3];
    twin_colour(t, a, x, y, ppd, p);
    twin_colour(t, b, x, y, ppd, q);
    double edge = twin_feature(t, a, x, y, ppd, 1) - twin_feature(t, b, x, y, ppd, 1);
    double point = twin_feature(t, a, x, y, ppd, 2) - twin_feature(t, b, x, y, ppd, 2);
    double feature = sqrt(fmax(fabs(edge), fabs(point)) / sqrt(2.0));
    return pow(redistribute(t, hyab(p, q)), 1 - feature);
}

TEST(every_pixel_equals_the_twin_with_two_dimensional_filters)
{
    const struct {
        int width, height;
        float ppd;
    } cases[] = { { 21, 17, 67.0206433f }, { 2, 2, 67.0206433f }, { 1, 1, 67.0206433f },
                  { 23, 9, 20.0f },        { 9, 8, 1.0f },        { 140, 2, 12.0f },
                  { 2, 131, 12.0f } };
    struct twin t = make_twin();
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        struct image a, b, map;
        display_image(&a, cases[i].width, cases[i].height, 3, 1);
        display_image(&b, cases[i].width, cases[i].height, 4, 2);
        map_of(&a, &b, cases[i].ppd, &map);
        for (int y = 0; y < map.height; y++)
            for (int x = 0; x < map.width; x++)
                CHECK_NEAR((double)*image_at(&map, x, y),
                           twin_flip(&t, &a, &b, x, y, (double)cases[i].ppd), 2e-3);
        FINISH(&a, &b, &map);
    }
}

TEST(flat_colours_differ_by_their_hyab_distance_alone)
{
    const double colours[][3] = { { 0, 0, 0 },   { 1, 1, 1 },         { 0.2, 0.2, 0.2 },
                                  { 0, 1, 0 },   { 0, 0, 1 },         { 1, 0, 0 },
                                  { 0.5, 0, 1 }, { 0.02, 0.04, 0.9 }, { 0.21, 0.2, 0.2 } };
    struct twin t = make_twin();
    for (size_t i = 0; i < 9; i++)
        for (size_t j = 0; j < i; j++) {
            struct image a, b;
            double p[3], q[3];
            flat_image(&a, 5, 4, 3, 0.0f);
            flat_image(&b, 5, 4, 3, 0.0f);
            fill_rgb(&a, colours[i]);
            fill_rgb(&b, colours[j]);
            hunt(&t, colours[i], p);
            hunt(&t, colours[j], q);
            CHECK_NEAR(mean_flip(&a, &b, PPD), redistribute(&t, hyab(p, q)), 1e-3);
            FINISH(&a, &b);
        }
}

TEST(green_and_blue_have_the_largest_difference)
{
    struct image a, b;
    flat_image(&a, 3, 3, 3, 0.0f);
    flat_image(&b, 3, 3, 3, 0.0f);
    fill_rgb(&a, (const double[]){ 0, 1, 0 });
    fill_rgb(&b, (const double[]){ 0, 0, 1 });
    CHECK_NEAR(mean_flip(&a, &b, PPD), 1.0, 1e-6);
    FINISH(&a, &b);
}

TEST(equal_images_have_a_difference_of_exactly_zero)
{
    struct image a;
    display_image(&a, 150, 140, 3, 3);
    CHECK(mean_flip(&a, &a, PPD) == 0.0);
    FINISH(&a);
}

TEST(the_difference_is_symmetric_and_between_0_and_1)
{
    struct image a, b, ab, ba;
    noise_image(&a, 40, 30, 3); // far outside the display range
    display_image(&b, 40, 30, 3, 4);
    map_of(&a, &b, PPD, &ab);
    map_of(&b, &a, PPD, &ba);
    CHECK(memcmp(ab.pixels, ba.pixels, 40 * 30 * sizeof(float)) == 0);
    for (int i = 0; i < 40 * 30; i++) CHECK(ab.pixels[i] > 0.0f && ab.pixels[i] <= 1.0f);
    FINISH(&a, &b, &ab, &ba);
}

static void transpose(const struct image *in, struct image *out)
{
    CHECK(image_init(out, test_host(), in->height, in->width, in->channels));
    for (int y = 0; y < in->height; y++)
        for (int x = 0; x < in->width; x++)
            memcpy(image_at(out, y, x), image_at(in, x, y), (size_t)in->channels * sizeof(float));
}

static void mirror(const struct image *in, struct image *out)
{
    CHECK(image_init(out, test_host(), in->width, in->height, in->channels));
    for (int y = 0; y < in->height; y++)
        for (int x = 0; x < in->width; x++)
            memcpy(image_at(out, in->width - 1 - x, y), image_at(in, x, y),
                   (size_t)in->channels * sizeof(float));
}

TEST(a_mirrored_or_transposed_pair_has_the_map_mirrored_or_transposed)
{
    struct image a, b, map, expected, a2, b2, map2;
    display_image(&a, 300, 31, 3, 1); // several blocks; transposed, several bands
    display_image(&b, 300, 31, 3, 2);
    map_of(&a, &b, PPD, &map);
    for (int kind = 0; kind < 2; kind++) {
        void (*transform)(const struct image *, struct image *) = kind ? mirror : transpose;
        transform(&a, &a2);
        transform(&b, &b2);
        transform(&map, &expected);
        map_of(&a2, &b2, PPD, &map2);
        for (int i = 0; i < 300 * 31; i++)
            CHECK_NEAR((double)map2.pixels[i], (double)expected.pixels[i], 1e-3);
        FINISH(&a2, &b2, &map2, &expected);
    }
    FINISH(&a, &b, &map);
}

TEST(stronger_noise_is_a_larger_difference)
{
    struct image a, noise;
    display_image(&a, 48, 32, 3, 1);
    double last = 0.0;
    for (int step = 1; step <= 5; step++) {
        display_image(&noise, 48, 32, 3, 9);
        blend(&noise, &a, 1.0f - 0.2f * (float)step);
        double now = mean_flip(&noise, &a, PPD);
        CHECK(now > last + 0.005);
        last = now;
        FINISH(&noise);
    }
    FINISH(&a);
}

// Stripes of 8 pixels, shifted right by `shift` pixels and box-blurred with radius `blur`.
static void stripes(struct image *out, int shift, int blur)
{
    flat_image(out, 64, 24, 3, 0.0f);
    for (int i = 0; i < 64 * 24; i++)
        for (int k = -blur; k <= blur; k++)
            for (int c = 0; c < 3; c++)
                out->pixels[3 * i + c] +=
                    (i % 64 - shift + k + 64) / 8 % 2 ? 1.0f / (float)(2 * blur + 1) : 0.0f;
}

TEST(a_stronger_blur_is_a_larger_difference)
{
    struct image sharp, blurred;
    stripes(&sharp, 0, 0);
    double last = 0.0;
    for (int blur = 1; blur <= 3; blur++) {
        stripes(&blurred, 0, blur);
        double now = mean_flip(&blurred, &sharp, PPD);
        CHECK(now > last + 0.005);
        last = now;
        FINISH(&blurred);
    }
    FINISH(&sharp);
}

TEST(a_larger_shift_is_a_larger_difference_and_no_shift_is_none)
{
    struct image still, moved;
    stripes(&still, 0, 0);
    double last = -0.1;
    for (int shift = 0; shift <= 4; shift++) {
        stripes(&moved, shift, 0);
        double now = mean_flip(&moved, &still, PPD);
        CHECK(shift > 0 || now == 0.0);
        CHECK(now > last + 0.02);
        last = now;
        FINISH(&moved);
    }
    FINISH(&still);
}

TEST(a_fine_pattern_disappears_with_distance_and_a_flat_difference_does_not)
{
    struct image pattern, mean, other, map;
    flat_image(&pattern, 65, 65, 3, 0.0f);
    flat_image(&mean, 65, 65, 3, 0.5f);
    flat_image(&other, 65, 65, 3, 0.6f);
    for (int i = 0; i < 65 * 65 * 3; i++)
        pattern.pixels[i] = (i / 3 % 65 + i / 195) % 2 ? 0.8f : 0.2f;
    const float ppd[] = { 10.0f, 25.0f, 40.0f, 100.0f };
    double last = 2.0;
    for (int i = 0; i < 4; i++) {
        map_of(&pattern, &mean, ppd[i], &map);
        double now = (double)*image_at(&map, 32, 32); // away from the repeated border
        CHECK(now < 0.8 * last);
        last = now;
        FINISH(&map);
    }
    CHECK(last < 0.005);
    CHECK_NEAR(mean_flip(&other, &mean, 10.0f), mean_flip(&other, &mean, 300.0f), 1e-4);
    FINISH(&pattern, &mean, &other);
}

// The difference at the centre of a white square of 2·radius + 1 pixels on a grey field.
static double middle_of_square(int radius, float ppd)
{
    struct image a, b, map;
    flat_image(&a, 61, 61, 3, 0.2f);
    flat_image(&b, 61, 61, 3, 0.2f);
    for (int y = 30 - radius; y <= 30 + radius; y++)
        for (int x = 30 - radius; x <= 30 + radius; x++)
            for (int c = 0; c < 3; c++) image_at(&a, x, y)[c] = 1.0f;
    map_of(&a, &b, ppd, &map);
    double value = (double)*image_at(&map, 30, 30);
    CHECK(*image_at(&map, 0, 0) == 0.0f); // outside the filters' support
    FINISH(&a, &b, &map);
    return value;
}

TEST(a_dot_differs_less_than_a_patch_and_less_from_farther_away)
{
    double dot = middle_of_square(0, PPD), patch = middle_of_square(15, PPD);
    CHECK(dot > 0.1 && patch > dot + 0.1);
    CHECK(middle_of_square(0, 30.0f) > dot && dot > middle_of_square(0, 120.0f));
}

TEST(an_image_of_one_pixel_equals_a_flat_field_of_its_colour)
{
    struct image one, field, black, dark;
    flat_image(&one, 1, 1, 3, 0.7f);
    flat_image(&black, 1, 1, 3, 0.1f);
    flat_image(&field, 20, 20, 3, 0.7f);
    flat_image(&dark, 20, 20, 3, 0.1f);
    CHECK_NEAR(mean_flip(&one, &black, PPD), mean_flip(&field, &dark, PPD), 1e-5);
    FINISH(&one, &black, &field, &dark);
}

TEST(pixels_per_degree_out_of_range_are_refused)
{
    const float wrong[] = { 0.0f, -67.0f, 0.5f, 2000.0f, NAN, INFINITY };
    struct image a, map;
    flat_image(&a, 2, 2, 3, 0.5f);
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
        CHECK(!flip_map(test_host(), &a, &a, wrong[i], &map) && !map.pixels);
        CHECK(test_host()->failure == FAIL_ARGUMENT);
    }
    FINISH(&a);
}

TEST(the_map_does_not_depend_on_the_number_of_threads)
{
    struct image a, b, first, again;
    display_image(&a, 200, 150, 3, 1);
    display_image(&b, 200, 150, 3, 2);
    omp_set_num_threads(1);
    map_of(&a, &b, PPD, &first);
    for (int i = 0; i < 3; i++) {
        omp_set_num_threads(2 + i);
        map_of(&a, &b, PPD, &again);
        CHECK(memcmp(first.pixels, again.pixels, 200 * 150 * sizeof(float)) == 0);
        FINISH(&again);
    }
    FINISH(&a, &b, &first);
}

// ---- HDR-FLIP

// The value that the ACES fit maps to 0.85, by bisection of the published formula.
static double aces_inverse_85(void)
{
    double low = 0, high = 100;
    for (int i = 0; i < 100; i++) {
        double x = 0.5 * (low + high), y = 0.6 * x;
        double value = y * (2.51 * y + 0.03) / (y * (2.43 * y + 0.59) + 0.14);
        *(value < 0.85 ? &low : &high) = x;
    }
    return low;
}

TEST(exposures_go_from_the_brightest_pixel_to_the_median)
{
    struct image image;
    struct flip_exposures e;
    double x = aces_inverse_85();
    // The authors' published example: −12.5423 to 0.9427 in 14 exposures.
    flat_image(&image, 11, 1, 3, (float)(x / exp2(0.9427)));
    for (int c = 0; c < 3; c++) {
        image_at(&image, 3, 0)[c] = (float)(x / exp2(-12.5423));
        image_at(&image, 4, 0)[c] = -5.0f; // counts as black
    }
    CHECK(flip_exposures_of(test_host(), &image, NULL, &e));
    CHECK_NEAR(e.start, -12.5423, 1e-4);
    CHECK_NEAR(e.stop, 0.9427, 1e-4);
    assert_int_equal(e.count, 14);
    // With a mask.
    unsigned char counts[11] = { [0] = 1, [1] = 1 };
    CHECK(flip_exposures_of(test_host(), &image, counts, &e));
    CHECK(e.count == 1 && e.start == e.stop);
    CHECK_NEAR(e.start, 0.9427, 1e-4);
    FINISH(&image);
}

TEST(mostly_black_images_are_exposed_for_their_lit_pixels)
{
    struct image image;
    struct flip_exposures e;
    flat_image(&image, 10, 1, 3, 0.0f);
    CHECK(flip_exposures_of(test_host(), &image, NULL, &e) && e.count == 1);
    for (int c = 0; c < 3; c++)
        image_at(&image, 2, 0)[c] = 1.0f, image_at(&image, 5, 0)[c] = 1.0f,
                            image_at(&image, 7, 0)[c] = 64.0f;
    CHECK(flip_exposures_of(test_host(), &image, NULL, &e));
    CHECK_NEAR(e.stop - e.start, 6.0, 1e-4);
    assert_int_equal(e.count, 6);
    image_at(&image, 7, 0)[1] = 3e38f; // and the range is bounded
    CHECK(flip_exposures_of(test_host(), &image, NULL, &e));
    assert_int_equal(e.count, 24);
    FINISH(&image);
}

static void hdr_map_of(const struct image *a, const struct image *b, struct flip_exposures *e,
                       struct image *map)
{
    CHECK(flip_exposures_of(test_host(), b, NULL, e));
    CHECK(flip_map_hdr(test_host(), a, b, e, PPD, map));
}

// Five stops brighter on the right.
static void sun_and_shade(struct image *out, int seed)
{
    display_image(out, 64, 20, 3, seed);
    for (int i = 0; i < 64 * 20 * 3; i++) out->pixels[i] *= i / 3 % 64 < 32 ? 3.0f : 96.0f;
}

TEST(the_hdr_difference_is_the_largest_over_its_exposures)
{
    struct image a, b, map, one, largest;
    struct flip_exposures e;
    sun_and_shade(&a, 1);
    sun_and_shade(&b, 2);
    hdr_map_of(&a, &b, &e, &map);
    CHECK(e.count > 3);
    flat_image(&largest, 64, 20, 1, 0.0f);
    for (int i = 0; i < e.count; i++) {
        double stops = e.start + (e.stop - e.start) / (e.count - 1) * i;
        struct flip_exposures single = { stops, stops, 1 };
        CHECK(flip_map_hdr(test_host(), &a, &b, &single, PPD, &one));
        for (int k = 0; k < 64 * 20; k++)
            largest.pixels[k] = fmaxf(largest.pixels[k], one.pixels[k]);
        FINISH(&one);
    }
    CHECK(memcmp(map.pixels, largest.pixels, 64 * 20 * sizeof(float)) == 0);
    FINISH(&a, &b, &map, &largest);
}

TEST(the_hdr_difference_does_not_depend_on_the_unit_of_radiance)
{
    struct image a, b, map, scaled;
    struct flip_exposures e;
    sun_and_shade(&a, 1);
    sun_and_shade(&b, 2);
    hdr_map_of(&a, &b, &e, &map);
    for (int i = 0; i < 64 * 20 * 3; i++) a.pixels[i] *= 1000.0f, b.pixels[i] *= 1000.0f;
    hdr_map_of(&a, &b, &e, &scaled);
    for (int i = 0; i < 64 * 20; i++)
        CHECK_NEAR((double)map.pixels[i], (double)scaled.pixels[i], 2e-3);
    FINISH(&a, &b, &map, &scaled);
}

TEST(equal_radiance_has_no_difference_even_when_black)
{
    struct image a, map;
    struct flip_exposures e;
    sun_and_shade(&a, 1);
    hdr_map_of(&a, &a, &e, &map);
    CHECK(mean_of(&map) == 0.0);
    FINISH(&a, &map);
    flat_image(&a, 4, 4, 3, 0.0f);
    hdr_map_of(&a, &a, &e, &map);
    CHECK(mean_of(&map) == 0.0);
    FINISH(&a, &map);
}

TEST(differences_in_shadow_and_in_sunlight_are_both_detected)
{
    for (int side = 0; side < 2; side++) {
        struct image a, b, map, bright;
        struct flip_exposures e;
        flat_image(&b, 64, 20, 3, 0.0f);
        for (int i = 0; i < 64 * 20 * 3; i++) b.pixels[i] = i / 3 % 64 < 36 ? 1.0f : 4000.0f;
        flat_image(&a, 64, 20, 3, 0.0f);
        for (int i = 0; i < 64 * 20 * 3; i++)
            a.pixels[i] = b.pixels[i] * ((i / 3 % 64 < 36) == (side == 0) ? 0.5f : 1.0f);
        hdr_map_of(&a, &b, &e, &map);
        CHECK(*image_at(&map, side ? 60 : 4, 10) > 0.2f);
        CHECK(*image_at(&map, side ? 4 : 60, 10) < 0.01f);
        struct flip_exposures first = { e.start, e.start, 1 };
        CHECK(flip_map_hdr(test_host(), &a, &b, &first, PPD, &bright));
        if (side == 0) CHECK(*image_at(&bright, 4, 10) < 0.1f); // one exposure is not enough
        FINISH(&a, &b, &map, &bright);
    }
}
