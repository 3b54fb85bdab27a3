// Spherical harmonics against quadrature and pointwise evaluation.
#include "framework/test.h"

#include "core/quadrature.h"

#include "core/rng.h"
#include "core/sampling.h"
#include "core/sh.h"

#include <math.h>
#include <string.h>

static const double PI = 3.14159265358979323846;

static vec3s direction_of_point(int p, double low, double high, double *weight)
{
    double d[3];
    *weight = quadrature_point(p, low, high, d);
    return vec3_of((float)d[0], (float)d[1], (float)d[2]);
}

static void random_coefficients(struct rng *rng, int bands, float *out)
{
    memset(out, 0, SH_MAX_COUNT * sizeof *out);
    for (int i = 0; i < SH_COUNT(bands); i++) out[i] = 2.0f * rng_float(rng) - 1.0f;
}

// Uniform over all rotations (Shoemake 1992).
static mat3s random_rotation(struct rng *rng)
{
    float u = rng_float(rng), a = 6.2831853f * rng_float(rng), b = 6.2831853f * rng_float(rng);
    float s = sqrtf(1.0f - u), t = sqrtf(u);
    versors q = { { s * sinf(a), s * cosf(a), t * sinf(b), t * cosf(b) } };
    return glms_quat_mat3(q);
}

TEST(first_nine_functions_are_the_known_polynomials_in_order)
{
    struct rng rng = rng_for(1, 0, 0);
    for (int k = 0; k < 50; k++) {
        vec3s d = sample_sphere(rng_vec2(&rng));
        double x = (double)d.x, y = (double)d.y, z = (double)d.z, sh1 = sqrt(3.0 / (4.0 * PI));
        double sh2 = sqrt(15.0 / (4.0 * PI));
        double known[9] = { sqrt(1.0 / (4.0 * PI)),
                            sh1 * y,
                            sh1 * z,
                            sh1 * x,
                            sh2 * x * y,
                            sh2 * y * z,
                            sqrt(5.0 / (16.0 * PI)) * (3.0 * z * z - 1.0),
                            sh2 * x * z,
                            sh2 / 2.0 * (x * x - y * y) };
        float values[9];
        sh_eval(3, d, values);
        for (int i = 0; i < 9; i++) CHECK_NEAR(values[i], known[i], 1e-6);
    }
}

// A point of light: its windowed projection has the same mean, and less than a third of the
// ringing.
TEST(a_window_reduces_ringing)
{
    enum { BANDS = 5 };
    const vec3s to_light = glms_vec3_normalize(vec3_of(1, 2, -3));
    struct rng rng = rng_for(7, 0, 0);
    float plain[SH_MAX_COUNT], windowed[SH_MAX_COUNT], least = 0.0f, least_windowed = 0.0f;
    sh_eval(BANDS, to_light, plain);
    for (int band = 0, i = 0; band < BANDS; band++)
        for (; i < SH_COUNT(band + 1); i++) windowed[i] = plain[i] * sh_window(band, BANDS);
    for (int k = 0; k < 2000; k++) {
        const vec3s d = sample_sphere(rng_vec2(&rng));
        least = fminf(least, sh_dot(BANDS, plain, d));
        least_windowed = fminf(least_windowed, sh_dot(BANDS, windowed, d));
    }
    CHECK(windowed[0] == plain[0] && sh_window(3, 3.0f) == 0.0f && sh_window(3, 0.0f) == 1.0f);
    CHECK(least < 0.0f && least_windowed > least / 3.0f);
}

TEST(functions_are_orthonormal_to_order_five)
{
    double sum[SH_MAX_COUNT][SH_MAX_COUNT] = { { 0.0 } };
    for (int p = 0; p < QUADRATURE_POINTS; p++) {
        double weight;
        float y[SH_MAX_COUNT];
        sh_eval(SH_MAX_BANDS, direction_of_point(p, -1.0, 1.0, &weight), y);
        for (int i = 0; i < SH_MAX_COUNT; i++)
            for (int j = 0; j < SH_MAX_COUNT; j++)
                sum[i][j] += weight * (double)y[i] * (double)y[j];
    }
    for (int i = 0; i < SH_MAX_COUNT; i++)
        for (int j = 0; j < SH_MAX_COUNT; j++) CHECK_NEAR(sum[i][j], i == j ? 1.0 : 0.0, 2e-6);
}

TEST(fewer_bands_are_a_prefix_of_more)
{
    float all[SH_MAX_COUNT];
    vec3s d = sample_sphere((vec2s){ { 0.3f, 0.6f } });
    sh_eval(SH_MAX_BANDS, d, all);
    for (int bands = 1; bands <= SH_MAX_BANDS; bands++) {
        float some[SH_MAX_COUNT + 1];
        for (int i = 0; i <= SH_MAX_COUNT; i++) some[i] = -77.0f;
        sh_eval(bands, d, some);
        assert_memory_equal(some, all, (size_t)SH_COUNT(bands) * sizeof(float));
        CHECK(some[SH_COUNT(bands)] == -77.0f);
    }
}

