// The reference layers of techniques: indirect light plus direct light of emitters and the sky.
#include "trace/trace_fixture.h"

#include <math.h>
#include <string.h>

static const double PI = 3.14159265358979323846;

static vec3s grey(float v)
{
    return vec3_of(v, v, v);
}

struct layers {
    struct image image[REFERENCE_LAYER_COUNT];
};

static struct layers render(struct trace_fixture *s)
{
    struct layers l;
    struct reference *r = fixture_reference(s);
    assert_true(reference_render(r, s->samples, NULL, NULL));
    for (int i = 0; i < REFERENCE_LAYER_COUNT; i++)
        assert_true(reference_read(r, (enum reference_layer)i, &l.image[i]));
    reference_destroy(r);
    return l;
}

static void finish(struct layers *l)
{
    for (int i = 0; i < REFERENCE_LAYER_COUNT; i++) image_finish(&l->image[i], test_host());
}

static bool are_equal(const struct image *a, const struct image *b)
{
    size_t count = (size_t)a->width * (size_t)a->height * (size_t)a->channels;
    return memcmp(a->pixels, b->pixels, count * sizeof *a->pixels) == 0;
}

TEST(without_emitters_and_sky_both_layers_equal_the_indirect_light)
{
    struct trace_fixture s;
    fixture_builtin(&s, "@cornell:light=point");
    struct layers l = render(&s);
    CHECK(image_mean(&l.image[REFERENCE_INDIRECT_EMITTERS_SKY], 1) > 0);
    CHECK(are_equal(&l.image[REFERENCE_INDIRECT_EMITTERS_SKY], &l.image[REFERENCE_INDIRECT]));
    CHECK(are_equal(&l.image[REFERENCE_IRRADIANCE_EMITTERS_SKY], &l.image[REFERENCE_IRRADIANCE]));
    finish(&l);
    fixture_finish(&s);
}

static vec3s emitter_radiance(const struct scene *scene)
{
    vec3s emission = grey(0);
    for (int i = 0; i < scene->material_count; i++)
        if (scene->materials[i].emissive.x > 0) emission = scene->materials[i].emissive;
    return emission;
}

// @cornell is lit by its emitter alone: the rest of the colour is visible emission.
TEST(the_rest_of_the_color_is_visible_emission)
{
    struct trace_fixture s;
    fixture_builtin(&s, "@cornell");
    s.options.diffuse_only = false;
    struct layers l = render(&s);
    vec3s emission = emitter_radiance(s.scene);
    int emitter = 0, lit = 0;
    for (int i = 0; i < s.width * s.height; i++) {
        double color = (double)l.image[REFERENCE_COLOR].pixels[3 * i];
        double left = color - (double)l.image[REFERENCE_INDIRECT_EMITTERS_SKY].pixels[3 * i];
        bool emissive = left > 0.5 * (double)emission.x;
        // Color is a sum of two values rounded to 2⁻²⁴.
        CHECK_NEAR(left, emissive ? (double)emission.x : 0, 2e-7 * color);
        emitter += emissive;
        lit += color > 0 && !emissive;
    }
    CHECK(emitter > 0 && lit > 16 * emitter);
    finish(&l);
    fixture_finish(&s);
}

TEST(a_diffuse_surface_reflects_albedo_over_pi_times_the_irradiance)
{
    struct trace_fixture s;
    fixture_builtin(&s, "@cornell");
    s.options.diffuse_only = true;
    s.scene->environment.sky = vec3_of(3, 2, 1);
    struct layers l = render(&s);
    for (int i = 0; i < s.width * s.height * 3; i++) {
        double albedo = (double)l.image[REFERENCE_ALBEDO].pixels[i];
        double irradiance = (double)l.image[REFERENCE_IRRADIANCE_EMITTERS_SKY].pixels[i];
        double expected = albedo * irradiance / PI;
        CHECK_NEAR(l.image[REFERENCE_INDIRECT_EMITTERS_SKY].pixels[i], expected,
                   1e-5 * expected + 1e-6);
        CHECK(irradiance >= (double)l.image[REFERENCE_IRRADIANCE].pixels[i]);
    }
    finish(&l);
    fixture_finish(&s);
}

static void add_floor(struct trace_fixture *s, float albedo, float metallic)
{
    struct material m = material_default();
    m.base_color = vec4_of(grey(albedo), 1);
    m.metallic = metallic;
    m.roughness = 0.4f;
    fixture_quad(s, vec3_of(-8, 0, 8), vec3_of(8, 0, 8), vec3_of(8, 0, -8), vec3_of(-8, 0, -8),
                 fixture_material(s, &m));
}

