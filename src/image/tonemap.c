// Exposure, the Khronos PBR Neutral tone mapper (Khronos 2024, "PBR Neutral Tone Mapper
// Specification"). tonemap.glsl is the GPU twin.
#include "image/tonemap.h"

#include <math.h>

static const float FRESNEL_OFFSET = 0.04f;    // F0 of a dielectric, subtracted
static const float COMPRESSION_START = 0.76f; // 0.8 − 0.04: values below are not compressed
static const float DESATURATION = 0.15f;      // rate at which compressed colours go to white
static const float TOE_END = 0.08f;           // below it the offset shrinks, so that 0 stays 0
static const float EXPOSED_MAX = 1e30f;       // replaces infinity, so that no product overflows

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

bool image_tonemap(struct image *out, struct host *host, const struct image *in, float ev)
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
            vec3s display = tonemap_pbr_neutral(glms_vec3_scale(vec3_of(l[0], l[1], l[2]), scale));
            float *o = image_at(out, x, y);
            o[0] = display.x, o[1] = display.y, o[2] = display.z;
        }
    }
    return true;
}
