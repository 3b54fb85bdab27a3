// BSDF samplers against their densities, reciprocity, energy conservation.
#include "framework/test.h"

#include "core/rng.h"
#include "trace/bsdf.h"

#include <math.h>

static const double PI = 3.14159265358979323846;

static vec3s viewer_at(float cos_v)
{
    return vec3_of(0.6f * sqrtf(1 - cos_v * cos_v), 0.8f * sqrtf(1 - cos_v * cos_v), cos_v);
}

static struct bsdf_material material_of(vec3s albedo, float metallic, float roughness)
{
    return (struct bsdf_material){
        .albedo = albedo,
        .metallic = metallic,
        .roughness = roughness,
        .dielectric_f0 = vec3_of(0.04f, 0.04f, 0.04f),
        .dielectric_f90 = 1,
    };
}

static struct bsdf make(float cos_v, float metallic, float roughness)
{
    const struct bsdf_material m = material_of(vec3_of(0.8f, 0.5f, 0.3f), metallic, roughness);
    return bsdf_of(vec3_of(0, 0, 1), viewer_at(cos_v), &m, false);
}

enum { Z_BINS = 16, PHI_BINS = 24, BINS = Z_BINS * PHI_BINS };

static vec3s direction(double z, double phi)
{
    double r = sqrt(fmax(0, 1 - z * z));
    return vec3_of((float)(r * cos(phi)), (float)(r * sin(phi)), (float)z);
}

// Integral of the pdf over each bin of the sphere.
static void integrate(const struct bsdf *b, double expected[BINS])
{
    enum { FINE = 24 };
    for (int i = 0; i < BINS; i++) {
        double sum = 0;
        for (int k = 0; k < FINE * FINE; k++) {
            double z = ((i / PHI_BINS) + (k / FINE + 0.5) / FINE) / Z_BINS * 2 - 1;
            double phi = ((i % PHI_BINS) + (k % FINE + 0.5) / FINE) / PHI_BINS * 2 * PI;
            sum += (double)bsdf_reflect(b, direction(z, phi)).pdf;
        }
        expected[i] = sum / (FINE * FINE) * 4 * PI / BINS;
    }
}

static void check_sampler(const struct bsdf *b)
{
    enum { SAMPLES = 200000 };
    double expected[BINS], total = 0, chi2 = 0;
    int counts[BINS] = { 0 }, freedom = -1, rest_count = 0;
    double rest = 0;
    integrate(b, expected);
    for (uint32_t i = 0; i < SAMPLES; i++) {
        struct rng rng = rng_for(7, i, 3);
        float choice = rng_float(&rng);
        vec3s d = bsdf_sample(b, choice, rng_vec2(&rng));
        CHECK_NEAR(glms_vec3_norm(d), 1, 1e-4);
        double turns = atan2((double)d.y, (double)d.x) / (2 * PI);
        int z = (int)fmin(((double)d.z + 1) / 2 * Z_BINS, Z_BINS - 1);
        int phi = (int)fmin((turns < 0 ? turns + 1 : turns) * PHI_BINS, PHI_BINS - 1);
        counts[z * PHI_BINS + phi]++;
    }
    for (int i = 0; i < BINS; i++) {
        double e = expected[i] * SAMPLES;
        total += expected[i];
        if (e < 20) { // too few for the statistic: pooled in one bin
            rest += e;
            rest_count += counts[i];
            continue;
        }
        chi2 += (counts[i] - e) * (counts[i] - e) / e;
        freedom++;
    }
    CHECK_NEAR(total, 1, 2e-3);
    CHECK_NEAR(rest_count, rest, 5 * sqrt(rest) + 10);
    // 4.5 standard deviations of the chi-square distribution, plus 0.1 % for the quadrature of the
    // bins.
    double slack = 1e-6 * SAMPLES * BINS / 10;
    CHECK(chi2 < freedom + 4.5 * sqrt(2.0 * freedom) + slack);
}

