// Directional albedo of the GGX lobe, for energy conservation; the GLSL twin is ggx_albedo.glsl.
//
// The lobe is f = D V F with the height-correlated Smith G2 = 4 n·l n·v V and Schlick's Fresnel
// term F = F0 + (F90 − F0) (1 − v·h)⁵, 1/sr. Its directional albedo, ∫ f n·l dl, is linear in F:
//
//     E(F0, F90) = F0 · A(n·v, α) + F90 · B(n·v, α),
//     A = ∫ D V (1 − (1 − v·h)⁵) n·l dl,  B = ∫ D V (1 − v·h)⁵ n·l dl, no unit
//
// (the split sum of Karis 2013, "Real Shading in Unreal Engine 4"). Ess = A + B is the albedo of a
// lobe without Fresnel losses; 1 − Ess is what single scattering loses. Multiplying f by
// 1 + F0 (1 − Ess)/Ess (Turquin 2019, "Practical multiple scattering compensation for microfacet
// models", eq. 16) restores it: a lobe of F0 = F90 = 1 has the albedo 1.
//
// The table holds A and B at GGX_ALBEDO_SIZE² nodes, interpolated bilinearly between them. Node i
// of n·v: √μ (1 + k)/(√μ + k) = i/(size − 1); node j of roughness: √((r − r0)/(1 − r0)) =
// j/(size − 1). Both are dense near 0, where a smooth surface at grazing angles changes fast.
// tools/ggx_albedo writes it.
#pragma once

#include <math.h>
#include <stdint.h>

#define GGX_ALBEDO_SIZE       64
#define GGX_ALBEDO_MEAN_TERMS 7
#define GGX_MIN_ROUGHNESS     0.045f // keeps α² a normal float and a highlight about a pixel wide
#define GGX_ALBEDO_K          0.35f

// [roughness][n·v]; A in the lower 16 bits, B in the upper ones, as fractions of 65535.
extern const uint32_t ggx_albedo_table[GGX_ALBEDO_SIZE * GGX_ALBEDO_SIZE];

// Texel (i, j) of an image of GGX_ALBEDO_SIZE² texels for shaders. One fetch has all nodes of a
// bilinear lookup: i and i + 1 of n·v, j and j + 1 of roughness, clamped to the last node.
struct ggx_albedo_texel {
    uint32_t nodes[4];
};
struct ggx_albedo_texel ggx_albedo_texel(int i, int j);

struct ggx_albedo {
    float a, b;
};

static inline float ggx_albedo_node_cosine(int i)
{
    float t = (float)i / (GGX_ALBEDO_SIZE - 1);
    float root = t * GGX_ALBEDO_K / (1.0f + GGX_ALBEDO_K - t);
    return root * root;
}

static inline float ggx_albedo_node_roughness(int j)
{
    float t = (float)j / (GGX_ALBEDO_SIZE - 1);
    return GGX_MIN_ROUGHNESS + (1.0f - GGX_MIN_ROUGHNESS) * t * t;
}

static inline struct ggx_albedo ggx_albedo_mix(const uint32_t *nodes, float x)
{
    const float scale = 1.0f / 65535.0f;
    float a0 = (float)(nodes[0] & 0xffffu), a1 = (float)(nodes[1] & 0xffffu);
    float b0 = (float)(nodes[0] >> 16), b1 = (float)(nodes[1] >> 16);
    return (struct ggx_albedo){ (a0 + (a1 - a0) * x) * scale, (b0 + (b1 - b0) * x) * scale };
}

// n_v: 0…1. roughness: GGX_MIN_ROUGHNESS…1 (α = roughness²).
static inline struct ggx_albedo ggx_albedo_at(float n_v, float roughness)
{
    const float last = GGX_ALBEDO_SIZE - 1;
    float root = sqrtf(n_v);
    float x = root * (1.0f + GGX_ALBEDO_K) / (root + GGX_ALBEDO_K) * last;
    float y = sqrtf((roughness - GGX_MIN_ROUGHNESS) / (1.0f - GGX_MIN_ROUGHNESS)) * last;
    int i = x < last - 1.0f ? (int)x : GGX_ALBEDO_SIZE - 2;
    int j = y < last - 1.0f ? (int)y : GGX_ALBEDO_SIZE - 2;
    const uint32_t *nodes = &ggx_albedo_table[j * GGX_ALBEDO_SIZE + i];
    struct ggx_albedo low = ggx_albedo_mix(nodes, x - (float)i);
    struct ggx_albedo high = ggx_albedo_mix(nodes + GGX_ALBEDO_SIZE, x - (float)i);
    float t = y - (float)j;
    return (struct ggx_albedo){ low.a + (high.a - low.a) * t, low.b + (high.b - low.b) * t };
}
