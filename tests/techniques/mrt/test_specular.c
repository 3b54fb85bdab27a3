// Specular light of modular radiance transfer.
#include "frame/frame_fixture.h"
#include "techniques/gi_fixture.h"
#include "techniques/mrt/dictionary/rays.h"
#include "techniques/mrt/mrt_shared.h"
#include "trace/bsdf.h"
#include "trace/reflectance.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { TEXT = 512 };

static const double SH_Y1 = 0.48860251; // √(3/4π)

#define DICTIONARY                                                                                 \
    ":map=single,texels=8,rays=1024,modes=24,lightfield_positions=4,lightfield_directions=6,"      \
    "lightfield_supersampling=1,lightfield_modes=16,lightfield_rounds=0,response_modes=12,"        \
    "block_probes=2,bounces=16"

// Radiance that is linear in its direction is what lobes see of the vector irradiance.
TEST(vector_irradiance_of_linear_light_is_that_of_the_fit)
{
    struct mrt_rays rays;
    double slope[2] = { 0, 0 };
    assert_true(mrt_rays_init(test_host(), MRT_VECTOR, 65536, &rays));
    for (int i = 0; i < rays.count; i++) {
        const vec3s d = rays.direction[i];
        const double radiosity = GLM_PI * (1.0 + 0.5 * (double)d.x - 0.25 * (double)d.y);
        slope[0] += SH_Y1 * radiosity * (double)rays.weight[i * rays.values + 3];
        slope[1] += SH_Y1 * radiosity * (double)rays.weight[i * rays.values + 1];
    }
    CHECK_RELATIVE((double)MRT_VECTOR_OF_SLOPE * slope[0], 0.5 * 2.0 * GLM_PI / 3.0, 1e-3);
    CHECK_RELATIVE((double)MRT_VECTOR_OF_SLOPE * slope[1], -0.25 * 2.0 * GLM_PI / 3.0, 1e-3);
    mrt_rays_finish(test_host(), &rays);
}

// ---- a furnace

static struct material furnace_material(vec3s base, float metallic, float roughness)
{
    struct material m = material_default();
    m.base_color = vec4_of(base, 1);
    m.metallic = metallic;
    m.roughness = roughness;
    m.emissive = vec3_of(2, 1, 0.5f);
    return m;
}

static struct bsdf_material bsdf_material_of(const struct material *m)
{
    return (struct bsdf_material){ .albedo =
                                       vec3_of(m->base_color.x, m->base_color.y, m->base_color.z),
                                   .metallic = m->metallic,
                                   .roughness = m->roughness,
                                   .dielectric_f0 = vec3_of(0.04f, 0.04f, 0.04f),
                                   .dielectric_f90 = 1 };
}

// Share of uniform light that the specular lobe reflects towards the viewer.
static vec3s lobe_albedo(const struct bsdf_material *m, vec3s normal, vec3s to_viewer)
{
    const struct bsdf b = bsdf_of(normal, to_viewer, m, false);
    const struct ggx_albedo e = ggx_albedo_at(b.n_v, fmaxf(m->roughness, GGX_MIN_ROUGHNESS));
    return glms_vec3_muladds(b.f90, e.b, glms_vec3_scale(b.f0, e.a));
}

struct errors {
    double sum, worst;
    int count;
};

// Specular light over what the lobe reflects of the radiance L / (1 − ρ) of all surfaces.
static struct errors furnace_errors(struct frame_fixture *s, const struct material *m)
{
    const struct bsdf_material material = bsdf_material_of(m);
    const struct surface surface = { .material = material };
    const vec3s reflectance = surface_reflectance(&surface);
    float *specular = fixture_read(s, READ_SPECULAR), *normal = fixture_read(s, READ_NORMAL);
    struct errors out = { 0 };
    for (uint32_t i = 0; i < s->width * s->height; i++) {
        const vec3s ray =
            fixture_ray(s, (float)(i % s->width) + 0.5f, (float)(i / s->width) + 0.5f);
        const vec3s to_viewer = glms_vec3_negate(glms_vec3_normalize(ray));
        const vec3s n = vec3_of(normal[3 * i], normal[3 * i + 1], normal[3 * i + 2]);
        const vec3s albedo = lobe_albedo(&material, glms_vec3_normalize(n), to_viewer);
        for (uint32_t c = 0; c < 3; c++) {
            const double radiance = (double)m->emissive.raw[c] / (1.0 - (double)reflectance.raw[c]);
            const double ratio = (double)specular[3 * i + c] / (radiance * (double)albedo.raw[c]);
            out.sum += ratio;
            out.worst = fmax(out.worst, fabs(ratio - 1.0));
            out.count++;
        }
    }
    free(specular);
    free(normal);
    return out;
}

