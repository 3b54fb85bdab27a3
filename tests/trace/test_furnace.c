// Furnaces and open skies with closed-form radiance.
#include "trace/trace_fixture.h"

#include <math.h>

static const double PI = 3.14159265358979323846;

static vec3s grey(float v)
{
    return vec3_of(v, v, v);
}

TEST(furnace_has_the_radiance_of_a_geometric_series)
{
    static const float albedos[] = { 0.0f, 0.25f, 0.5f, 0.8f, 0.95f };
    for (int i = 0; i < 5; i++) {
        struct trace_fixture s;
        fixture_init(&s);
        s.samples = 512;
        fixture_room(&s, 1, fixture_diffuse(&s, grey(albedos[i]), vec3_of(3, 1, 0.5f)));
        fixture_aim_camera(&s, vec3_of(0.2f, 0.1f, 0.3f), vec3_of(-1, -0.7f, -0.4f), 1.2f);
        struct layer_mean m = fixture_mean(&s, REFERENCE_COLOR);
        double gain = 1.0 / (1.0 - (double)albedos[i]);
        CHECK_RELATIVE(m.mean[0], 3.0 * gain, 0.005);
        CHECK_RELATIVE(m.mean[1], 1.0 * gain, 0.005);
        CHECK_RELATIVE(m.mean[2], 0.5 * gain, 0.005);
        double luminance = 0.2126 * 3 + 0.7152 + 0.0722 * 0.5;
        double measured = 0.2126 * m.mean[0] + 0.7152 * m.mean[1] + 0.0722 * m.mean[2];
        CHECK_NEAR(measured, luminance * gain, 3.0 * m.error + 1e-5 * luminance * gain);
        fixture_finish(&s);
    }
}

// n bounces of a furnace are the first n + 2 terms of the series: emission, its reflection, …
TEST(each_bounce_of_a_furnace_adds_one_term)
{
    for (int bounces = 0; bounces < 4; bounces++) {
        struct trace_fixture s;
        fixture_init(&s);
        s.samples = 256;
        s.options.bounces = bounces;
        fixture_room(&s, 1, fixture_diffuse(&s, grey(0.6f), grey(1)));
        struct layer_mean m = fixture_mean(&s, REFERENCE_COLOR);
        double expected = (1.0 - pow(0.6, bounces + 2)) / 0.4;
        CHECK_RELATIVE(m.mean[1], expected, 0.005);
        fixture_finish(&s);
    }
}

// E = π L, and a surface of albedo ρ shows ρ L.
TEST(uniform_sky_gives_the_irradiance_pi_times_its_radiance)
{
    struct trace_fixture s;
    fixture_init(&s);
    s.scene->environment.sky = vec3_of(2, 4, 8);
    fixture_quad(&s, vec3_of(-9, 0, 9), vec3_of(9, 0, 9), vec3_of(9, 0, -9), vec3_of(-9, 0, -9),
                 fixture_diffuse(&s, grey(0.5f), grey(0)));
    fixture_aim_camera(&s, vec3_of(0, 1, 0), vec3_of(0.01f, 0, 0), 0.5f);
    struct layer_mean m = fixture_mean(&s, REFERENCE_DIRECT);
    // Cosine sampling of an unoccluded uniform sky has no variance.
    CHECK_RELATIVE(m.mean[0], 1.0, 1e-5);
    CHECK_RELATIVE(m.mean[1], 2.0, 1e-5);
    CHECK_RELATIVE(m.mean[2], 4.0, 1e-5);
    fixture_finish(&s);
}

// The irradiance layer excludes emission and its first reflection.
TEST(irradiance_of_a_furnace_is_pi_times_the_light_reflected_in_it)
{
    struct trace_fixture s;
    fixture_init(&s);
    s.samples = 512;
    fixture_room(&s, 1, fixture_diffuse(&s, grey(0.5f), grey(1)));
    struct layer_mean m = fixture_mean(&s, REFERENCE_IRRADIANCE);
    CHECK_RELATIVE(m.mean[1], PI * (2.0 - 1.0), 0.005);
    fixture_finish(&s);
}

// Multiple-scattering compensation: a white material disappears in a uniform environment.
TEST(white_materials_disappear_before_a_uniform_sky)
{
    static const float roughness[] = { 0.0f, 0.3f, 0.6f, 1.0f };
    static const float heights[] = { 5.0f, 0.5f };
    for (int i = 0; i < 16; i++) {
        struct trace_fixture s;
        fixture_init(&s);
        s.options.diffuse_only = false;
        s.samples = 256;
        s.scene->environment.sky = grey(1);
        struct material m = material_default();
        m.metallic = (float)(i / 8);
        m.roughness = roughness[i / 2 % 4];
        fixture_quad(&s, vec3_of(-9, 0, 9), vec3_of(9, 0, 9), vec3_of(9, 0, -9), vec3_of(-9, 0, -9),
                     fixture_material(&s, &m));
        fixture_aim_camera(&s, vec3_of(1, heights[i % 2], 0), vec3_of(0, 0, 0), 0.001f);
        struct layer_mean mean = fixture_mean(&s, REFERENCE_COLOR);
        CHECK(mean.error < 0.01);
        CHECK_NEAR(mean.mean[1], 1, 3 * mean.error + 2e-3);
        fixture_finish(&s);
    }
}
