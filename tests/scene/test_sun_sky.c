// Known answers of the daylight model: formulas by hand, photometry of clear days, symmetries.
#include "framework/test.h"

#include "scene/environment/cie.h"
#include "scene/environment/sun_sky.h"

#include <math.h>

static const float RAD = GLM_PIf / 180.0f;

static struct sun_sky sky_at(float elevation_deg, float azimuth_deg, float turbidity)
{
    return (struct sun_sky){
        elevation_deg * RAD, azimuth_deg * RAD, turbidity, { { 0.2f, 0.3f, 0.1f } }
    };
}

static struct sun_sky_model model_at(float elevation_deg, float turbidity)
{
    const struct sun_sky sky = sky_at(elevation_deg, 0.0f, turbidity);
    struct sun_sky_model model;
    sun_sky_prepare(&sky, &model);
    return model;
}

static vec3s direction(float elevation_deg, float azimuth_deg)
{
    const float e = elevation_deg * RAD, a = azimuth_deg * RAD;
    return vec3_of(cosf(e) * sinf(a), sinf(e), -cosf(e) * cosf(a));
}

// At normal incidence.
static vec3s sun_lux(float elevation_deg, float turbidity)
{
    const struct sun_sky_model model = model_at(elevation_deg, turbidity);
    vec3s to_sun;
    return sun_sky_sun(&model, &to_sun);
}

// Illuminance of the horizontal ground by sun and sky.
static double total_lux(float elevation_deg, float turbidity)
{
    const struct sun_sky_model model = model_at(elevation_deg, turbidity);
    vec3s to_sun;
    const float sun = luminance(sun_sky_sun(&model, &to_sun));
    return (double)(sun * fmaxf(to_sun.y, 0.0f) + luminance(sun_sky_horizontal(&model)));
}

static void check_colour(vec3s a, vec3s b, double tolerance)
{
    const double scale = (double)fmaxf(glms_vec3_max(a), glms_vec3_max(b));
    for (int c = 0; c < 3; c++) CHECK_NEAR(a.raw[c], b.raw[c], tolerance * scale);
}

// ---- colour

TEST(equal_energy_is_white_of_the_standard_observer)
{
    double sums[3] = { 0 };
    for (int nm = 360; nm <= 830; nm++)
        for (int c = 0; c < 3; c++) sums[c] += (double)cie_match((float)nm).raw[c];
    const double all = sums[0] + sums[1] + sums[2];
    CHECK_NEAR(sums[0] / all, 1.0 / 3.0, 0.002);
    CHECK_NEAR(sums[1] / all, 1.0 / 3.0, 0.002);
    CHECK_NEAR(sums[1], 106.857, 0.5); // CIE 1931, 1 nm
}

TEST(d65_is_white_and_colours_keep_their_luminance)
{
    const vec3s white = cie_rec709_from_xyz(vec3_of(0.95047f, 1.0f, 1.08883f));
    for (int c = 0; c < 3; c++) CHECK_NEAR(white.raw[c], 1.0, 2e-4);
    for (int nm = 380; nm <= 780; nm += 5) { // outside of the gamut
        const vec3s xyz = cie_match((float)nm), rgb = cie_rec709_from_xyz(xyz);
        CHECK(glms_vec3_min(rgb) >= 0.0f);
        CHECK_NEAR(luminance(rgb), xyz.y, 2e-6);
    }
    check_colour(cie_rec709_from_xyz(vec3_of(1, 0, 1)), glms_vec3_zero(), 0.0);
}

// ---- sky

// Appendix A.2 by hand: χ = (4/9 − T/120)(π − 2θ). The sun 30° from the zenith, T = 2.5: χ =
// 0.423611 · 2π/3 = 0.887209, its tangent 1.227579; 5.14225 · 1.227579 + 1.88045 = 8.19297 kcd/m².
// The sun at the zenith, T = 6: χ = 0.394444 π = 1.239184, its tangent 2.904211; 19.3008 · 2.904211
// + 1.1262 = 57.1798 kcd/m².
TEST(the_zenith_has_the_luminance_of_its_formula)
{
    const vec3s up = vec3_of(0, 1, 0);
    struct sun_sky_model model = model_at(60, 2.5f);
    CHECK_RELATIVE(luminance(sun_sky_radiance(&model, up)), 8192.97, 1e-5);
    model = model_at(90, 6);
    CHECK_RELATIVE(luminance(sun_sky_radiance(&model, up)), 57179.8, 1e-5);
}

