// The environment: its parts agree with each other.
#include "framework/test.h"

#include "core/sh.h"
#include "scene/environment.h"

static const double PI = 3.14159265358979;

static const vec3s DIRECTIONS[] = { { { 1, 0, 0 } },
                                    { { 0, -1, 0 } },
                                    { { 0.36f, 0.48f, -0.8f } } };

TEST(spherical_harmonics_have_the_radiance_and_the_irradiance)
{
    const struct environment environment = { .sky = vec3_of(3, 5, 7) };
    vec3s coefficients[9];
    environment_sh9(&environment, coefficients);
    for (size_t d = 0; d < sizeof DIRECTIONS / sizeof *DIRECTIONS; d++) {
        const vec3s radiance = environment_radiance(&environment, DIRECTIONS[d]);
        for (int c = 0; c < 3; c++) {
            float of_colour[9], irradiance[9];
            for (int i = 0; i < 9; i++) of_colour[i] = coefficients[i].raw[c];
            sh_irradiance(3, of_colour, irradiance);
            CHECK_RELATIVE(sh_dot(3, of_colour, DIRECTIONS[d]), radiance.raw[c], 1e-6);
            CHECK_RELATIVE(sh_dot(3, irradiance, DIRECTIONS[d]), PI * (double)radiance.raw[c],
                           1e-6);
            CHECK_RELATIVE(radiance.raw[c], environment_mean(&environment).raw[c], 1e-6);
        }
    }
}