TEST(samples_follow_their_density)
{
    static const float cosines[] = { 0.95f, 0.5f, 0.15f };
    static const float roughness[] = { 0.5f, 0.75f, 1.0f };
    for (int i = 0; i < 9; i++) {
        struct bsdf dielectric = make(cosines[i % 3], 0, roughness[i / 3]);
        struct bsdf metal = make(cosines[i % 3], 1, roughness[i / 3]);
        check_sampler(&dielectric);
        check_sampler(&metal);
        bsdf_reserve_diffuse_samples(&metal, 0.25f);
        check_sampler(&metal);
    }
}

// The single-scattering lobe is. Its compensation and the diffuse lobe depend on one direction by
// design: they are divided out.
TEST(the_specular_lobe_without_compensation_is_reciprocal)
{
    for (uint32_t i = 0; i < 1000; i++) {
        struct rng rng = rng_for(1, i, 0);
        vec3s a =
            direction((double)rng_float(&rng) * 0.99 + 0.01, (double)rng_float(&rng) * 2 * PI);
        vec3s b =
            direction((double)rng_float(&rng) * 0.99 + 0.01, (double)rng_float(&rng) * 2 * PI);
        vec3s n = vec3_of(0, 0, 1);
        struct bsdf_material m = material_of(vec3_of(0.9f, 0.5f, 0.1f), 1, rng_float(&rng));
        struct bsdf from_a = bsdf_of(n, a, &m, false);
        struct bsdf from_b = bsdf_of(n, b, &m, false);
        vec3s ab = bsdf_reflect(&from_a, b).f, ba = bsdf_reflect(&from_b, a).f;
        for (int c = 0; c < 3; c++)
            CHECK_RELATIVE(ab.raw[c] / from_a.f90.raw[c], ba.raw[c] / from_b.f90.raw[c], 1e-3);
    }
}

// Smoothstep: denser near 0 and 1, with its derivative.
static double dense_at_ends(double t, double *derivative)
{
    *derivative = 6 * t * (1 - t);
    return t * t * (3 - 2 * t);
}

// Reflected over incident radiance in a uniform environment. The specular lobe is integrated over
// its own samples: with D cancelled by the density the integrand is smooth at any roughness.
// Visible normals are steep at the rim of the disk, which is the edge of the unit square.
static vec3s furnace(const struct bsdf *b)
{
    enum { STEPS = 160 };
    double sum[3] = { 0 };
    struct bsdf specular = *b;
    specular.diffuse = vec3_of(0, 0, 0);
    specular.specular_probability = 1;
    for (int i = 0; i < STEPS * STEPS && b->specular_probability > 0; i++) {
        double weight[2];
        vec2s u;
        u.x = (float)dense_at_ends((i / STEPS + 0.5) / STEPS, &weight[0]);
        u.y = (float)dense_at_ends((i % STEPS + 0.5) / STEPS, &weight[1]);
        vec3s d = bsdf_sample(&specular, 0, u);
        struct reflection r = bsdf_reflect(&specular, d);
        double scale = weight[0] * weight[1] / (STEPS * STEPS);
        if (d.z > 0 && r.pdf > 0)
            for (int c = 0; c < 3; c++) sum[c] += scale * (double)(r.f.raw[c] * d.z / r.pdf);
    }
    for (int c = 0; c < 3; c++) sum[c] += PI * (double)b->diffuse.raw[c];
    return vec3_of((float)sum[0], (float)sum[1], (float)sum[2]);
}

static const float furnace_cosines[] = { 1, 0.9f, 0.7f, 0.5f, 0.3f, 0.2f, 0.1f, 0.05f, 0.02f };
enum { FURNACE_COSINES = sizeof furnace_cosines / sizeof *furnace_cosines, ROUGHNESSES = 21 };

TEST(white_materials_reflect_all_light_at_any_roughness_and_angle)
{
    double least = 2, most = 0;
    for (int i = 0; i < ROUGHNESSES * FURNACE_COSINES; i++) {
        for (int metallic = 0; metallic <= 2; metallic++) {
            float roughness = (float)(i / FURNACE_COSINES) / (ROUGHNESSES - 1);
            struct bsdf_material m =
                material_of(vec3_of(1, 1, 1), 0.5f * (float)metallic, roughness);
            struct bsdf b = bsdf_of(vec3_of(0, 0, 1),
                                    viewer_at(furnace_cosines[i % FURNACE_COSINES]), &m, false);
            double reflected = (double)furnace(&b).y;
            CHECK_NEAR(reflected, 1, 0.005);
            CHECK(reflected < 1.002);
            least = fmin(least, reflected);
            most = fmax(most, reflected);
        }
    }
    print_message("reflected over incident: %.5f to %.5f\n", least, most);
}

