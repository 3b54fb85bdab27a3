// The environment: its parts agree with each other.
#include "framework/test.h"

#include "scene/environment.h"

static const double PI = 3.14159265358979;

static const vec3s DIRECTIONS[] = { { { 1, 0, 0 } },
                                    { { 0, -1, 0 } },
                                    { { 0.36f, 0.48f, -0.8f } } };

TEST(spherical_harmonics_have_the_radiance_and_the_irradiance)
{
    const struct environment environment = { .sky = vec3_of(3, 5, 7) };
    float coefficients[3][SH_MAX_COUNT];
    environment_sh(&environment, 3, coefficients);
    for (size_t d = 0; d < sizeof DIRECTIONS / sizeof *DIRECTIONS; d++) {
        const vec3s radiance = environment_radiance(&environment, DIRECTIONS[d]);
        for (int c = 0; c < 3; c++) {
            float irradiance[9];
            sh_irradiance(3, coefficients[c], irradiance);
            CHECK_RELATIVE(sh_dot(3, coefficients[c], DIRECTIONS[d]), radiance.raw[c], 1e-6);
            CHECK_RELATIVE(sh_dot(3, irradiance, DIRECTIONS[d]), PI * (double)radiance.raw[c],
                           1e-6);
            CHECK_RELATIVE(radiance.raw[c], environment_mean(&environment).raw[c], 1e-6);
        }
    }
}
