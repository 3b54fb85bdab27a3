#include "scene/environment/sun_sky.h"

#include "scene/environment/cie.h"

#include <math.h>

// ---- sunlight

enum { FIRST_NM = 380, STEP_NM = 10, WAVELENGTHS = 41 };

// Appendix, table 2, from 380 to 780 nm; after Iqbal 1983, "An Introduction to Solar Radiation".
// Solar radiance in W/(m² sr nm). The table ends at 750 nm and is extrapolated by its last slope;
// the luminous efficacy is below 10⁻⁴ of its peak there.
static const float SOLAR[WAVELENGTHS] = {
    16559.0f, 16233.7f, 21127.5f, 25888.2f, 25829.1f, 24232.3f, 26760.5f, 29658.3f, 30545.4f,
    30057.5f, 30663.7f, 28830.4f, 28712.1f, 27825.0f, 27100.6f, 27233.6f, 26361.3f, 25503.8f,
    25060.2f, 25311.6f, 25355.9f, 25134.2f, 24631.5f, 24173.2f, 23685.3f, 23212.1f, 22827.7f,
    22339.8f, 21970.2f, 21526.7f, 21097.9f, 20728.3f, 20240.4f, 19870.8f, 19427.2f, 19072.4f,
    18628.9f, 18259.2f, 17850.0f, 17440.0f, 17030.0f,
};
// Absorption by ozone, 1/cm.
static const float OZONE[WAVELENGTHS] = {
    0.0f,   0.0f,   0.0f,   0.0f,   0.0f,   0.0f,   0.0f,   0.003f, 0.006f, 0.009f, 0.014f,
    0.021f, 0.03f,  0.04f,  0.048f, 0.063f, 0.075f, 0.085f, 0.103f, 0.12f,  0.12f,  0.115f,
    0.125f, 0.12f,  0.105f, 0.09f,  0.079f, 0.067f, 0.057f, 0.048f, 0.036f, 0.028f, 0.023f,
    0.018f, 0.014f, 0.011f, 0.01f,  0.009f, 0.007f, 0.004f, 0.0f,
};

// Water vapour and mixed gases absorb only from 690 nm on.
enum { FIRST_ABSORBED = 31, ABSORBED = WAVELENGTHS - FIRST_ABSORBED };
static const float WATER[ABSORBED] = { 0.016f, 0.024f, 0.0125f, 1.0f,  0.87f,
                                       0.061f, 0.001f, 1e-5f,   1e-5f, 0.0006f };
static const float GASES[ABSORBED] = {
    0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 3.0f, 0.21f, 0.0f
};

// Relative optical mass (Kasten 1965), 1 at the zenith.
static float air_mass(float zenith_rad)
{
    const float degrees = zenith_rad * (180.0f / GLM_PIf);
    return 1.0f / (cosf(zenith_rad) + 0.15f * powf(93.885f - degrees, -1.253f));
}

// The share of sunlight that reaches the ground directly, of wavelength i.
static float transmittance(int i, float mass, float turbidity)
{
    const float OZONE_CM = 0.35f, WATER_CM = 2.0f, ANGSTROM_EXPONENT = 1.3f;
    const float um = 0.001f * (float)(FIRST_NM + i * STEP_NM);
    const float beta = 0.04608365822f * turbidity - 0.04586025929f; // Ångström's coefficient
    float depth =
        0.008735f * powf(um, -4.08f) + beta * powf(um, -ANGSTROM_EXPONENT) + OZONE[i] * OZONE_CM;
    depth *= mass;
    if (i >= FIRST_ABSORBED) {
        const float gas = GASES[i - FIRST_ABSORBED] * mass;
        const float water = WATER[i - FIRST_ABSORBED] * WATER_CM * mass;
        depth += 1.41f * gas / powf(1.0f + 118.93f * gas, 0.45f);
        depth += 0.2385f * water / powf(1.0f + 20.07f * water, 0.45f);
    }
    return expf(-depth);
}