// Any F0, F90 and colour: the sum of all lobes never exceeds the incident light.
TEST(no_material_reflects_more_than_it_receives)
{
    for (uint32_t i = 0; i < 200; i++) {
        struct rng rng = rng_for(4, i, 0);
        struct bsdf_material m = material_of(vec3_of(rng_float(&rng), 1, rng_float(&rng)),
                                             rng_float(&rng), rng_float(&rng));
        m.dielectric_f90 = rng_float(&rng);
        for (int c = 0; c < 3; c++) m.dielectric_f0.raw[c] = m.dielectric_f90 * rng_float(&rng);
        struct bsdf b =
            bsdf_of(vec3_of(0, 0, 1), viewer_at(0.02f + 0.98f * rng_float(&rng)), &m, false);
        vec3s reflected = furnace(&b);
        for (int c = 0; c < 3; c++) CHECK(reflected.raw[c] < 1.002f);
    }
}

TEST(a_dielectric_without_specular_weight_reflects_exactly_its_albedo)
{
    for (int i = 0; i < ROUGHNESSES * FURNACE_COSINES; i++) {
        struct bsdf_material m = material_of(vec3_of(1, 0.5f, 0.25f), 0,
                                             (float)(i / FURNACE_COSINES) / (ROUGHNESSES - 1));
        m.dielectric_f0 = vec3_of(0, 0, 0);
        m.dielectric_f90 = 0;
        struct bsdf b =
            bsdf_of(vec3_of(0, 0, 1), viewer_at(furnace_cosines[i % FURNACE_COSINES]), &m, false);
        CHECK(b.specular_probability == 0);
        for (int c = 0; c < 3; c++) {
            CHECK(b.diffuse.raw[c] == m.albedo.raw[c] * BSDF_INV_PI);
            CHECK(bsdf_reflect(&b, direction(0.3, 1)).f.raw[c] == b.diffuse.raw[c]);
        }
    }
}

// The mean of f cosθ / pdf over samples equals the integral of f cosθ: the directional albedo.
TEST(importance_sampling_and_uniform_integration_agree_on_the_albedo)
{
    static const float roughness[] = { 0.4f, 0.7f, 1.0f };
    for (int i = 0; i < 3; i++) {
        struct bsdf b = make(0.6f, 0.3f, roughness[i]);
        double sampled = 0, plain = 0;
        enum { SAMPLES = 200000, STEPS = 400 };
        for (uint32_t k = 0; k < SAMPLES; k++) {
            struct rng rng = rng_for(5, k, 1);
            float choice = rng_float(&rng);
            vec3s d = bsdf_sample(&b, choice, rng_vec2(&rng));
            struct reflection r = bsdf_reflect(&b, d);
            if (d.z > 0) sampled += (double)(r.f.y * d.z / r.pdf) / SAMPLES;
        }
        for (int k = 0; k < STEPS * STEPS; k++) {
            double z = (k / STEPS + 0.5) / STEPS, phi = (k % STEPS + 0.5) / STEPS * 2 * PI;
            plain += (double)bsdf_reflect(&b, direction(z, phi)).f.y * z * 2 * PI / (STEPS * STEPS);
        }
        CHECK_RELATIVE(sampled, plain, 0.004);
    }
}

TEST(light_from_below_the_horizon_is_not_reflected)
{
    struct bsdf b = make(0.5f, 0.5f, 0.5f);
    for (int i = 1; i < 10; i++) {
        vec3s f = bsdf_reflect(&b, direction(-0.1 * i, i)).f;
        CHECK(f.x == 0 && f.y == 0 && f.z == 0);
    }
}
