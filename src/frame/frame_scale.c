// The scale of a frame's radiometric images: scaled = physical × scale.
//
// Half floats hold 6·10⁻⁵ … 65504 with full precision. The strongest irradiance that some source
// alone brings to a typical place, of all sources, is scaled to 8 … 16: a highlight or a lamp
// nearby has three and a half decades above it, faint indirect light five below. Emissive surfaces
// are seen themselves, and a small one is far brighter than all that it lights: their radiance may
// take that headroom, up to 2¹⁵, and only a still stronger one lowers the scale. A source's measure
// is proportional to its strength and the scale is a power of two, so twice the light gives the
// same images, bit for bit, under half the scale.
#include "frame/frame_scale.h"

#include "frame/light_fit.h"

#include <math.h>

static const int TARGET_EXPONENT = 4;     // 2⁴: strongest scaled irradiance is below it
static const int EMISSION_EXPONENT = 15;  // 2¹⁵: scaled radiance of emission is below it
static const float TYPICAL_SHARE = 0.25f; // distance to a lamp, as a share of the scene's diagonal
static const float LEAST_DISTANCE_M = 0.01f;
static const int EXPONENT_LIMIT = 96; // the scale and its inverse stay normal floats

static float strongest(vec3s v)
{
    return fmaxf(v.x, fmaxf(v.y, v.z));
}

static int least(int a, int b)
{
    return a < b ? a : b;
}

// The power of two n that brings value · 2^n to 2^(target − 1) … 2^target.
static int exponent_to(float value, int target)
{
    int exponent;
    frexpf(value, &exponent); // value = m · 2^exponent, ½ ≤ m < 1
    return target - exponent;
}

static float typical_distance(const struct scale_input *in)
{
    return fmaxf(TYPICAL_SHARE * light_diagonal(in->bounds), LEAST_DISTANCE_M);
}

// Irradiance by the strongest punctual light at a typical place, lux.
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

// A surface of albedo ½ that gets a fiftieth of the light that others get directly, or the sky
// alone.
float frame_unlit_luminance(const struct scale_input *in)
{
    static const float INDIRECT_SHARE = 0.02f, ALBEDO = 0.5f;
    float indirect = INDIRECT_SHARE * ALBEDO * GLM_1_PIf * typical_irradiance(in);
    float value = fmaxf(indirect, luminance(in->sky));
    return isfinite(value) ? value : 0.0f;
}

float frame_scale(const struct scale_input *in)
{
    float distance = typical_distance(in);
    // π radiance is the irradiance under a sky, or right before an emitter; Φ/π is the intensity of
    // a flat one.
    float most = strongest(in->sky) * GLM_PIf;
    float lamp = strongest(in->emitted_flux) / (GLM_PIf * distance * distance);
    most = fmaxf(most, fminf(in->max_emissive * GLM_PIf, lamp));
    most = fmaxf(most, typical_irradiance(in));
    bool lit = most > 0.0f && isfinite(most);
    bool glows = in->max_emissive > 0.0f && isfinite(in->max_emissive);
    if (!lit && !glows) return 1.0f;
    int exponent = EXPONENT_LIMIT;
    if (lit) exponent = least(exponent, exponent_to(most, TARGET_EXPONENT));
    if (glows) exponent = least(exponent, exponent_to(in->max_emissive, EMISSION_EXPONENT));
    return ldexpf(1.0f, exponent > -EXPONENT_LIMIT ? exponent : -EXPONENT_LIMIT);
}
