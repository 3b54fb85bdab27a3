// The distribution of visible normals of GGX (Heitz 2018, "Sampling the GGX Distribution of Visible
// Normals"): directions and their density.
#ifndef AG_SSR_LOBE_GLSL
#define AG_SSR_LOBE_GLSL

#include "core/math.glsl"

const float SSR_MIRROR_ROUGHNESS = 0.05; // smoother surfaces are mirrors: rays without noise

// Share of the lobe over which rays are spread. The lobe of a smooth surface is narrower than the
// distance of neighbours' hits: they cannot average each other's noise, and mips do.
float ssr_spread(float roughness, float whole_from)
{
    return smoothstep(SSR_MIRROR_ROUGHNESS, whole_from, roughness);
}

// v: unit, in tangent space; u: 0…1.
vec3 ssr_visible_normal(vec3 v, float alpha, vec2 u)
{
    vec3 stretched = normalize(vec3(alpha * v.xy, v.z));
    float across = dot(stretched.xy, stretched.xy);
    vec3 first = across > 1.0e-12 ? vec3(-stretched.y, stretched.x, 0.0) * inversesqrt(across)
                                  : vec3(1.0, 0.0, 0.0);
    vec3 second = cross(stretched, first);
    float r = sqrt(u.x), angle = 2.0 * PI * u.y;
    vec2 disk = r * vec2(cos(angle), sin(angle));
    disk.y = mix(sqrt(max(1.0 - disk.x * disk.x, 0.0)), disk.y, 0.5 * (1.0 + stretched.z));
    vec3 n = disk.x * first + disk.y * second + sqrt(max(1.0 - dot(disk, disk), 0.0)) * stretched;
    return normalize(vec3(alpha * n.xy, max(n.z, 1.0e-6)));
}

// Density of a sampled direction, 1/sr: G1 D / (4 n·v).
float ssr_density(float distribution, float n_v, float a2)
{
    float root = sqrt(n_v * n_v * (1.0 - a2) + a2);
    return distribution * 0.5 / (n_v + root);
}

#endif
