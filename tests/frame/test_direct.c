// Direct light against closed forms and the BRDF in double precision.
#include "frame/frame_fixture.h"

#include "core/ggx_albedo.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double PI = 3.14159265358979323846;

// brdf.glsl in double precision, for grey: (1 − metallic) · [albedo/π · (1 − E) + k D V F] +
// metallic · k D V F, each lobe with its own F0, k = 1 + F0 (1 − Ess)/Ess.
static double brdf(double albedo, double metallic, double roughness, vec3s n, vec3s v, vec3s l)
{
    double r = fmax(roughness, 0.045), a = r * r, a2 = a * a;
    vec3s h = glms_vec3_normalize(glms_vec3_add(v, l));
    double nl = (double)glms_vec3_dot(n, l), nv = (double)glms_vec3_dot(n, v);
    double nh = (double)glms_vec3_dot(n, h), vh = (double)glms_vec3_dot(v, h);
    double base = nh * nh * (a2 - 1) + 1;
    double d = a2 / (PI * base * base);
    double vis = 0.5 / (nl * sqrt(nv * nv * (1 - a2) + a2) + nv * sqrt(nl * nl * (1 - a2) + a2));
    struct ggx_albedo e = ggx_albedo_at((float)nv, (float)r);
    double ess = (double)e.a + (double)e.b, schlick = pow(1 - vh, 5), sum = 0;
    for (int metal = 0; metal < 2; metal++) {
        double f0 = metal ? albedo : 0.04, k = 1 + f0 * (1 - ess) / ess;
        double directional = (f0 * (double)e.a + (double)e.b) * k;
        double lobe = d * vis * k * (f0 + (1 - f0) * schlick);
        sum += metal ? metallic * lobe : (1 - metallic) * (albedo / PI * (1 - directional) + lobe);
    }
    return sum;
}

// BRDF at a pixel's point of the plane y = 0, with the G-buffer's albedo.
static double brdf_at(struct frame_fixture *s, uint32_t x, uint32_t y, vec3s l)
{
    vec3s n = vec3_of(0, 1, 0), p = fixture_ray_on_plane(s, x, y, n, 0);
    vec3s v = glms_vec3_normalize(glms_vec3_sub(s->input.camera.eye, p));
    vec3s rm = fixture_pixel(s, READ_ROUGHNESS_METALLIC, x, y);
    return brdf((double)fixture_pixel(s, READ_ALBEDO, x, y).x, (double)rm.y, (double)rm.x, n, v, l);
}

static void begin_on_floor(struct frame_fixture *s, struct gpu *gpu, float albedo)
{
    fixture_init(s, gpu);
    struct material m = material_default();
    m.base_color = vec4_of(vec3_of(albedo, albedo, albedo), 1);
    fixture_floor(s, 8, fixture_material(s, &m));
    fixture_look(s, vec3_of(0, 2, 2), vec3_of(0, 0, 0));
}

TEST_GPU(sun_on_a_plane_gives_irradiance_times_the_brdf)
{
    for (int i = 0; i < 4; i++) {
        struct frame_fixture s;
        begin_on_floor(&s, gpu, 1.0f); // drivers decode the sRGB value 1 exactly
        vec3s to_sun = glms_vec3_normalize(vec3_of(0.5f * (float)i, 1, 0.2f));
        fixture_add_sun(&s, glms_vec3_negate(to_sun), vec3_of(1000, 1000, 1000));
        fixture_open(&s);
        fixture_render(&s);
        double lambert = (double)fixture_pixel(&s, READ_ALBEDO, 10, 20).x / PI;
        double expected = 1000 * (double)to_sun.y * brdf_at(&s, 10, 20, to_sun);
        CHECK_RELATIVE(fixture_pixel(&s, READ_DIRECT, 10, 20).x, expected, 2e-3);
        // Mostly Lambertian: at roughness 1 GGX adds a few per cent.
        CHECK_RELATIVE(expected, 1000 * (double)to_sun.y * lambert, 0.05);
        fixture_finish(&s);
    }
}