// The part of the disc above the horizon: a segment of a circle.
static float visible_share(float elevation_rad)
{
    const float h = fminf(fmaxf(elevation_rad / SUN_SKY_SUN_RADIUS_RAD, -1.0f), 1.0f);
    return 0.5f + (h * sqrtf(1.0f - h * h) + asinf(h)) / GLM_PIf;
}

static vec3s find_sun_lux(float elevation_rad, float turbidity)
{
    const float share = visible_share(elevation_rad);
    if (share <= 0.0f) return glms_vec3_zero();
    const float mass = air_mass(GLM_PI_2f - fmaxf(elevation_rad, 0.0f));
    vec3s xyz = glms_vec3_zero();
    float above = 0.0f; // Y above the atmosphere
    for (int i = 0; i < WAVELENGTHS; i++) {
        const vec3s match = cie_match((float)(FIRST_NM + i * STEP_NM));
        above += SOLAR[i] * match.y;
        xyz = glms_vec3_muladds(match, SOLAR[i] * transmittance(i, mass, turbidity), xyz);
    }
    return cie_rec709_from_xyz(glms_vec3_scale(xyz, share * SUN_SKY_SOLAR_LUX / above));
}

// ---- sky

// Appendix A.2: A…E are first-degree polynomials of turbidity.
static void find_perez(float t, float out[3][SUN_SKY_PEREZ_COUNT])
{
    static const float slopes[3][SUN_SKY_PEREZ_COUNT] = {
        { 0.1787f, -0.3554f, -0.0227f, 0.1206f, -0.0670f },
        { -0.0193f, -0.0665f, -0.0004f, -0.0641f, -0.0033f },
        { -0.0167f, -0.0950f, -0.0079f, -0.0441f, -0.0109f },
    };
    static const float constants[3][SUN_SKY_PEREZ_COUNT] = {
        { -1.4630f, 0.4275f, 5.3251f, -2.5771f, 0.3703f },
        { -0.2592f, 0.0008f, 0.2125f, -0.8989f, 0.0452f },
        { -0.2608f, 0.0092f, 0.2102f, -1.6537f, 0.0529f },
    };
    for (int c = 0; c < 3; c++)
        for (int i = 0; i < SUN_SKY_PEREZ_COUNT; i++)
            out[c][i] = slopes[c][i] * t + constants[c][i];
}

// Equation 3. The angle to the sun is given by its cosine, too.
static float perez(const float p[SUN_SKY_PEREZ_COUNT], float cos_zenith, float to_sun_rad,
                   float cos_to_sun)
{
    const float LEAST_COSINE = 1e-3f; // the exponential is 0 there
    return (1.0f + p[0] * expf(p[1] / fmaxf(cos_zenith, LEAST_COSINE))) *
           (1.0f + p[2] * expf(p[3] * to_sun_rad) + p[4] * cos_to_sun * cos_to_sun);
}

static float zenith_luminance(float sun_zenith_rad, float t)
{
    const float chi = (4.0f / 9.0f - t / 120.0f) * (GLM_PIf - 2.0f * sun_zenith_rad);
    return 1000.0f * ((4.0453f * t - 4.9710f) * tanf(chi) - 0.2155f * t + 2.4192f);
}

// Polynomials of turbidity (rows, from its square down) and the sun's zenith angle (from its cube).
static float zenith_chromaticity(const float m[3][4], float sun_zenith_rad, float t)
{
    float rows[3];
    for (int i = 0; i < 3; i++)
        rows[i] =
            ((m[i][0] * sun_zenith_rad + m[i][1]) * sun_zenith_rad + m[i][2]) * sun_zenith_rad +
            m[i][3];
    return (rows[0] * t + rows[1]) * t + rows[2];
}

static void find_zenith(float sun_zenith_rad, float t, float out[3])
{
    static const float x[3][4] = { { 0.00166f, -0.00375f, 0.00209f, 0.0f },
                                   { -0.02903f, 0.06377f, -0.03202f, 0.00394f },
                                   { 0.11693f, -0.21196f, 0.06052f, 0.25886f } };
    static const float y[3][4] = { { 0.00275f, -0.00610f, 0.00317f, 0.0f },
                                   { -0.04214f, 0.08970f, -0.04153f, 0.00516f },
                                   { 0.15346f, -0.26756f, 0.06670f, 0.26688f } };
    out[0] = zenith_luminance(sun_zenith_rad, t);
    out[1] = zenith_chromaticity(x, sun_zenith_rad, t);
    out[2] = zenith_chromaticity(y, sun_zenith_rad, t);
}

