#include "test_images.h"

#include "image/tonemap.h"

#include <math.h>
#include <string.h>

static const float START = 0.76f; // where compression starts, after the offset

static float max3(vec3s v)
{
    return fmaxf(v.x, fmaxf(v.y, v.z));
}

static vec3s grey(float v)
{
    return vec3_of(v, v, v);
}

TEST(exposure_halves_with_each_stop)
{
    CHECK_RELATIVE((double)exposure_scale(0.0f), 1 / 1.2, 1e-6);
    for (int ev = -20; ev <= 20; ev++)
        CHECK_RELATIVE((double)exposure_scale((float)ev + 1.0f),
                       0.5 * (double)exposure_scale((float)ev), 1e-6);
    // A sensor saturates at 1.2 · 2^EV cd/m².
    CHECK_RELATIVE((double)(exposure_scale(10.0f) * 1.2f * 1024.0f), 1.0, 1e-6);
}

TEST(below_the_compression_only_the_fresnel_offset_is_subtracted)
{
    for (int i = 0; i < 500; i++) {
        float r = 0.08f + 0.0014f * (float)((i * 37) % 500), g = 0.08f + 0.0014f * (float)i,
              b = 0.08f + 0.0014f * (float)((i * 91) % 500);
        vec3s out = tonemap_pbr_neutral(vec3_of(r, g, b));
        if (fmaxf(r, fmaxf(g, b)) - 0.04f >= START) continue;
        CHECK_NEAR((double)out.x, (double)r - 0.04, 1e-6);
        CHECK_NEAR((double)out.y, (double)g - 0.04, 1e-6);
        CHECK_NEAR((double)out.z, (double)b - 0.04, 1e-6);
    }
}

TEST(the_toe_maps_black_to_black_and_joins_smoothly)
{
    CHECK(tonemap_pbr_neutral(grey(0.0f)).x == 0.0f);
    for (int i = 1; i < 80; i++) {
        double x = 0.001 * i;
        CHECK_NEAR((double)tonemap_pbr_neutral(grey((float)x)).y, 6.25 * x * x, 1e-6);
    }
    // Value and slope on both sides of 0.08.
    double h = 1e-3;
    double left = (0.04 - (double)tonemap_pbr_neutral(grey(0.08f - (float)h)).x) / h;
    double right = ((double)tonemap_pbr_neutral(grey(0.08f + (float)h)).x - 0.04) / h;
    CHECK_NEAR(left, right, 0.01);
}

TEST(differences_between_channels_are_kept_where_nothing_is_compressed)
{
    // Hue: r − g and g − b, and so their ratio, are kept in the toe too.
    for (int i = 0; i < 100; i++) {
        vec3s in = vec3_of(0.3f, 0.001f * (float)i, 0.1f + 0.003f * (float)i);
        vec3s out = tonemap_pbr_neutral(in);
        CHECK_NEAR((double)(out.x - out.y), (double)(in.x - in.y), 1e-6);
        CHECK_NEAR((double)(out.z - out.y), (double)(in.z - in.y), 1e-6);
    }
}

TEST(the_peak_increases_monotonically_with_radiance)
{
    static const float tints[][3] = {
        { 1, 1, 1 }, { 1, 0, 0 }, { 0, 1, 0.2f }, { 0.1f, 0.3f, 1 }, { 1, 0.9f, 0.05f },
    };
    for (size_t t = 0; t < sizeof tints / sizeof tints[0]; t++) {
        vec3s tint = vec3_of(tints[t][0], tints[t][1], tints[t][2]);
        float before = -1.0f;
        for (int i = -200; i <= 300; i++) {
            vec3s out = tonemap_pbr_neutral(glms_vec3_scale(tint, exp2f((float)i / 20.0f)));
            CHECK(max3(out) >= before - 1e-6f);
            before = max3(out);
        }
    }
}

TEST(white_is_approached_and_never_exceeded)
{
    for (int i = 0; i <= 60; i++) {
        float v = exp2f((float)i / 4.0f);
        float out = tonemap_pbr_neutral(grey(v)).x;
        CHECK(out < 1.0f);
        // 1 − 0.24² / (peak + 0.24 − 0.76), peak = v − 0.04
        CHECK_NEAR((double)out, 1.0 - 0.0576 / ((double)v - 0.56), 1e-5);
    }
    CHECK(tonemap_pbr_neutral(grey(1e6f)).x > 0.99f);
    CHECK(tonemap_pbr_neutral(vec3_of(INFINITY, 1.0f, 0.0f)).x <= 1.0f);
}

TEST(brighter_colours_lose_more_saturation)
{
    float before = 1.0f;
    for (int i = 0; i < 12; i++) {
        vec3s out = tonemap_pbr_neutral(vec3_of(exp2f((float)i), 0.0f, 0.0f));
        float saturation = 1.0f - out.y / out.x;
        CHECK(saturation < before && saturation > 0.0f);
        CHECK(out.y == out.z);
        before = saturation;
    }
    CHECK(before < 0.01f);
}

TEST(compression_is_continuous_in_value_and_slope)
{
    double at = 0.8, h = 1e-3;
    double a = (double)tonemap_pbr_neutral(grey((float)(at - h))).x,
           b = (double)tonemap_pbr_neutral(grey((float)at)).x,
           c = (double)tonemap_pbr_neutral(grey((float)(at + h))).x;
    CHECK_NEAR(b, 0.76, 1e-6);
    CHECK_NEAR((b - a) / h, 1.0, 0.01);
    CHECK_NEAR((c - b) / h, 1.0, 0.01);
}