TEST(addition_theorem_holds_in_each_band)
{
    // Σ_m Y_lm(a) Y_lm(b) = (2l+1)/4π P_l(a·b): checks signs, scales and completeness of a band.
    struct rng rng = rng_for(2, 0, 0);
    for (int k = 0; k < 50; k++) {
        vec3s a = sample_sphere(rng_vec2(&rng)), b = sample_sphere(rng_vec2(&rng));
        float ya[SH_MAX_COUNT], yb[SH_MAX_COUNT];
        sh_eval(SH_MAX_BANDS, a, ya);
        sh_eval(SH_MAX_BANDS, b, yb);
        double t = (double)glms_vec3_dot(a, b), before = 0.0, legendre = 1.0;
        for (int l = 0; l < SH_MAX_BANDS; l++) {
            double sum = 0.0;
            for (int i = l * l; i < (l + 1) * (l + 1); i++) sum += (double)ya[i] * (double)yb[i];
            CHECK_NEAR(sum, (2 * l + 1) / (4.0 * PI) * legendre, 5e-6);
            double next = ((2 * l + 1) * t * legendre - l * before) / (l + 1);
            before = legendre;
            legendre = next;
        }
    }
}

TEST(dot_is_the_sum_of_coefficients_times_functions)
{
    struct rng rng = rng_for(3, 0, 0);
    for (int bands = 1; bands <= SH_MAX_BANDS; bands++) {
        float c[SH_MAX_COUNT], y[SH_MAX_COUNT];
        random_coefficients(&rng, SH_MAX_BANDS, c);
        vec3s d = sample_sphere(rng_vec2(&rng));
        sh_eval(bands, d, y);
        double sum = 0.0;
        for (int i = 0; i < SH_COUNT(bands); i++) sum += (double)c[i] * (double)y[i];
        CHECK_NEAR(sh_dot(bands, c, d), sum, 1e-5);
    }
}

TEST(clamped_cosine_has_its_zonal_coefficients_by_quadrature)
{
    float zonal[SH_MAX_BANDS];
    zh_clamped_cosine(SH_MAX_BANDS, zonal);
    for (int l = 0; l < SH_MAX_BANDS; l++) {
        double sum = 0.0;
        for (int p = 0; p < QUADRATURE_POINTS; p++) {
            double weight;
            float y[SH_MAX_COUNT];
            vec3s d = direction_of_point(p, 0.0, 1.0, &weight);
            sh_eval(SH_MAX_BANDS, d, y);
            sum += weight * (double)d.z * (double)y[l * (l + 1)];
        }
        CHECK_NEAR(zonal[l], sum, 1e-6);
    }
    CHECK_NEAR(zonal[0], sqrt(PI) / 2.0, 1e-6);
    CHECK_NEAR(zonal[1], sqrt(PI / 3.0), 1e-6);
    CHECK_NEAR(zonal[2], sqrt(5.0 * PI) / 8.0, 1e-6);
    CHECK_NEAR(zonal[3], 0.0, 0.0);
}

TEST(rotated_zonal_function_depends_on_the_angle_alone)
{
    struct rng rng = rng_for(4, 0, 0);
    float zonal[SH_MAX_BANDS] = { 0.9f, -0.3f, 0.5f, 0.2f, -0.7f, 0.4f };
    float upright[SH_MAX_COUNT] = { 0.0f };
    for (int l = 0; l < SH_MAX_BANDS; l++) upright[l * (l + 1)] = zonal[l];
    for (int k = 0; k < 50; k++) {
        vec3s axis = sample_sphere(rng_vec2(&rng)), d = sample_sphere(rng_vec2(&rng));
        float rotated[SH_MAX_COUNT];
        zh_rotate(SH_MAX_BANDS, zonal, axis, rotated);
        float t = glms_vec3_dot(axis, d);
        vec3s same_angle = vec3_of(sqrtf(fmaxf(0.0f, 1.0f - t * t)), 0.0f, t);
        CHECK_NEAR(sh_dot(SH_MAX_BANDS, rotated, d), sh_dot(SH_MAX_BANDS, upright, same_angle),
                   2e-5);
    }
}

TEST(irradiance_weights_are_those_of_the_clamped_cosine)
{
    static const double weights[SH_MAX_BANDS] = {
        PI, 2.0 * PI / 3.0, PI / 4.0, 0.0, -PI / 24.0, 0.0
    };
    float ones[SH_MAX_COUNT], out[SH_MAX_COUNT];
    for (int i = 0; i < SH_MAX_COUNT; i++) ones[i] = 1.0f;
    sh_irradiance(SH_MAX_BANDS, ones, out);
    for (int l = 0; l < SH_MAX_BANDS; l++)
        for (int i = l * l; i < (l + 1) * (l + 1); i++) CHECK_NEAR(out[i], weights[l], 1e-6);
}