TEST_GPU(glossy_and_metallic_reflection_equals_the_brdf)
{
    static const float cases[][2] = {
        { 0, 0.2f }, { 1, 0.2f }, { 1, 0.6f }, { 0.4f, 0.4f }, { 1, 1 }
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct frame_fixture s;
        fixture_init(&s, gpu);
        struct material m = material_default();
        m.base_color = (vec4s){ { 0.8f, 0.8f, 0.8f, 1 } };
        m.metallic = cases[i][0];
        m.roughness = cases[i][1];
        fixture_floor(&s, 8, fixture_material(&s, &m));
        fixture_look(&s, vec3_of(0, 2, 2), vec3_of(0, 0, 0));
        vec3s to_sun =
            glms_vec3_normalize(vec3_of(0, 1, -1)); // mirror reflection at the image centre
        fixture_add_sun(&s, glms_vec3_negate(to_sun), vec3_of(10, 10, 10));
        fixture_open(&s);
        fixture_render(&s);
        for (uint32_t y = 12; y < 20; y += 2) {
            double expected = 10 * (double)to_sun.y * brdf_at(&s, 17, y, to_sun);
            // 11-bit normals rotate a narrow lobe slightly.
            CHECK_RELATIVE(fixture_pixel(&s, READ_DIRECT, 17, y).x, expected, 1e-2);
        }
        fixture_finish(&s);
    }
}

TEST_GPU(point_light_falls_off_with_the_square_of_the_distance)
{
    struct frame_fixture s;
    begin_on_floor(&s, gpu, 0.5f);
    vec3s light = vec3_of(0.3f, 1.5f, -0.4f);
    fixture_add_point(&s, light, vec3_of(100, 100, 100));
    fixture_open(&s);
    fixture_render(&s);
    for (uint32_t y = 14; y < 32; y += 4) {
        vec3s p = fixture_ray_on_plane(&s, 5, y, vec3_of(0, 1, 0), 0);
        vec3s to_light = glms_vec3_sub(light, p);
        double r2 = (double)glms_vec3_norm2(to_light);
        vec3s l = glms_vec3_normalize(to_light);
        double expected = 100 / r2 * (double)l.y * brdf_at(&s, 5, y, l);
        CHECK_RELATIVE(fixture_pixel(&s, READ_DIRECT, 5, y).x, expected, 3e-3);
    }
    fixture_finish(&s);
}

TEST_GPU(limited_range_ends_at_the_range)
{
    struct frame_fixture s;
    begin_on_floor(&s, gpu, 0.5f);
    struct world_light *light = fixture_add_point(&s, vec3_of(0, 1, 0), vec3_of(100, 100, 100));
    fixture_open(&s);
    fixture_render(&s);
    double unlimited = (double)fixture_pixel(&s, READ_DIRECT, 16, 16).x;
    vec3s p = fixture_ray_on_plane(&s, 16, 16, vec3_of(0, 1, 0), 0);
    double ratio2 = (double)glms_vec3_norm2(glms_vec3_sub(light->position, p)) / (1.5 * 1.5);
    light->range_m = 1.5f;
    fixture_render(&s);
    CHECK_RELATIVE(fixture_pixel(&s, READ_DIRECT, 16, 16).x, unlimited * (1 - ratio2 * ratio2),
                   2e-3);
    light->range_m = 0.9f;
    fixture_render(&s);
    CHECK(fixture_pixel(&s, READ_DIRECT, 16, 16).x == 0.0f);
    fixture_finish(&s);
}

TEST_GPU(spot_falls_off_between_its_inner_and_outer_angle)
{
    struct frame_fixture s;
    begin_on_floor(&s, gpu, 0.5f);
    vec3s from = vec3_of(0, 2, 0);
    fixture_add_spot(&s, from, vec3_of(0, -1, 0), 0.2f, 0.6f, vec3_of(100, 100, 100));
    fixture_open(&s);
    fixture_render(&s);
    int inside = 0, between = 0, outside = 0;
    for (uint32_t x = 0; x < 32; x++) {
        vec3s p = fixture_ray_on_plane(&s, x, 16, vec3_of(0, 1, 0), 0);
        vec3s to_light = glms_vec3_sub(from, p);
        vec3s l = glms_vec3_normalize(to_light);
        double t = ((double)l.y - cos(0.6)) / (cos(0.2) - cos(0.6));
        double cone = pow(fmin(fmax(t, 0), 1), 2);
        inside += t >= 1, between += t > 0 && t < 1, outside += t <= 0;
        double expected = 100 * cone / (double)glms_vec3_norm2(to_light) * (double)l.y;
        expected *= brdf_at(&s, x, 16, l);
        CHECK_NEAR(fixture_pixel(&s, READ_DIRECT, x, 16).x, expected, 3e-3 * (expected + 0.01));
    }
    CHECK(inside > 0 && between > 0 && outside > 0);
    fixture_finish(&s);
}

