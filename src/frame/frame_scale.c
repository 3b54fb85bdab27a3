// The scale of radiometric images: scaled = physical × scale.
//
// Half floats have full precision in 6·10⁻⁵ … 65504. For each light source alone, the irradiance at
// a typical distance is estimated; the largest of these is scaled to 8 … 16. That leaves three and
// a half decades above for highlights and surfaces near a light, and five below for faint indirect
// light. Emissive surfaces are directly visible, and a small one is far brighter than the surfaces
// it lights: their radiance may use that headroom, up to 2¹⁵; only stronger emission lowers the
// scale. Every estimate is proportional to its source and the scale is a power of two, so twice the
// light gives the same images, bit for bit, at half the scale.
#include "frame/frame_scale.h"

#include "frame/light_projection.h"

#include <math.h>

static const int TARGET_EXPONENT = 4;     // scaled irradiance stays below 2⁴
static const int EMISSION_EXPONENT = 15;  // scaled emission stays below 2¹⁵
static const float TYPICAL_SHARE = 0.25f; // typical distance to a light over the scene's diagonal
static const float MIN_DISTANCE_M = 0.01f;
static const int EXPONENT_LIMIT = 96; // the scale and its inverse stay normal floats

static float strongest(vec3s v)
{
    return fmaxf(v.x, fmaxf(v.y, v.z));
}

static int min_int(int a, int b)
{
    return a < b ? a : b;
}

// The n for which value · 2^n lies in 2^(target − 1) … 2^target.
static int exponent_to(float value, int target)
{
    int exponent;
    frexpf(value, &exponent); // value = m · 2^exponent, ½ ≤ m < 1
    return target - exponent;
}

static float typical_distance(const struct scale_input *in)
{
    return fmaxf(TYPICAL_SHARE * light_diagonal(in->bounds), MIN_DISTANCE_M);
}

// Irradiance from the strongest punctual light at the typical distance, lux.
static float typical_irradiance(const struct scale_input *in)
{
    float distance = typical_distance(in), most = 0.0f;
    for (int i = 0; i < in->light_count; i++) {
        float strength = strongest(in->lights[i].intensity);
        if (in->lights[i].type != LIGHT_SUN) strength /= distance * distance;
        most = fmaxf(most, strength);
    }
    return most;
}

// Luminance of a surface of albedo ½ that receives 1/50 of the direct irradiance, or of the sky.
float frame_fallback_luminance(const struct scale_input *in)
{
    static const float INDIRECT_SHARE = 0.02f, ALBEDO = 0.5f;
    float indirect = INDIRECT_SHARE * ALBEDO * GLM_1_PIf * typical_irradiance(in);
    float value = fmaxf(indirect, luminance(in->sky));
    return isfinite(value) ? value : 0.0f;
}

float frame_scale(const struct scale_input *in)
{
    float distance = typical_distance(in);
    // Irradiance is π · radiance under a uniform sky or close to an emitter; a flat emitter's
    // intensity is Φ/π.
    float most = strongest(in->sky) * GLM_PIf;
    float emitter = strongest(in->emitted_flux) / (GLM_PIf * distance * distance);
    most = fmaxf(most, fminf(in->max_emissive * GLM_PIf, emitter));
    most = fmaxf(most, fmaxf(typical_irradiance(in), in->painted));
    bool lit = most > 0.0f && isfinite(most);
    bool emissive = in->max_emissive > 0.0f && isfinite(in->max_emissive);
    if (!lit && !emissive) return 1.0f;
    int exponent = EXPONENT_LIMIT;
    if (lit) exponent = min_int(exponent, exponent_to(most, TARGET_EXPONENT));
    if (emissive) exponent = min_int(exponent, exponent_to(in->max_emissive, EMISSION_EXPONENT));
    return ldexpf(1.0f, exponent > -EXPONENT_LIMIT ? exponent : -EXPONENT_LIMIT);
}