// Form factor of a right-angled corner of a parallel rectangle above the point (Howell, B-3): a, b:
// its sides over its height.
static double corner_factor(double a, double b)
{
    double p = sqrt(1 + a * a), q = sqrt(1 + b * b);
    return (a / p * atan(b / p) + b / q * atan(a / q)) / (2 * PI);
}

// Irradiance does not depend on the receiver: a white, a black and a metal floor have the same.
TEST(rectangle_light_gives_its_closed_form_irradiance_on_any_floor)
{
    static const float floors[][2] = { { 1, 0 }, { 0, 0 }, { 0.9f, 1 } };
    static const float heights[] = { 0.2f, 1.0f, 4.0f };
    for (int i = 0; i < 9; i++) {
        struct trace_fixture s;
        fixture_init(&s);
        s.samples = 1024;
        s.options.diffuse_only = i % 3 == 0;
        s.options.direct_only = true;
        add_floor(&s, floors[i % 3][0], floors[i % 3][1]);
        float h = heights[i / 3];
        fixture_quad(&s, vec3_of(-0.5f, h, -1), vec3_of(0.5f, h, -1), vec3_of(0.5f, h, 1),
                     vec3_of(-0.5f, h, 1), fixture_diffuse(&s, grey(0), vec3_of(5, 2, 1)));
        fixture_aim_camera(&s, vec3_of(0.3f, 0.1f, 0.1f), vec3_of(0, 0, 0), 0.01f);
        double expected = 4 * corner_factor(0.5 / (double)h, 1.0 / (double)h) * PI;
        struct layer_mean m = fixture_mean(&s, REFERENCE_IRRADIANCE_EMITTERS_SKY);
        CHECK_RELATIVE(m.mean[0], 5 * expected, 0.005);
        CHECK_RELATIVE(m.mean[1], 2 * expected, 0.005);
        // The standard error is that of the color, E/π on the white floor.
        if (i % 3 == 0) CHECK_NEAR(m.mean[1], 2 * expected, 3 * PI * m.error + 1e-4 * expected);
        m = fixture_mean(&s, REFERENCE_IRRADIANCE);
        CHECK_NEAR(m.mean[1], 0, 0);
        fixture_finish(&s);
    }
}

TEST(uniform_sky_gives_the_irradiance_pi_times_its_radiance)
{
    static const float floors[][2] = { { 0.5f, 0 }, { 0.9f, 1 } };
    for (int i = 0; i < 2; i++) {
        struct trace_fixture s;
        fixture_init(&s);
        s.samples = 1024;
        s.options.diffuse_only = i == 0;
        s.scene->environment.sky = vec3_of(2, 4, 8);
        add_floor(&s, floors[i][0], floors[i][1]);
        fixture_aim_camera(&s, vec3_of(0, 1, 0), vec3_of(0.01f, 0, 0), 0.5f);
        struct layer_mean m = fixture_mean(&s, REFERENCE_IRRADIANCE_EMITTERS_SKY);
        // Cosine sampling has no variance here; a metal also samples its specular lobe.
        for (int c = 0; c < 3; c++)
            CHECK_RELATIVE(m.mean[c], PI * (double)s.scene->environment.sky.raw[c],
                           i == 0 ? 1e-5 : 0.005);
        fixture_finish(&s);
    }
}

// The visible sky is in color alone.
TEST(restricted_light_is_missing_from_the_layers)
{
    struct trace_fixture s;
    fixture_builtin(&s, "@cornell");
    s.options.indirect_only = true;
    struct layers l = render(&s);
    CHECK(image_mean(&l.image[REFERENCE_INDIRECT], 0) > 0);
    CHECK(are_equal(&l.image[REFERENCE_INDIRECT_EMITTERS_SKY], &l.image[REFERENCE_INDIRECT]));
    CHECK(are_equal(&l.image[REFERENCE_IRRADIANCE_EMITTERS_SKY], &l.image[REFERENCE_IRRADIANCE]));
    finish(&l);
    fixture_finish(&s);
    fixture_init(&s);
    s.scene->environment.sky = grey(1);
    l = render(&s);
    CHECK_NEAR(image_mean(&l.image[REFERENCE_COLOR], 0), 1, 0);
    CHECK_NEAR(image_mean(&l.image[REFERENCE_INDIRECT_EMITTERS_SKY], 0), 0, 0);
    CHECK_NEAR(image_mean(&l.image[REFERENCE_IRRADIANCE_EMITTERS_SKY], 0), 0, 0);
    finish(&l);
    fixture_finish(&s);
}
