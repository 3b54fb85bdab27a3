// Directional albedo of the GGX lobe: the GLSL twin of ggx_albedo.h, which has the formulas. A
// shader that needs the table defines GGX_ALBEDO_BINDING first; the image is named "ggx_albedo".
#ifndef CORE_GGX_ALBEDO_GLSL
#define CORE_GGX_ALBEDO_GLSL

const int GGX_ALBEDO_SIZE = 64;
const float GGX_MIN_ROUGHNESS = 0.045;
const float GGX_ALBEDO_K = 0.35;

#ifdef GGX_ALBEDO_BINDING
// Four nodes in each texel (ggx_albedo_texel): one load of 16 bytes.
layout(set = 0, binding = GGX_ALBEDO_BINDING, rgba32ui) uniform readonly uimage2D ggx_albedo;

vec2 ggx_albedo_mix(uvec2 nodes, float x)
{
    return mix(unpackUnorm2x16(nodes.x), unpackUnorm2x16(nodes.y), x);
}

// (A, B): E(F0, F90) = F0 · A + F90 · B. n_v: 0…1, roughness: GGX_MIN_ROUGHNESS…1.
vec2 ggx_albedo_at(float n_v, float roughness)
{
    float root = sqrt(n_v);
    vec2 t = vec2(root * (1.0 + GGX_ALBEDO_K) / (root + GGX_ALBEDO_K),
                  sqrt(max(roughness - GGX_MIN_ROUGHNESS, 0.0) / (1.0 - GGX_MIN_ROUGHNESS))) *
             float(GGX_ALBEDO_SIZE - 1);
    ivec2 low = min(ivec2(t), ivec2(GGX_ALBEDO_SIZE - 2));
    vec2 part = t - vec2(low);
    uvec4 nodes = imageLoad(ggx_albedo, low);
    return mix(ggx_albedo_mix(nodes.xy, part.x), ggx_albedo_mix(nodes.zw, part.x), part.y);
}
#endif

// (A, B) averaged over the hemisphere, 2 ∫ μ E(μ) dμ: fits by tools/ggx_albedo, errors below
// 3·10⁻⁴.
vec2 ggx_albedo_mean(float roughness)
{
    float r = roughness;
    vec2 sum = vec2(-2.1304318, 0.4823253);
    sum = sum * r + vec2(5.9116830, -1.3662625);
    sum = sum * r + vec2(-4.4786172, 1.1841578);
    sum = sum * r + vec2(-0.0824937, -0.0672114);
    sum = sum * r + vec2(0.2705217, -0.3217048);
    sum = sum * r + vec2(-0.0388192, 0.0458862);
    return sum * r + vec2(0.9540917, 0.0456867);
}

#endif