TEST(negative_values_and_nan_count_as_black)
{
    vec3s out = tonemap_pbr_neutral(vec3_of(-5.0f, NAN, 0.5f));
    CHECK(out.x == 0.0f && out.y == 0.0f);
    CHECK_NEAR((double)out.z, 0.5, 1e-6);
}

// ---- AgX

TEST(agx_keeps_greys_grey_and_middle_grey_where_it_is)
{
    float before = -1.0f;
    for (int i = -160; i <= 120; i++) {
        const vec3s out = tonemap_agx(grey(0.18f * exp2f((float)i / 10.0f)));
        CHECK_NEAR((double)out.y, (double)out.x, 1e-6);
        CHECK_NEAR((double)out.z, (double)out.x, 1e-6);
        CHECK(out.x >= before && out.x >= 0.0f && out.x <= 1.0f);
        before = out.x;
    }
    CHECK_NEAR((double)tonemap_agx(grey(0.18f)).x, 0.18, 1e-6);
    // Black is 10 stops below middle grey, white 6.5 above.
    CHECK_NEAR((double)tonemap_agx(grey(0.18f * exp2f(-10.0f))).x, 0.0, 1e-6);
    CHECK_NEAR((double)tonemap_agx(grey(0.18f * exp2f(6.5f))).x, 1.0, 1e-5);
    CHECK(tonemap_agx(grey(0.0f)).x < 1e-6f && tonemap_agx(grey(INFINITY)).x > 1.0f - 1e-5f);
}

// Slope of values for a display of gamma 2.4, along the 16.5 stops.
TEST(agx_has_a_slope_of_2_4_at_middle_grey)
{
    const double h = 0.01;
    const double above = pow((double)tonemap_agx(grey(0.18f * exp2f(16.5f * (float)h))).x, 1 / 2.4),
                 below =
                     pow((double)tonemap_agx(grey(0.18f * exp2f(-16.5f * (float)h))).x, 1 / 2.4);
    CHECK_RELATIVE((above - below) / (2 * h), 2.4, 0.01);
}

TEST(agx_turns_bright_colours_white)
{
    float before = 1.0f;
    for (int i = 0; i <= 10; i++) {
        const vec3s out = tonemap_agx(vec3_of(0.18f * exp2f((float)i), 0.0f, 0.0f));
        const float saturation = 1.0f - fminf(out.y, out.z) / out.x;
        CHECK(saturation <= before);
        before = saturation;
    }
    CHECK(before < 0.1f);
    const vec3s blue = tonemap_agx(vec3_of(-1.0f, NAN, 0.2f));
    CHECK(blue.z > blue.x && blue.z > blue.y && blue.x >= 0.0f);
}

TEST(the_linear_curve_cuts_off_what_is_above_white)
{
    const vec3s out = tonemap(TONEMAP_LINEAR, vec3_of(-1.0f, 0.3f, 7.0f));
    CHECK(out.x == 0.0f && out.y == 0.3f && out.z == 1.0f);
}

TEST(an_image_is_exposed_and_tonemapped_per_pixel)
{
    struct image in, out;
    noise_image(&in, 8, 5, 4);
    CHECK(image_tonemap(&out, test_host(), &in, 9.0f, TONEMAP_NEUTRAL));
    CHECK(out.width == 8 && out.height == 5 && out.channels == 3);
    for (int y = 0; y < 5; y++) {
        for (int x = 0; x < 8; x++) {
            const float *l = image_at(&in, x, y);
            vec3s expected = tonemap_pbr_neutral(
                glms_vec3_scale(vec3_of(l[0], l[1], l[2]), exposure_scale(9.0f)));
            for (int c = 0; c < 3; c++) CHECK(image_at(&out, x, y)[c] == expected.raw[c]);
        }
    }
    image_finish(&out, test_host());
    CHECK(!image_tonemap(&out, test_host(), &in, NAN, TONEMAP_NEUTRAL));
    image_finish(&in, test_host());
    flat_image(&in, 2, 2, 1, 1.0f);
    CHECK(!image_tonemap(&out, test_host(), &in, 0.0f, TONEMAP_NEUTRAL));
    image_finish(&in, test_host());
}

// tonemap_twin.cpp
float glsl_exposure_scale(float ev);
void glsl_tonemap(int curve, const float exposed[3], float out[3]);

TEST(the_glsl_twin_agrees)
{
    struct image image;
    for (int ev = -30; ev <= 30; ev++)
        CHECK_RELATIVE((double)glsl_exposure_scale((float)ev), (double)exposure_scale((float)ev),
                       1e-6);
    noise_image(&image, 64, 64, 3);
    for (int i = 0; i < 64 * 64; i++) {
        float *p = image.pixels + 3 * i, shown[3];
        float scale = exp2f((float)(i % 24 - 16)); // from deep in the toe to far above white
        for (int c = 0; c < 3; c++) p[c] *= scale;
        if (i % 100 == 7) p[i % 3] = i % 200 == 7 ? INFINITY : NAN;
        for (int curve = 0; curve < TONEMAP_COUNT; curve++) {
            glsl_tonemap(curve, p, shown);
            vec3s expected = tonemap((enum tonemap_curve)curve, vec3_of(p[0], p[1], p[2]));
            for (int c = 0; c < 3; c++) CHECK_NEAR((double)shown[c], (double)expected.raw[c], 2e-6);
        }
    }
    image_finish(&image, test_host());
}
