// Colour temperatures and directions of lights in the panels.
#include "viewer/scene/light_values.h"

#include "framework/test.h"

#include <math.h>

// Chromaticity of linear Rec. 709 (IEC 61966-2-1).
static void chromaticity(const float rgb[3], double *x, double *y)
{
    static const double xyz_from_rgb[3][3] = { { 0.4124564, 0.3575761, 0.1804375 },
                                               { 0.2126729, 0.7151522, 0.0721750 },
                                               { 0.0193339, 0.1191920, 0.9503041 } };
    double xyz[3] = { 0 };
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++) xyz[i] += xyz_from_rgb[i][k] * (double)rgb[k];
    *x = xyz[0] / (xyz[0] + xyz[1] + xyz[2]);
    *y = xyz[1] / (xyz[0] + xyz[1] + xyz[2]);
}

// Wyszecki and Stiles 1982: the Planckian locus, and illuminant A (2856 K).
TEST(a_black_body_has_the_chromaticity_of_its_temperature)
{
    static const struct {
        float kelvin;
        double x, y;
    } bodies[] = { { 2500, 0.4770, 0.4137 },
                   { 2856, 0.4476, 0.4074 },
                   { 4000, 0.3805, 0.3768 },
                   { 6500, 0.3135, 0.3237 },
                   { 10000, 0.2807, 0.2884 } };
    for (size_t i = 0; i < sizeof bodies / sizeof *bodies; i++) {
        float rgb[3];
        double x, y;
        light_black_body(bodies[i].kelvin, rgb);
        chromaticity(rgb, &x, &y);
        CHECK(fmaxf(fmaxf(rgb[0], rgb[1]), rgb[2]) == 1.0f);
        if (fabs(x - bodies[i].x) > 0.002 || fabs(y - bodies[i].y) > 0.002)
            fail_msg("%g K: (%g, %g), not (%g, %g)", (double)bodies[i].kelvin, x, y, bodies[i].x,
                     bodies[i].y);
    }
}

TEST(angles_are_those_of_a_clear_sky)
{
    static const float half = 1.5707963f;
    float direction[3];
    light_direction(0.0f, 0.0f, direction); // from −z
    CHECK(fabsf(direction[2] - 1.0f) < 1e-6f);
    light_direction(0.0f, half, direction); // from +x
    CHECK(fabsf(direction[0] + 1.0f) < 1e-6f);
    light_direction(half, 1.0f, direction); // from above
    CHECK(fabsf(direction[1] + 1.0f) < 1e-6f);
}

TEST(angles_and_directions_are_inverse)
{
    for (int i = -8; i <= 8; i++)
        for (int k = -15; k <= 15; k++) {
            const float elevation = 0.19f * (float)i, azimuth = 0.2f * (float)k;
            float direction[3], e, a;
            light_direction(elevation, azimuth, direction);
            for (int c = 0; c < 3; c++) direction[c] *= 7.0f; // of any length
            light_angles(direction, &e, &a);
            if (fabsf(e - elevation) > 1e-5f || fabsf(a - azimuth) > 1e-4f)
                fail_msg("(%g, %g) gives (%g, %g)", (double)elevation, (double)azimuth, (double)e,
                         (double)a);
        }
}