// Equation 3 with T = 3: at 60° from the zenith, in the sun's direction, over its value at the
// zenith, 60° from the sun.
TEST(luminance_follows_the_distribution_of_perez)
{
    const struct sun_sky_model model = model_at(30, 3);
    const double a = 0.1787 * 3 - 1.463, b = -0.3554 * 3 + 0.4275, c = -0.0227 * 3 + 5.3251,
                 d = 0.1206 * 3 - 2.5771, e = -0.067 * 3 + 0.3703, third = 1.04719755;
    const double at_sun = (1 + a * exp(b / 0.5)) * (1 + c + e);
    const double zenith = (1 + a * exp(b)) * (1 + c * exp(d * third) + e * 0.25);
    const double ratio = (double)(luminance(sun_sky_radiance(&model, direction(30, 0))) /
                                  luminance(sun_sky_radiance(&model, vec3_of(0, 1, 0))));
    CHECK_RELATIVE(ratio, at_sun / zenith, 1e-5);
}

TEST(the_sky_is_symmetric_about_the_meridian_of_the_sun)
{
    const struct sun_sky_model model = model_at(25, 3);
    for (float elevation = 0; elevation < 90; elevation += 10)
        for (float azimuth = 5; azimuth < 180; azimuth += 12.5f)
            check_colour(sun_sky_radiance(&model, direction(elevation, azimuth)),
                         sun_sky_radiance(&model, direction(elevation, -azimuth)), 1e-5);
}

TEST(the_sky_turns_with_the_azimuth_of_the_sun)
{
    const struct sun_sky sky = sky_at(25, 77, 3);
    const struct sun_sky_model north = model_at(25, 3);
    struct sun_sky_model turned;
    vec3s to_sun;
    sun_sky_prepare(&sky, &turned);
    check_colour(sun_sky_sun(&turned, &to_sun), sun_sky_sun(&north, &to_sun), 1e-6);
    for (float elevation = -20; elevation < 90; elevation += 5)
        for (float azimuth = 0; azimuth < 360; azimuth += 11)
            check_colour(sun_sky_radiance(&turned, direction(elevation, azimuth + 77)),
                         sun_sky_radiance(&north, direction(elevation, azimuth)), 1e-5);
}

TEST(azimuths_run_from_north_to_east)
{
    struct sun_sky_model model;
    vec3s to_sun;
    struct sun_sky sky = sky_at(0, 90, 3);
    sun_sky_prepare(&sky, &model);
    (void)sun_sky_sun(&model, &to_sun);
    check_colour(to_sun, vec3_of(1, 0, 0), 1e-6);
    sky = sky_at(30, 0, 3);
    sun_sky_prepare(&sky, &model);
    (void)sun_sky_sun(&model, &to_sun);
    check_colour(to_sun, vec3_of(0, 0.5f, -sqrtf(0.75f)), 1e-6);
}

// ---- photometry

// The model's sky is brighter than most measured ones, of 10 to 20 klx.
TEST(a_clear_summer_noon_has_the_illuminance_that_is_measured)
{
    const struct sun_sky_model model = model_at(60, 2.5f), clearer = model_at(60, 2);
    vec3s to_sun;
    const float sun = luminance(sun_sky_sun(&model, &to_sun));
    const float sky = luminance(sun_sky_horizontal(&model));
    CHECK(sun > 80e3f && sun < 110e3f);
    CHECK(sky > 8e3f && sky < 30e3f);
    CHECK(sun * to_sun.y + sky > 80e3f && sun * to_sun.y + sky < 125e3f);
    CHECK(luminance(sun_sky_horizontal(&clearer)) > 8e3f);
    CHECK(luminance(sun_sky_horizontal(&clearer)) < 25e3f);
}

// The solar constant of illumination, before any attenuation.
TEST(sunlight_stays_below_that_above_the_atmosphere_and_falls_with_haze)
{
    for (float elevation = 5; elevation <= 90; elevation += 5)
        for (float turbidity = 2; turbidity < 10; turbidity++) {
            const float clear = luminance(sun_lux(elevation, turbidity));
            CHECK(clear < 133300.0f);
            CHECK(luminance(sun_lux(elevation, turbidity + 1)) < clear);
        }
}

TEST(the_ground_reflects_sun_and_sky)
{
    const struct sun_sky_model model = model_at(40, 3);
    vec3s to_sun;
    const vec3s sun = sun_sky_sun(&model, &to_sun), sky = sun_sky_horizontal(&model);
    const vec3s ground = sun_sky_radiance(&model, direction(-30, 10));
    static const float albedo[3] = { 0.2f, 0.3f, 0.1f };
    for (int c = 0; c < 3; c++)
        CHECK_RELATIVE(ground.raw[c], albedo[c] / GLM_PIf * (sun.raw[c] * to_sun.y + sky.raw[c]),
                       1e-5);
}

