// The GLSL twin of tonemap.c: exposure, then the Khronos PBR Neutral tone mapper
// (Khronos 2024, "PBR Neutral Tone Mapper Specification").
#ifndef AG_IMAGE_TONEMAP_GLSL
#define AG_IMAGE_TONEMAP_GLSL

// Factor on radiance in cd/m² for an exposure value at ISO 100 (ISO 12232, saturation based).
float exposure_scale(float ev)
{
    return exp2(-ev) / 1.2;
}

// Linear display values in 0…1 of an exposed colour; negative values and NaN count as 0.
vec3 tonemap_pbr_neutral(vec3 exposed)
{
    const float compression_start = 0.76;
    const float desaturation = 0.15;
    vec3 c = mix(vec3(0.0), min(exposed, vec3(1e30)), greaterThan(exposed, vec3(0.0)));
    float lowest = min(c.r, min(c.g, c.b));
    c -= lowest < 0.08 ? lowest - 6.25 * lowest * lowest : 0.04;
    float peak = max(c.r, max(c.g, c.b));
    if (peak < compression_start) return c;

    float headroom = 1.0 - compression_start;
    float new_peak = 1.0 - headroom * headroom / (peak + headroom - compression_start);
    c *= new_peak / peak;
    float to_white = 1.0 - 1.0 / (desaturation * (peak - new_peak) + 1.0);
    return mix(c, vec3(new_peak), to_white);
}

#endif
