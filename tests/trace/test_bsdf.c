// BSDF samplers against their densities, reciprocity, directional albedo.
#include "framework/test.h"

#include "core/rng.h"
#include "trace/bsdf.h"

#include <math.h>

static const double PI = 3.14159265358979323846;

static vec3s viewer_at(float cos_v)
{
    return vec3_of(0.6f * sqrtf(1 - cos_v * cos_v), 0.8f * sqrtf(1 - cos_v * cos_v), cos_v);
}

static struct bsdf make(float cos_v, float metallic, float roughness)
{
    return bsdf_of(vec3_of(0, 0, 1), viewer_at(cos_v), vec3_of(0.8f, 0.5f, 0.3f), metallic,
                   roughness, false);
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

TEST(reflection_is_reciprocal)
{
    for (uint32_t i = 0; i < 1000; i++) {
        struct rng rng = rng_for(1, i, 0);
        vec3s a =
            direction((double)rng_float(&rng) * 0.99 + 0.01, (double)rng_float(&rng) * 2 * PI);
        vec3s b =
            direction((double)rng_float(&rng) * 0.99 + 0.01, (double)rng_float(&rng) * 2 * PI);
        vec3s albedo = vec3_of(0.9f, 0.5f, 0.1f), n = vec3_of(0, 0, 1);
        float metallic = rng_float(&rng), roughness = rng_float(&rng);
        struct bsdf from_a = bsdf_of(n, a, albedo, metallic, roughness, false);
        struct bsdf from_b = bsdf_of(n, b, albedo, metallic, roughness, false);
        vec3s ab = bsdf_reflect(&from_a, b).f, ba = bsdf_reflect(&from_b, a).f;
        for (int c = 0; c < 3; c++) CHECK_RELATIVE(ab.raw[c], ba.raw[c], 1e-3);
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