static struct errors furnace(struct gpu *gpu, const char *technique, const struct material *m)
{
    struct frame_fixture s;
    char text[TEXT];
    fixture_init(&s, gpu);
    const int material = fixture_material(&s, m);
    fixture_box(&s, vec3_of(-2, 0, -2), vec3_of(2, 3, 2), true, material);
    fixture_box(&s, vec3_of(-0.3f, 0.6f, -0.7f), vec3_of(0.7f, 1.4f, 0.3f), false, material);
    fixture_look(&s, vec3_of(-1.5f, 1.5f, 1.5f), vec3_of(1, 1, -1));
    snprintf(text, sizeof text, "%s" DICTIONARY, technique);
    fixture_open(&s);
    struct gi *gi = gi_fixture_light(&s, text);
    fixture_render(&s);
    const struct errors out = furnace_errors(&s, m);
    gi_destroy(gi);
    fixture_finish(&s);
    return out;
}

// Light that is the same from everywhere has no vector along a surface. The mean and the largest
// difference are those of irradiance in the same room (test_frame.c).
TEST_GPU(mrt_lobes_reflect_uniform_light_by_their_albedo)
{
    const struct material materials[] = {
        furnace_material(vec3_of(0.7f, 0.5f, 0.3f), 1, 0.1f),
        furnace_material(vec3_of(0.7f, 0.5f, 0.3f), 1, 0.5f),
        furnace_material(vec3_of(0.5f, 0.5f, 0.5f), 0, 0.3f),
        furnace_material(vec3_of(0.5f, 0.5f, 0.5f), 0, 1),
    };
    static const char *const techniques[] = { "mrt", "drt" };
    for (size_t i = 0; i < 8; i++) {
        const struct material *m = &materials[i / 2];
        const struct errors e = furnace(gpu, techniques[i % 2], m);
        print_message("%s, metallic %.0f, roughness %.1f: mean %.3f, at most %.1f %% from it\n",
                      techniques[i % 2], (double)m->metallic, (double)m->roughness, e.sum / e.count,
                      100.0 * e.worst);
        CHECK_NEAR(e.sum / e.count, 1.0, 0.01);
        CHECK(e.worst < 0.06);
    }
}

// ---- light from one side

enum side_light { BOUNCE, PANEL, SKY };

// At the wall −x: light that bounces, an emissive panel, or the sky in its place.
static void light_side(struct frame_fixture *s, enum side_light light)
{
    if (light == BOUNCE)
        fixture_add_spot(s, vec3_of(0, 1.5f, 0), vec3_of(-1, 0, 0), 0.4f, 0.6f,
                         vec3_of(100, 100, 100));
    if (light == PANEL)
        fixture_quad(s, vec3_of(-1.98f, 0.5f, 1), vec3_of(-1.98f, 0.5f, -1), vec3_of(-1.98f, 2, -1),
                     vec3_of(-1.98f, 2, 1), fixture_emissive(s, 0, 100));
    if (light == SKY) s->input.environment.sky = vec3_of(100, 100, 100);
}

// Without the wall −x.
static void add_open_room(struct frame_fixture *s)
{
    const int grey = fixture_matte(s, vec3_of(0.5f, 0.5f, 0.5f));
    const struct box3 walls[] = { { vec3_of(-2, -0.1f, -2), vec3_of(2.1f, 0, 2) },
                                  { vec3_of(-2, 3, -2), vec3_of(2.1f, 3.1f, 2) },
                                  { vec3_of(2, 0, -2), vec3_of(2.1f, 3, 2) },
                                  { vec3_of(-2, -0.1f, -2.1f), vec3_of(2.1f, 3.1f, -2) },
                                  { vec3_of(-2, -0.1f, 2), vec3_of(2.1f, 3.1f, 2.1f) } };
    for (int i = 0; i < 5; i++) fixture_box(s, walls[i].min, walls[i].max, false, grey);
}

// Radiance that a metal floor reflects to a camera at x, from light at the wall −x.
static double seen_from(struct gpu *gpu, enum side_light light, const char *options,
                        float roughness, float x)
{
    struct frame_fixture s;
    char text[TEXT];
    struct material metal = furnace_material(vec3_of(1, 1, 1), 1, roughness);
    metal.emissive = vec3_of(0, 0, 0);
    fixture_init(&s, gpu);
    if (light == SKY)
        add_open_room(&s);
    else
        fixture_box(
            &s, vec3_of(-2, 0, -2), vec3_of(2, 3, 2), true,
            fixture_matte(&s, light == PANEL ? vec3_of(0, 0, 0) : vec3_of(0.5f, 0.5f, 0.5f)));
    fixture_quad(&s, vec3_of(-1.99f, 0.01f, 1.99f), vec3_of(1.99f, 0.01f, 1.99f),
                 vec3_of(1.99f, 0.01f, -1.99f), vec3_of(-1.99f, 0.01f, -1.99f),
                 fixture_material(&s, &metal));
    light_side(&s, light);
    fixture_look(&s, vec3_of(x, 1, 0), vec3_of(0, 0.01f, 0));
    snprintf(text, sizeof text, "mrt" DICTIONARY "%s", options);
    fixture_open(&s);
    struct gi *gi = gi_fixture_light(&s, text);
    fixture_render(&s);
    const double seen = (double)fixture_pixel(&s, READ_SPECULAR, s.width / 2, s.height / 2).x;
    gi_destroy(gi);
    fixture_finish(&s);
    return seen;
}