TEST_GPU(half_the_sun_gives_exactly_half_the_radiance)
{
    struct frame_fixture s;
    begin_on_floor(&s, gpu, 0.7f);
    struct world_light *sun =
        fixture_add_sun(&s, vec3_of(-0.3f, -1, -0.2f), vec3_of(98765, 43210, 1234));
    fixture_open(&s);
    fixture_render(&s);
    float *whole = fixture_read(&s, READ_DIRECT), scale = frame_radiance_scale(s.frame);
    sun->intensity = glms_vec3_scale(sun->intensity, 0.5f);
    fixture_render(&s);
    float *half = fixture_read(&s, READ_DIRECT);
    CHECK(frame_radiance_scale(s.frame) == 2 * scale);
    for (size_t i = 0; i < 32 * 32 * 3; i++) CHECK(half[i] == 0.5f * whole[i]);
    CHECK(whole[3 * (20 * 32 + 16)] > 0);
    free(whole);
    free(half);
    fixture_finish(&s);
}

TEST_GPU(light_of_two_lights_is_the_sum)
{
    struct frame_fixture s;
    begin_on_floor(&s, gpu, 0.5f);
    fixture_add_sun(&s, vec3_of(-0.3f, -1, 0), vec3_of(200, 100, 50));
    fixture_add_point(&s, vec3_of(0.5f, 1, 0), vec3_of(50, 100, 200));
    fixture_open(&s);
    fixture_render(&s);
    float *both = fixture_read(&s, READ_DIRECT);
    s.input.light_count = 1;
    fixture_render(&s);
    float *first = fixture_read(&s, READ_DIRECT);
    s.lights[0] = s.lights[1];
    fixture_render(&s);
    float *second = fixture_read(&s, READ_DIRECT);
    for (size_t i = 0; i < 32 * 32 * 3; i++)
        CHECK_NEAR(both[i], (double)first[i] + (double)second[i], 2e-3 * (double)both[i] + 1e-6);
    free(both);
    free(first);
    free(second);
    fixture_finish(&s);
}

TEST_GPU(without_light_the_image_is_exactly_black)
{
    struct frame_fixture s;
    begin_on_floor(&s, gpu, 0.5f);
    fixture_open(&s);
    fixture_render(&s);
    float *color = fixture_read(&s, READ_COLOR);
    for (size_t i = 0; i < 32 * 32 * 3; i++) CHECK(color[i] == 0.0f);
    free(color);
    fixture_finish(&s);
}

TEST_GPU(surfaces_facing_away_from_the_light_are_black)
{
    struct frame_fixture s;
    begin_on_floor(&s, gpu, 0.5f);
    fixture_add_sun(&s, vec3_of(0.2f, 1, 0), vec3_of(1000, 1000, 1000));
    fixture_open(&s);
    fixture_render(&s);
    CHECK(fixture_pixel(&s, READ_DIRECT, 16, 24).x == 0.0f);
    fixture_finish(&s);
}

TEST_GPU(emission_equals_its_radiance)
{
    struct frame_fixture s;
    fixture_init(&s, gpu);
    struct material m = material_default();
    m.emissive = vec3_of(1200, 300, 7);
    fixture_floor(&s, 8, fixture_material(&s, &m));
    fixture_look(&s, vec3_of(0, 2, 2), vec3_of(0, 0, 0));
    fixture_open(&s);
    fixture_render(&s);
    vec3s seen = fixture_pixel(&s, READ_COLOR, 16, 24);
    for (int k = 0; k < 3; k++) CHECK_RELATIVE(seen.raw[k], m.emissive.raw[k], 1e-3);
    CHECK_RELATIVE(fixture_pixel(&s, READ_EMISSIVE, 16, 24).x, 1200, 1e-3);
    fixture_finish(&s);
}

TEST_GPU(empty_scene_shows_the_sky)
{
    struct frame_fixture s;
    fixture_init(&s, gpu);
    s.input.environment.sky = vec3_of(1000, 2000, 4000);
    fixture_add_sun(&s, vec3_of(0, -1, 0), vec3_of(100, 100, 100));
    fixture_add_point(&s, vec3_of(0, 1, 0), vec3_of(100, 100, 100));
    fixture_open(&s);
    fixture_render(&s);
    float *color = fixture_read(&s, READ_COLOR);
    for (size_t i = 0; i < 32 * 32; i++)
        for (size_t k = 0; k < 3; k++)
            CHECK_RELATIVE(color[3 * i + k], s.input.environment.sky.raw[k], 1e-3);
    free(color);
    fixture_finish(&s);
}
