// Exposure and tone curves. tonemap.glsl is the GPU twin.
#include "image/tonemap.h"

#include <math.h>

static const float FRESNEL_OFFSET = 0.04f;    // F0 of a dielectric, subtracted
static const float COMPRESSION_START = 0.76f; // 0.8 − 0.04: values below are not compressed
static const float DESATURATION = 0.15f;      // rate at which compressed colours go to white
static const float TOE_END = 0.08f;           // below it the offset shrinks, so that 0 stays 0
static const float EXPOSED_MAX = 1e30f;       // replaces infinity, so that no product overflows

// AgX: Rec. 709 to its inset primaries within Rec. 2020, and back from its outset ones.
static const vec3s AGX_INSET[3] = { { { 0.54481475f, 0.37378740f, 0.08139785f } },
                                    { { 0.14041695f, 0.75413755f, 0.10544550f } },
                                    { { 0.08881042f, 0.17887176f, 0.73231782f } } };
static const vec3s AGX_OUTSET[3] = { { { 1.96488741f, -0.85598850f, -0.10889891f } },
                                     { { -0.29931336f, 1.32639796f, -0.02708460f } },
                                     { { -0.16435274f, -0.23818397f, 1.40253671f } } };
static const float AGX_GREY = 0.18f, AGX_STOPS = 16.5f, AGX_STOPS_BELOW = 10.0f;
static const float AGX_GAMMA = 2.4f;           // of the display that the curve is for
static const float AGX_PIVOT = 0.60606061f;    // 10 / 16.5
static const float AGX_ENCODED = 0.489437090f; // 0.18^(1/2.4)
static const float AGX_SLOPE = 2.4f, AGX_POWER = 1.5f;
// The curve p + s u / (1 + |u|^1.5)^(1/1.5), u = 2.4 (x − pivot) / s, is 0 at 0 and 1 at 1:
// s = k / ((k / h)^1.5 − 1)^(1/1.5) for k = 2.4 times the width of a side and its height h.
static const float AGX_TOE = 0.565675607f, AGX_SHOULDER = 0.715198286f;

float exposure_scale(float ev)
{
    return exp2f(-ev) / 1.2f;
}

// Negative values and NaN become 0.
static float tonemap_clean(float value)
{
    return value > 0.0f ? fminf(value, EXPOSED_MAX) : 0.0f;
}

vec3s tonemap_pbr_neutral(vec3s exposed)
{
    vec3s c = vec3_of(tonemap_clean(exposed.x), tonemap_clean(exposed.y), tonemap_clean(exposed.z));
    float lowest = fminf(c.x, fminf(c.y, c.z));
    // x − 6.25 x² reaches 0.04 with slope 0 at 0.08.
    float offset = lowest < TOE_END ? lowest - 6.25f * lowest * lowest : FRESNEL_OFFSET;
    c = glms_vec3_subs(c, offset);
    float peak = fmaxf(c.x, fmaxf(c.y, c.z));
    if (peak < COMPRESSION_START) return c;

    float headroom = 1.0f - COMPRESSION_START;
    float new_peak = 1.0f - headroom * headroom / (peak + headroom - COMPRESSION_START);
    c = glms_vec3_scale(c, new_peak / peak);
    float to_white = 1.0f - 1.0f / (DESATURATION * (peak - new_peak) + 1.0f);
    return glms_vec3_add(glms_vec3_scale(c, 1.0f - to_white),
                         vec3_of(new_peak * to_white, new_peak * to_white, new_peak * to_white));
}

// Stops about middle grey, 0…1, to values for a display.
static float agx_curve(float x)
{
    const float d = x - AGX_PIVOT, s = d < 0.0f ? AGX_TOE : AGX_SHOULDER, u = AGX_SLOPE * d / s;
    return AGX_ENCODED + s * u / powf(1.0f + powf(fabsf(u), AGX_POWER), 1.0f / AGX_POWER);
}

vec3s tonemap_agx(vec3s exposed)
{
    const vec3s c =
        vec3_of(tonemap_clean(exposed.x), tonemap_clean(exposed.y), tonemap_clean(exposed.z));
    vec3s inset, out;
    for (int i = 0; i < 3; i++) {
        const float stops = log2f(fmaxf(glms_vec3_dot(AGX_INSET[i], c), 1e-30f) / AGX_GREY);
        const float x = (stops + AGX_STOPS_BELOW) / AGX_STOPS;
        inset.raw[i] = powf(fmaxf(agx_curve(fminf(fmaxf(x, 0.0f), 1.0f)), 0.0f), AGX_GAMMA);
    }
    for (int i = 0; i < 3; i++) out.raw[i] = glms_vec3_dot(AGX_OUTSET[i], inset);
    return glms_vec3_clamp(out, 0.0f, 1.0f);
}

vec3s tonemap(enum tonemap_curve curve, vec3s exposed)
{
    if (curve == TONEMAP_NEUTRAL) return tonemap_pbr_neutral(exposed);
    if (curve == TONEMAP_AGX) return tonemap_agx(exposed);
    return vec3_of(fminf(tonemap_clean(exposed.x), 1.0f), fminf(tonemap_clean(exposed.y), 1.0f),
                   fminf(tonemap_clean(exposed.z), 1.0f));
}

bool image_tonemap(struct image *out, struct host *host, const struct image *in, float ev,
                   enum tonemap_curve curve)
{
    *out = (struct image){ 0 };
    if (in->channels < 3)
        return host_fail(host, FAIL_ARGUMENT,
                         "cannot tonemap an image of %d channels: 3 or 4 are needed", in->channels);
    if (!isfinite(ev))
        return host_fail(host, FAIL_ARGUMENT, "cannot tonemap at EV %g: not a finite value",
                         (double)ev);
    if (!image_init(out, host, in->width, in->height, 3)) return false;
    float scale = exposure_scale(ev);
    for (int y = 0; y < in->height; y++) {
        for (int x = 0; x < in->width; x++) {
            const float *l = image_at(in, x, y);
            vec3s display = tonemap(curve, glms_vec3_scale(vec3_of(l[0], l[1], l[2]), scale));
            float *o = image_at(out, x, y);
            o[0] = display.x, o[1] = display.y, o[2] = display.z;
        }
    }
    return true;
}
