// Light of a surface from a light map, whose layers are the colours of a side. A texel is the
// irradiance E along the surface's normal, and the vector irradiance V: bands 0 and 1 of spherical
// harmonics have E(n) = (E + n·V) / 2. n·V is E for the surface's own normal, so that E(n) is exact
// there, and in uniform light for all normals. Include core/half.glsl and core/math.glsl first.
#ifndef AG_LIGHT_MAP_LOOKUP_GLSL
#define AG_LIGHT_MAP_LOOKUP_GLSL

#include "frame/lobe.glsl"
#include "techniques/common/light_map/surface_shared.h"

// Irradiance and vector irradiance by colour.
struct light_map_light {
    vec3 irradiance;
    mat3 vector; // a column for each colour
};

// per_size: 1 / width and height of the map.
light_map_light light_map_lookup(sampler2DArray light_map, vec2 per_size, vec3 place, vec3 n)
{
    vec2 uv = place.xy * per_size;
    light_map_light light;
    for (int c = 0; c < 3; c++) {
        vec4 texel =
            textureLod(light_map, vec3(uv, place.z * float(LIGHT_MAP_LAYERS) + float(c)), 0.0);
        light.irradiance[c] = 0.5 * (texel.x + dot(texel.yzw, n));
        light.vector[c] = texel.yzw;
    }
    light.irradiance = clamp(light.irradiance, vec3(0.0), vec3(HALF_MAX));
    return light;
}

// Part along the surface of the mean direction of a specular lobe.
vec3 light_map_lobe_along(vec3 n, vec3 to_viewer, float alpha)
{
    return (dot(to_viewer, n) * n - to_viewer) * lobe_lean(alpha);
}

// Share of the first order in the radiance of a lobe. A mirror has no mean over directions that
// would hide what two bands lack: there the mean radiance E/π has the lesser error.
float light_map_first_order_share(float alpha)
{
    const float WHOLE_FROM = 0.3; // roughness
    return smoothstep(0.0, WHOLE_FROM * WHOLE_FROM, alpha);
}

// A specular lobe over a surface: the part of the mirror direction along the surface, and the share
// of it that the lobe's mean direction has, less where the first order fades out.
struct light_map_lobe {
    vec3 along;
    float share;
};

light_map_lobe light_map_lobe_of(vec3 n, vec3 to_viewer, float alpha)
{
    return light_map_lobe(dot(to_viewer, n) * n - to_viewer,
                          light_map_first_order_share(alpha) * lobe_lean(alpha));
}

// Mean over the unit disc of exp(b·x), 2 I1(|b|)/|b|, by the square of |b|: within 2e-3 up to 4.
float light_map_mean_of_exp(float b2)
{
    float q = 0.25 * b2;
    return 1.0 + q * (1.0 / 2.0 + q * (1.0 / 12.0 + q * (1.0 / 144.0 + q / 2880.0)));
}

// Exponent p of the cosine in light L(ω) ∝ cosᵖ θ exp(b·t) with the part v of V along the surface,
// per irradiance E, and of square v2. φ/(2E) of it, with φ the fluence ∫ L dω, is
// (p + 2)/(2 (p + 1)) (1 + v² (p + 1)² (p + 3)/(2 (p + 2)² (p + 4))), here with the second factor
// of p = 0: 0 in uniform light, positive for light from overhead.
float light_map_cosine_exponent(float fluence, float v2)
{
    const float LEAST = 0.55, MOST = 1.5; // of φ/(2E): exponents of 9 and −1/2
    float f = clamp(0.5 * fluence / (1.0 + 0.0935 * v2), LEAST, MOST);
    return 2.0 * (1.0 - f) / (2.0 * f - 1.0);
}

// Radiance in a lobe of light whose logarithm is linear in the direction, L(ω) = E(n)/π exp(b·t)/M
// with t the part of ω along the surface. M, the mean of exp(b·t) over the disc of t, keeps the
// irradiance E(n), and V along the surface is (b cosh b − sinh b)/(b I1(b)) of it: the fit of b is
// within 1 % up to 4. L is positive, and E(n)/π + 3/(2π) V·t where V is small. A wide lobe has the
// radiance of `share` times b. Uniform light is exact.
vec3 light_map_radiance_of(light_map_light light, vec3 n, light_map_lobe lobe)
{
    const float MOST = 4.0;
    vec3 radiance;
    for (int c = 0; c < 3; c++) {
        float per = 1.0 / max(light.irradiance[c], 1e-6);
        vec3 v = per * (light.vector[c] - dot(light.vector[c], n) * n);
        vec3 b = 1.5 * (1.0 + 0.06 * min(dot(v, v), 9.0)) * v;
        b *= lobe.share * min(MOST * inversesqrt(max(dot(b, b), 1e-12)), 1.0);
        radiance[c] = INV_PI * light.irradiance[c] * exp(dot(b, lobe.along)) /
                      light_map_mean_of_exp(dot(b, b));
    }
    return radiance;
}

// The same of light that is also proportional to cosᵖ θ, with p from the fluence by colour. The
// irradiance stays: cosᵖ⁺¹ θ has the mean 2/(p + 2) of the cosine's over solid angles, and M and b
// are those of p to their first order.
vec3 light_map_radiance_by_fluence(light_map_light light, vec3 fluence, vec3 n, light_map_lobe lobe)
{
    const float MOST = 4.0, LEAST_COSINE = 0.02;
    float cosine = sqrt(max(1.0 - dot(lobe.along, lobe.along), LEAST_COSINE * LEAST_COSINE));
    vec3 radiance;
    for (int c = 0; c < 3; c++) {
        float per = 1.0 / max(light.irradiance[c], 1e-6);
        vec3 v = per * (light.vector[c] - dot(light.vector[c], n) * n);
        float v2 = min(dot(v, v), 9.0);
        float p = light_map_cosine_exponent(per * fluence[c], v2);
        vec3 b = (p + 1.0) * (p + 3.0) / (p + 2.0) * (1.0 + 0.06 * v2) * v;
        b *= lobe.share * min(MOST * inversesqrt(max(dot(b, b), 1e-12)), 1.0);
        p *= lobe.share;
        radiance[c] = INV_PI * light.irradiance[c] * exp(dot(b, lobe.along)) /
                      light_map_mean_of_exp(4.0 / (p + 4.0) * dot(b, b)) * 0.5 * (p + 2.0) *
                      pow(cosine, p);
    }
    return radiance;
}

vec3 light_map_radiance(light_map_light light, vec3 n, vec3 to_viewer, float alpha)
{
    return light_map_radiance_of(light, n, light_map_lobe_of(n, to_viewer, alpha));
}

#endif
