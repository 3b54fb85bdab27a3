// Values of the display image: exposed, tone mapped, sRGB-encoded. An includer defines the
// specialization constants DISPLAY_AGX and DISPLAY_LINEAR before; neither: PBR Neutral.
#ifndef AG_FRAME_DISPLAY_GLSL
#define AG_FRAME_DISPLAY_GLSL

#include "frame/frame.glsl"
#include "image/tonemap.glsl"

// Tone-mapped colour of scaled radiance; linear, 0…1.
vec3 display_tone_mapped(vec3 radiance, float ev)
{
    vec3 exposed = radiance * (exposure_scale(ev) / frame.radiance_scale);
    if (DISPLAY_AGX) return tonemap_agx(exposed);
    if (DISPLAY_LINEAR) return tonemap_linear(exposed);
    return clamp(tonemap_pbr_neutral(exposed), 0.0, 1.0);
}

// IEC 61966-2-1, of 0…1.
vec4 display_encoded(vec3 linear)
{
    return vec4(mix(1.055 * pow(linear, vec3(1.0 / 2.4)) - 0.055, 12.92 * linear,
                    lessThanEqual(linear, vec3(0.0031308))),
                1.0);
}

#endif
