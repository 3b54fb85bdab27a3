// The GLSL twin of tonemap.c: exposure and tone curves.
#ifndef AG_IMAGE_TONEMAP_GLSL
#define AG_IMAGE_TONEMAP_GLSL

// Factor on radiance in cd/m² for an exposure value at ISO 100 (ISO 12232, saturation based).
float exposure_scale(float ev)
{
    return exp2(-ev) / 1.2;
}

vec3 tonemap_clean(vec3 exposed)
{
    return mix(vec3(0.0), min(exposed, vec3(1e30)), greaterThan(exposed, vec3(0.0)));
}

// Linear display values in 0…1 of an exposed colour; negative values and NaN count as 0.
vec3 tonemap_pbr_neutral(vec3 exposed)
{
    const float compression_start = 0.76;
    const float desaturation = 0.15;
    vec3 c = tonemap_clean(exposed);
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

vec3 tonemap_agx(vec3 exposed)
{
    const mat3 inset = mat3(0.54481475, 0.14041695, 0.08881042, 0.37378740, 0.75413755, 0.17887176,
                            0.08139785, 0.10544550, 0.73231782);
    const mat3 outset = mat3(1.96488741, -0.29931336, -0.16435274, -0.85598850, 1.32639796,
                             -0.23818397, -0.10889891, -0.02708460, 1.40253671);
    vec3 x = (log2(max(inset * tonemap_clean(exposed), vec3(1e-30)) / 0.18) + 10.0) / 16.5;
    vec3 d = clamp(x, 0.0, 1.0) - 0.60606061;
    vec3 s = mix(vec3(0.715198286), vec3(0.565675607), lessThan(d, vec3(0.0)));
    vec3 u = 2.4 * d / s;
    vec3 y = 0.489437090 + s * u / pow(1.0 + pow(abs(u), vec3(1.5)), vec3(1.0 / 1.5));
    return clamp(outset * pow(max(y, vec3(0.0)), vec3(2.4)), 0.0, 1.0);
}

vec3 tonemap_linear(vec3 exposed)
{
    return min(tonemap_clean(exposed), vec3(1.0));
}

#endif