// The share of the sky's light at sunset that is left: 1 at elevations of 0° and more.
static float dusk(float elevation_rad)
{
    const float END_RAD = 6.0f * (GLM_PIf / 180.0f);
    return glm_smoothstep(-END_RAD, 0.0f, elevation_rad);
}

static vec3s direction_at(float elevation_rad, float azimuth_rad)
{
    return vec3_of(cosf(elevation_rad) * sinf(azimuth_rad), sinf(elevation_rad),
                   -cosf(elevation_rad) * cosf(azimuth_rad));
}

static vec3s sky_radiance(const struct sun_sky_model *model, vec3s direction)
{
    const float cosine = glms_vec3_dot(direction, model->to_glow);
    // Near the sun the arc cosine would lose half of the digits.
    const float angle_rad =
        atan2f(glms_vec3_norm(glms_vec3_cross(direction, model->to_glow)), cosine);
    float yxy[3];
    for (int c = 0; c < 3; c++)
        yxy[c] = model->scale[c] * perez(model->perez[c], direction.y, angle_rad, cosine);
    const float per_y = yxy[0] / yxy[2];
    return cie_rec709_from_xyz(vec3_of(per_y * yxy[1], yxy[0], per_y * (1.0f - yxy[1] - yxy[2])));
}

// The midpoint rule in the cosine to the zenith: within 0.03 % of the integral. Azimuths are
// relative to the sun's, so that the sum turns with it.
vec3s sun_sky_horizontal(const struct sun_sky_model *model)
{
    enum { RINGS = 32, STEPS = 32 };
    const float sun_rad = atan2f(model->to_glow.x, -model->to_glow.z);
    vec3s sum = glms_vec3_zero();
    for (int ring = 0; ring < RINGS; ring++) {
        const float cosine = ((float)ring + 0.5f) / RINGS, elevation_rad = asinf(cosine);
        for (int step = 0; step < STEPS; step++) {
            const float turn_rad = ((float)step + 0.5f) * (2.0f * GLM_PIf / STEPS);
            const vec3s direction = direction_at(elevation_rad, sun_rad + turn_rad);
            sum = glms_vec3_muladds(sky_radiance(model, direction), cosine, sum);
        }
    }
    return glms_vec3_scale(sum, 2.0f * GLM_PIf / (RINGS * STEPS));
}

void sun_sky_prepare(const struct sun_sky *sky, struct sun_sky_model *out)
{
    const float above_rad = fmaxf(sky->elevation_rad, 0.0f);
    const float zenith_rad = GLM_PI_2f - above_rad;
    find_perez(sky->turbidity, out->perez);
    find_zenith(zenith_rad, sky->turbidity, out->scale);
    out->to_sun = direction_at(sky->elevation_rad, sky->azimuth_rad);
    out->to_glow = direction_at(above_rad, sky->azimuth_rad);
    out->scale[0] *= dusk(sky->elevation_rad);
    for (int c = 0; c < 3; c++)
        out->scale[c] /= perez(out->perez[c], 1.0f, zenith_rad, cosf(zenith_rad));
    out->sun_lux = find_sun_lux(sky->elevation_rad, sky->turbidity);
    const vec3s irradiance =
        glms_vec3_muladds(out->sun_lux, fmaxf(out->to_sun.y, 0.0f), sun_sky_horizontal(out));
    out->ground = glms_vec3_scale(glms_vec3_mul(sky->ground_albedo, irradiance), 1.0f / GLM_PIf);
}

vec3s sun_sky_radiance(const struct sun_sky_model *model, vec3s direction)
{
    return direction.y < 0.0f ? model->ground : sky_radiance(model, direction);
}

vec3s sun_sky_sun(const struct sun_sky_model *model, vec3s *to_sun)
{
    *to_sun = model->to_sun;
    return model->sun_lux;
}
