#include "light_values.h"

#include <math.h>

void light_black_body(float kelvin, float rgb[3])
{
    const float t = 1000.0f / kelvin;
    const float x = kelvin < 4000.0f
                        ? ((-0.2661239f * t - 0.2343589f) * t + 0.8776956f) * t + 0.179910f
                        : ((-3.0258469f * t + 2.1070379f) * t + 0.2226347f) * t + 0.240390f;
    const float y =
        kelvin < 2222.0f   ? ((-1.1063814f * x - 1.34811020f) * x + 2.18555832f) * x - 0.20219683f
        : kelvin < 4000.0f ? ((-0.9549476f * x - 1.37418593f) * x + 2.09137015f) * x - 0.16748867f
                           : ((3.0817580f * x - 5.87338670f) * x + 3.75112997f) * x - 0.37001483f;
    const float X = x / y, Z = (1.0f - x - y) / y;
    rgb[0] = fmaxf(3.2404542f * X - 1.5371385f - 0.4985314f * Z, 0.0f);
    rgb[1] = fmaxf(-0.9692660f * X + 1.8760108f + 0.0415560f * Z, 0.0f);
    rgb[2] = fmaxf(0.0556434f * X - 0.2040259f + 1.0572252f * Z, 0.0f);
    const float most = fmaxf(fmaxf(rgb[0], rgb[1]), rgb[2]);
    for (int i = 0; i < 3; i++) rgb[i] /= most;
}

void light_angles(const float direction[3], float *elevation, float *azimuth)
{
    *elevation = atan2f(-direction[1], hypotf(direction[0], direction[2]));
    *azimuth = atan2f(-direction[0], direction[2]);
}

void light_direction(float elevation, float azimuth, float direction[3])
{
    direction[0] = -cosf(elevation) * sinf(azimuth);
    direction[1] = -sinf(elevation);
    direction[2] = cosf(elevation) * cosf(azimuth);
}