// By vector irradiance alone: polished metal reflects the mean radiance, and so does a light map
// without it.
TEST_GPU(mrt_lobes_reflect_the_side_that_light_comes_from)
{
    const double towards = seen_from(gpu, BOUNCE, "", 0.4f, 1),
                 away = seen_from(gpu, BOUNCE, "", 0.4f, -1);
    print_message("towards the lit wall %.2f cd/m2, away from it %.2f\n", towards, away);
    CHECK(towards > 1.5 * away && away > 0.0);
    const double mean = seen_from(gpu, BOUNCE, ",vector=false", 0.4f, 1);
    // The middles of both pixels are 2.5 cm apart, over which light from the wall falls by 2 %.
    static const double BOTH = 0.03;
    CHECK_RELATIVE(mean, seen_from(gpu, BOUNCE, ",vector=false", 0.4f, -1), BOTH);
    CHECK(mean > away && mean < towards);
    CHECK_RELATIVE(seen_from(gpu, BOUNCE, "", 0, 1), seen_from(gpu, BOUNCE, "", 0, -1), BOTH);
    CHECK(seen_from(gpu, BOUNCE, ",specular=false", 0.4f, 1) == 0.0);
}

// Light that texels receive straight has a direction, too.
TEST_GPU(mrt_lobes_reflect_the_side_of_emitters_and_the_sky)
{
    for (enum side_light light = PANEL; light <= SKY; light++) {
        const double towards = seen_from(gpu, light, "", 0.4f, 1),
                     away = seen_from(gpu, light, "", 0.4f, -1);
        print_message("%s: towards it %.2f cd/m2, away from it %.2f\n",
                      light == SKY ? "sky" : "panel", towards, away);
        CHECK(towards > 1.5 * away);
    }
}

// ---- a panel in a black room

// E and V along x at the middle of the floor: integrals over the panel of light_side, of
// radiance 1.
static void integrate_panel(vec3s at, double *irradiance, double *along)
{
    enum { PARTS = 200 };
    *irradiance = *along = 0.0;
    for (int i = 0; i < PARTS * PARTS; i++) {
        const vec3s point = vec3_of(-1.98f, 0.5f + 1.5f * ((float)(i % PARTS) + 0.5f) / PARTS,
                                    -1.0f + 2.0f * ((float)(i / PARTS) + 0.5f) / PARTS);
        const vec3s way = glms_vec3_sub(point, at), to = glms_vec3_normalize(way);
        const double area = 1.5 * 2.0 / (PARTS * PARTS);
        const double solid_angle = -(double)to.x * area / (double)glms_vec3_norm2(way);
        *irradiance += (double)to.y * solid_angle;
        *along += (double)to.x * solid_angle;
    }
}

// I1(x) / x.
static double bessel_over_x(double x)
{
    double term = 0.5, sum = 0.0;
    for (int k = 1; k < 60; k++) {
        sum += term;
        term *= 0.25 * x * x / (k * (k + 1.0));
    }
    return sum;
}

// b for which light of radiance exp(b·t) has this vector irradiance along the surface, over its
// irradiance. By integration over the hemisphere they are 2π (b cosh b − sinh b)/b² and
// 2π I1(b)/b.
static double exponent_of(double ratio)
{
    double low = 1e-3, high = 4.0;
    for (int i = 0; i < 60; i++) {
        const double b = 0.5 * (low + high);
        const double along = (b * cosh(b) - sinh(b)) / (b * b);
        *(along < ratio * bessel_over_x(b) ? &low : &high) = b;
    }
    return low;
}

// A lobe has the radiance of an exponential of the direction, less steep by lobe_lean.
TEST_GPU(mrt_lobes_reflect_a_panel_by_its_vector_irradiance)
{
    const float roughness = 0.4f, alpha = roughness * roughness;
    const struct material metal = furnace_material(vec3_of(1, 1, 1), 1, roughness);
    const struct bsdf_material material = bsdf_material_of(&metal);
    const double lean = (1.0 - (double)alpha) / (1.0 + 1.2 * (double)(alpha * alpha));
    const vec3s at = vec3_of(0, 0.01f, 0);
    double irradiance, along;
    integrate_panel(at, &irradiance, &along);
    const double b = lean * exponent_of(fabs(along) / irradiance);
    for (int side = -1; side <= 1; side += 2) {
        const vec3s v = glms_vec3_normalize(glms_vec3_sub(vec3_of((float)side, 1, 0), at));
        const double albedo = (double)lobe_albedo(&material, vec3_of(0, 1, 0), v).x;
        const double mean = 100.0 * irradiance / GLM_PI * albedo;
        const double expected = mean * exp(b * (double)v.x) / (2.0 * bessel_over_x(b));
        const double seen = seen_from(gpu, PANEL, ",bounces=1", roughness, (float)side);
        print_message("from x = %d: %.3f cd/m2, expected %.3f\n", side, seen, expected);
        CHECK_NEAR(seen, expected, 0.1 * mean);
    }
}
