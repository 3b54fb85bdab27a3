// A clear daylight sky with its sun: Preetham, Shirley & Smits 1999, "A Practical Analytic Model
// for Daylight". Luminance and chromaticity of the sky are Perez distributions of turbidity and the
// sun's elevation (appendix A.2), sunlight is the solar spectrum attenuated by the atmosphere
// (appendix A.1).
// Differs from the paper: the illuminance of the sun above the atmosphere is the solar constant of
// illumination, 133.3 klx, not the integral of the table. There is no twilight: from the sun's
// elevation 0° to −6°, the end of civil twilight, the sky of 0° fades to black.
// Known errors of the model: clear skies are too bright, above all at sunset, where the sky alone
// gives 11 klx at turbidity 2.5 and 4 klx at 6; measured are less than 1 klx.
#pragma once

#include "core/vec.h"

struct sun_sky {
    float elevation_rad; // of the sun's centre above the horizon, −π/2…π/2
    float azimuth_rad;   // from −z (north) towards +x (east)
    float turbidity; // 2 (very clear) … 10 (hazy); the caller checks: beyond, the fit is invalid
    vec3s ground_albedo; // 0…1
};

#define SUN_SKY_MIN_TURBIDITY 2.0f
#define SUN_SKY_MAX_TURBIDITY 10.0f

enum { SUN_SKY_PEREZ_COUNT = 5 };

// Plain data, made by sun_sky_prepare.
struct sun_sky_model {
    float perez[3][SUN_SKY_PEREZ_COUNT]; // A…E of luminance Y and of chromaticity x, y
    float scale[3];                      // zenith Y (cd/m²), x, y over the distribution there
    vec3s to_glow;                       // towards the sun, not below the horizon
    vec3s to_sun;                        // unit vector
    vec3s sun_lux;                       // at normal incidence
    vec3s ground;                        // radiance, cd/m²
};

// 133.3 klx: the sun's illuminance at normal incidence above the atmosphere.
static const float SUN_SKY_SOLAR_LUX = 133300.0f;
// Half the angle under which the sun is seen at its mean distance, 0.2666°.
static const float SUN_SKY_SUN_RADIUS_RAD = 0.00465f;

void sun_sky_prepare(const struct sun_sky *sky, struct sun_sky_model *out);
// cd/m², linear Rec. 709, never negative. The unit direction points away from the scene. The solar
// disc is left out. Below the horizon it is the Lambertian ground under sky and sun.
vec3s sun_sky_radiance(const struct sun_sky_model *model, vec3s direction);
// The sun's illuminance at normal incidence, lux by colour. The disc sets between elevations of
// plus and minus its radius; below it is 0.
vec3s sun_sky_sun(const struct sun_sky_model *model, vec3s *to_sun);
// Illuminance of the sky alone on the horizontal ground, lux by colour.
vec3s sun_sky_horizontal(const struct sun_sky_model *model);