// Against the midpoint rule with many points.
TEST(the_illuminance_of_the_sky_is_the_integral_of_its_radiance)
{
    enum { RINGS = 200, STEPS = 400 };
    static const float elevations[] = { 0, 10, 50 };
    for (size_t i = 0; i < sizeof elevations / sizeof *elevations; i++) {
        const struct sun_sky_model model = model_at(elevations[i], 2);
        double sum = 0.0;
        for (int r = 0; r < RINGS; r++)
            for (int s = 0; s < STEPS; s++) {
                const float e = 90.0f * ((float)r + 0.5f) / RINGS;
                const float radiance = luminance(
                    sun_sky_radiance(&model, direction(e, 360.0f * ((float)s + 0.5f) / STEPS)));
                sum += (double)(radiance * sinf(e * RAD) * cosf(e * RAD));
            }
        sum *= (double)(GLM_PI_2f / RINGS * 2.0f * GLM_PIf / STEPS);
        CHECK_RELATIVE(luminance(sun_sky_horizontal(&model)), sum, 1e-3);
    }
}

// ---- colour of sun and sky

// As long as it lights anything: below, the fit of the colour-matching functions ends.
TEST(the_sun_is_redder_the_lower_it_is)
{
    for (float turbidity = 2; turbidity <= 10; turbidity += 4) {
        vec3s higher = sun_lux(90, turbidity);
        for (float elevation = 89; elevation >= 0; elevation--) {
            const vec3s sun = sun_lux(elevation, turbidity);
            if (luminance(sun) < 0.1f) break;
            CHECK(sun.z / sun.x <= higher.z / higher.x);
            CHECK(sun.z == 0.0f || sun.z / sun.x < higher.z / higher.x);
            higher = sun;
        }
    }
}

TEST(the_sky_opposite_to_the_sun_is_bluer_than_the_sun)
{
    const struct sun_sky_model model = model_at(45, 2.5f);
    vec3s to_sun;
    const vec3s sun = sun_sky_sun(&model, &to_sun);
    const vec3s sky = sun_sky_radiance(&model, direction(45, 180));
    CHECK(sky.z / sky.x > 1.5f * sun.z / sun.x);
    CHECK(sky.z > sky.x);
}

// ---- all of the domain

static void check_valid(vec3s colour)
{
    for (int c = 0; c < 3; c++) CHECK(isfinite(colour.raw[c]) && colour.raw[c] >= 0.0f);
}

TEST(light_is_finite_and_never_negative)
{
    for (float elevation = -90; elevation <= 90;
         elevation += elevation >= -8 && elevation < 8 ? 0.5f : 4)
        for (float turbidity = 2; turbidity <= 10; turbidity += 0.5f) {
            const struct sun_sky_model model = model_at(elevation, turbidity);
            vec3s to_sun;
            check_valid(sun_sky_sun(&model, &to_sun));
            check_valid(sun_sky_radiance(&model, to_sun));
            for (float e = -90; e <= 90; e += 7.5f)
                for (float a = 0; a < 360; a += 30)
                    check_valid(sun_sky_radiance(&model, direction(e, a)));
        }
}

TEST(night_is_black)
{
    static const float elevations[] = { -6, -7, -45, -90 };
    for (size_t i = 0; i < sizeof elevations / sizeof *elevations; i++) {
        const struct sun_sky_model model = model_at(elevations[i], 4);
        check_colour(sun_sky_radiance(&model, direction(20, 30)), glms_vec3_zero(), 0.0);
        check_colour(sun_sky_radiance(&model, direction(-20, 30)), glms_vec3_zero(), 0.0);
        check_colour(model.sun_lux, glms_vec3_zero(), 0.0);
    }
}

TEST(sunset_is_continuous)
{
    for (float elevation = -1; elevation < 2; elevation += 0.05f) {
        const double before = total_lux(elevation, 2.5f),
                     after = total_lux(elevation + 0.05f, 2.5f);
        CHECK(after > before && after < 1.02 * before);
    }
}

// Half a radius below the horizon 0.1955 of the disc are left, half of it at the horizon.
TEST(the_disc_sets_by_its_visible_area)
{
    check_colour(sun_lux(-0.27f, 2.5f), glms_vec3_zero(), 0.0);
    CHECK_RELATIVE(luminance(sun_lux(-0.1332f, 2.5f)), luminance(sun_lux(0, 2.5f)) * 0.391f, 2e-3);
}
