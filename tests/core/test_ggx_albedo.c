// The table of the GGX lobe's directional albedo against an integration over incident directions.
#include "framework/test.h"

#include "core/ggx_albedo.h"
#include "core/rng.h"

#include <math.h>

static const double PI = 3.14159265358979323846;

// Midpoint rule over incident directions with n·l = x², dense near the horizon, where G2 is steep.
// For rough lobes, which the grid resolves.
static void integrate(double cosine, double alpha, double out[2])
{
    enum { STEPS = 1000 };
    const double sine = sqrt(1 - cosine * cosine), a2 = alpha * alpha;
    out[0] = out[1] = 0;
    for (int i = 0; i < STEPS; i++) {
        const double x = (i + 0.5) / STEPS, z = x * x, r = sqrt(1 - z * z);
        for (int k = 0; k < STEPS; k++) {
            const double phi = PI * (k + 0.5) / STEPS; // the other half is symmetric
            const double h[3] = { r * cos(phi) + sine, r * sin(phi), z + cosine };
            const double length2 = h[0] * h[0] + h[1] * h[1] + h[2] * h[2];
            const double n_h2 = h[2] * h[2] / length2;
            const double v_h = (sine * h[0] + cosine * h[2]) / sqrt(length2);
            const double base = n_h2 * (a2 - 1) + 1, d = a2 / (PI * base * base);
            const double v = 0.5 / (z * sqrt(cosine * cosine * (1 - a2) + a2) +
                                    cosine * sqrt(z * z * (1 - a2) + a2));
            const double s = pow(1 - v_h, 5), f = d * v * z * 4 * PI * x / (STEPS * STEPS);
            out[0] += f * (1 - s);
            out[1] += f * s;
        }
    }
}

TEST(interpolated_albedo_is_within_a_thousandth)
{
    double worst = 0;
    for (uint32_t i = 0; i < 40; i++) {
        struct rng rng = rng_for(3, i, 0);
        const float u = rng_float(&rng), roughness = 0.3f + 0.7f * rng_float(&rng);
        const float cosine = i % 2 ? 0.01f + 0.99f * u : 0.01f + 0.2f * u * u;
        double expected[2];
        integrate((double)cosine, (double)roughness * (double)roughness, expected);
        const struct ggx_albedo e = ggx_albedo_at(cosine, roughness);
        const double ess = expected[0] + expected[1];
        CHECK_RELATIVE(e.a + e.b, ess, 1e-3);
        CHECK_NEAR(e.b, expected[1], 1e-3);
        worst = fmax(worst, fabs(((double)e.a + (double)e.b) / ess - 1));
    }
    print_message("largest relative error of Ess: %.5f\n", worst);
}

TEST(single_scattering_loses_energy_and_gains_none)
{
    for (int i = 0; i <= 100; i++)
        for (int j = 0; j <= 100; j++) {
            const float roughness = GGX_MIN_ROUGHNESS + (1 - GGX_MIN_ROUGHNESS) * (float)j / 100.0f;
            const struct ggx_albedo e = ggx_albedo_at((float)i / 100.0f, roughness);
            CHECK(e.a >= 0 && e.b >= 0 && e.a + e.b <= 1.00005f && e.a + e.b > 0.3f);
        }
}

// A mirror: A = 1 − (1 − μ)⁵ and B = (1 − μ)⁵.
TEST(a_smooth_lobe_has_the_albedo_of_a_mirror)
{
    for (int i = 10; i <= 100; i++) {
        const float mu = (float)i / 100.0f;
        const struct ggx_albedo e = ggx_albedo_at(mu, GGX_MIN_ROUGHNESS);
        CHECK_NEAR(e.b, pow(1 - (double)mu, 5), 1.5e-3);
        CHECK_NEAR(e.a + e.b, 1, 1e-3);
    }
}