TEST(irradiance_is_the_cosine_weighted_integral_over_the_hemisphere)
{
    struct rng rng = rng_for(5, 0, 0);
    for (int k = 0; k < 20; k++) {
        float radiance[SH_MAX_COUNT], irradiance[SH_MAX_COUNT];
        random_coefficients(&rng, SH_MAX_BANDS, radiance);
        sh_irradiance(SH_MAX_BANDS, radiance, irradiance);
        vec3s n = sample_sphere(rng_vec2(&rng)), tangent, bitangent;
        basis_of(n, &tangent, &bitangent);
        mat3s world_from_local = { .col = { tangent, bitangent, n } };
        double sum = 0.0;
        for (int p = 0; p < QUADRATURE_POINTS; p++) {
            double weight;
            vec3s d = direction_of_point(p, 0.0, 1.0, &weight);
            float l = sh_dot(SH_MAX_BANDS, radiance, glms_mat3_mulv(world_from_local, d));
            sum += weight * (double)d.z * (double)l;
        }
        CHECK_NEAR(sh_dot(SH_MAX_BANDS, irradiance, n), sum, 1e-5);
    }
}

TEST(convolution_is_the_integral_against_the_rotated_kernel)
{
    struct rng rng = rng_for(6, 0, 0);
    float zonal[SH_MAX_BANDS] = { 0.3f, 0.8f, -0.2f, 0.6f, 0.1f, -0.5f };
    float f[SH_MAX_COUNT], convolved[SH_MAX_COUNT], kernel[SH_MAX_COUNT];
    random_coefficients(&rng, SH_MAX_BANDS, f);
    sh_convolve(SH_MAX_BANDS, f, zonal, convolved);
    for (int k = 0; k < 20; k++) {
        vec3s n = sample_sphere(rng_vec2(&rng));
        zh_rotate(SH_MAX_BANDS, zonal, n, kernel);
        double sum = 0.0;
        for (int p = 0; p < QUADRATURE_POINTS; p++) {
            double weight;
            vec3s d = direction_of_point(p, -1.0, 1.0, &weight);
            sum += weight * (double)sh_dot(SH_MAX_BANDS, f, d) *
                   (double)sh_dot(SH_MAX_BANDS, kernel, d);
        }
        CHECK_NEAR(sh_dot(SH_MAX_BANDS, convolved, n), sum, 2e-5);
    }
}

TEST(rotated_function_is_the_function_of_the_unrotated_direction)
{
    struct rng rng = rng_for(7, 0, 0);
    for (int k = 0; k < 100; k++) {
        float in[SH_MAX_COUNT], out[SH_MAX_COUNT];
        int bands = 1 + k % SH_MAX_BANDS;
        random_coefficients(&rng, bands, in);
        mat3s rotation = random_rotation(&rng);
        sh_rotate(bands, rotation, in, out);
        for (int j = 0; j < 10; j++) {
            vec3s d = sample_sphere(rng_vec2(&rng));
            CHECK_NEAR(sh_dot(bands, out, glms_mat3_mulv(rotation, d)), sh_dot(bands, in, d), 3e-5);
        }
    }
}

TEST(rotation_preserves_the_energy_of_each_band)
{
    struct rng rng = rng_for(8, 0, 0);
    for (int k = 0; k < 100; k++) {
        float in[SH_MAX_COUNT], out[SH_MAX_COUNT];
        random_coefficients(&rng, SH_MAX_BANDS, in);
        sh_rotate(SH_MAX_BANDS, random_rotation(&rng), in, out);
        for (int l = 0; l < SH_MAX_BANDS; l++) {
            double before = 0.0, after = 0.0;
            for (int i = l * l; i < (l + 1) * (l + 1); i++) {
                before += (double)in[i] * (double)in[i];
                after += (double)out[i] * (double)out[i];
            }
            CHECK_RELATIVE(after, before, 1e-5);
        }
    }
}

TEST(rotation_by_the_identity_changes_nothing)
{
    struct rng rng = rng_for(9, 0, 0);
    float in[SH_MAX_COUNT], out[SH_MAX_COUNT];
    random_coefficients(&rng, SH_MAX_BANDS, in);
    sh_rotate(SH_MAX_BANDS, glms_mat3_identity(), in, out);
    for (int i = 0; i < SH_MAX_COUNT; i++) CHECK_NEAR(out[i], in[i], 1e-6);
}

TEST(rotations_compose_as_their_matrices_do)
{
    struct rng rng = rng_for(10, 0, 0);
    for (int k = 0; k < 20; k++) {
        mat3s a = random_rotation(&rng), b = random_rotation(&rng);
        float in[SH_MAX_COUNT], once[SH_MAX_COUNT], twice[SH_MAX_COUNT], both[SH_MAX_COUNT];
        random_coefficients(&rng, SH_MAX_BANDS, in);
        sh_rotate(SH_MAX_BANDS, a, in, once);
        sh_rotate(SH_MAX_BANDS, b, once, twice);
        sh_rotate(SH_MAX_BANDS, glms_mat3_mul(b, a), in, both);
        for (int i = 0; i < SH_MAX_COUNT; i++) CHECK_NEAR(twice[i], both[i], 1e-5);
    }
}
