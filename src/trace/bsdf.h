// The BSDF of a surface: brdf.glsl on the CPU, with importance sampling. docs/materials.md derives
// it.
//
// A dielectric is a GGX lobe over a Lambertian base that receives what the lobe does not reflect; a
// metal is a GGX lobe alone; `metallic` mixes both (glTF 2.0, appendix B). With the directional
// albedo E = F0 A + F90 B of ggx_albedo.h and the compensation k = 1 + F0 (1 − Ess)/Ess:
//
//     f = (1 − metallic) · [albedo/π · (1 − max(E_d k_d)) + k_d D V F_d] + metallic · k_m D V F_m
//
// F_d has F0 and F90 of the dielectric, F_m has F0 = albedo and F90 = 1. E, k and so the diffuse
// lobe depend on the outgoing direction alone (OpenPBR, MaterialX): irradiance stays separable, and
// f is not reciprocal. As F is linear in F0 and F90, both lobes are one of mixed F0 and F90.
//
// The specular lobe is sampled by the distribution of visible normals (bsdf.c), the diffuse lobe by
// the cosine. Functions called per ray are inline: passing vectors by value costs more than their
// arithmetic.
#pragma once

#include "core/ggx_albedo.h"
#include "core/sampling.h"

// Parameters of a surface point, 0…1.
struct bsdf_material {
    vec3s albedo; // base colour
    float metallic, roughness;
    vec3s dielectric_f0; // of the dielectric at normal incidence
    float dielectric_f90;
};

struct bsdf {
    vec3s normal, tangent, bitangent; // orthonormal
    vec3s to_viewer;                  // unit
    vec3s diffuse;                    // diffuse lobe, 1/sr
    vec3s f0, f90;                    // of the specular lobe, with compensation: may exceed 1
    float alpha, alpha2;              // roughness², at least 0.045², and its square
    float specular_probability;       // of sampling the specular lobe; 0: no such lobe
    float n_v, smith_v;               // |n·v|, and the square root in Smith's term for the viewer
    vec3s lobe_viewer; // to_viewer; if backfacing, its mirror image on the normal's side
    bool backfacing;   // the shading normal points away from the viewer
};

// normal and to_viewer: unit. diffuse_only: the base alone, albedo · (1 − metallic)/π.
static inline struct bsdf bsdf_of(vec3s normal, vec3s to_viewer,
                                  const struct bsdf_material *material, bool diffuse_only);
// Reserves at least `share` of the samples for the diffuse lobe, so that irradiance estimates
// converge on any material.
static inline void bsdf_reserve_diffuse_samples(struct bsdf *bsdf, float share);

struct reflection {
    vec3s f;   // 1/sr, without the cosine; 0 below the horizon
    float pdf; // of bsdf_sample, 1/sr
};
static inline struct reflection bsdf_reflect(const struct bsdf *bsdf,
                                             vec3s to_light); // to_light: unit
// The diffuse lobe alone towards a viewer, 1/sr: bsdf_of(…).diffuse.
static inline vec3s bsdf_diffuse_towards(vec3s normal, vec3s to_viewer,
                                         const struct bsdf_material *material, bool diffuse_only);
// An incident direction. choice (unit interval) selects the lobe, u (unit square) the direction.
// Some samples lie below the horizon, where f is 0.
static inline vec3s bsdf_sample(const struct bsdf *bsdf, float choice, vec2s u);

// ---- implementation

static const float BSDF_INV_PI = 0.31830988618f;
static const float BSDF_MIN_COSINE = 1e-4f;      // as in brdf.glsl: keeps G / (4 n·l n·v) finite
static const float BSDF_MIN_PROBABILITY = 0.05f; // of each lobe with albedo above 0

vec3s bsdf_mirrored_viewer(const struct bsdf *bsdf);
vec3s bsdf_sample_specular(const struct bsdf *bsdf, vec2s u);

// fmaxf and fminf compile to calls because of their NaN rules.
static inline float bsdf_max(float a, float b)
{
    return a > b ? a : b;
}

static inline float bsdf_clamp(float x, float low, float high)
{
    return x < low ? low : x < high ? x : high;
}

// Schlick 1994.
static inline vec3s bsdf_fresnel(const struct bsdf *b, float v_h)
{
    float m = 1.0f - v_h, m2 = m * m, s = m2 * m2 * m;
    return vec3_of(b->f0.x + (b->f90.x - b->f0.x) * s, b->f0.y + (b->f90.y - b->f0.y) * s,
                   b->f0.z + (b->f90.z - b->f0.z) * s);
}

static inline vec3s bsdf_to_world(const struct bsdf *b, vec3s v)
{
    vec3s p = glms_vec3_scale(b->tangent, v.x);
    p = glms_vec3_muladds(b->bitangent, v.y, p);
    return glms_vec3_muladds(b->normal, v.z, p);
}

// The largest channel of the dielectric lobe's albedo.
static inline float bsdf_dielectric_albedo(const struct bsdf_material *m, struct ggx_albedo e)
{
    const float ess = e.a + e.b, loss = (1.0f - ess) / ess;
    float reflected = 0.0f;
    for (int c = 0; c < 3; c++) {
        const float f0 = m->dielectric_f0.raw[c];
        reflected = bsdf_max(reflected, (f0 * e.a + m->dielectric_f90 * e.b) * (1.0f + f0 * loss));
    }
    return reflected;
}

// Sets the lobes at b->n_v.
static inline void bsdf_set_lobes(struct bsdf *b, const struct bsdf_material *m, float roughness)
{
    struct ggx_albedo e = ggx_albedo_at(b->n_v, roughness);
    float ess = e.a + e.b, loss = (1.0f - ess) / ess;
    float metal = m->metallic, dielectric = 1.0f - metal, f90 = m->dielectric_f90;
    for (int c = 0; c < 3; c++) {
        float f0 = m->dielectric_f0.raw[c], albedo = m->albedo.raw[c];
        float k = 1.0f + f0 * loss, k_metal = 1.0f + albedo * loss;
        b->f0.raw[c] = dielectric * f0 * k + metal * albedo * k_metal;
        b->f90.raw[c] = dielectric * f90 * k + metal * k_metal;
    }
    b->diffuse = glms_vec3_scale(b->diffuse, bsdf_max(1.0f - bsdf_dielectric_albedo(m, e), 0.0f));
    vec3s albedo = glms_vec3_muladds(b->f90, e.b, glms_vec3_scale(b->f0, e.a));
    float specular = luminance(albedo), diffuse = luminance(b->diffuse) / BSDF_INV_PI;
    if (!(specular > 0.0f)) return;
    b->specular_probability = 1.0f;
    if (diffuse > 0.0f)
        b->specular_probability = bsdf_clamp(specular / (specular + diffuse), BSDF_MIN_PROBABILITY,
                                             1.0f - BSDF_MIN_PROBABILITY);
}

static inline struct bsdf bsdf_of(vec3s normal, vec3s to_viewer, const struct bsdf_material *m,
                                  bool diffuse_only)
{
    float roughness = bsdf_clamp(m->roughness, GGX_MIN_ROUGHNESS, 1.0f);
    float alpha = roughness * roughness;
    struct bsdf b = {
        .normal = normal, .to_viewer = to_viewer, .alpha = alpha, .alpha2 = alpha * alpha
    };
    basis_of(normal, &b.tangent, &b.bitangent);
    b.diffuse = glms_vec3_scale(m->albedo, (1.0f - m->metallic) * BSDF_INV_PI);
    if (diffuse_only) return b;
    float n_v = glms_vec3_dot(normal, to_viewer);
    b.n_v = bsdf_clamp(fabsf(n_v), BSDF_MIN_COSINE, 1.0f);
    b.smith_v = sqrtf(b.n_v * b.n_v * (1.0f - b.alpha2) + b.alpha2);
    b.backfacing = n_v < BSDF_MIN_COSINE;
    b.lobe_viewer = b.backfacing ? bsdf_mirrored_viewer(&b) : to_viewer;
    bsdf_set_lobes(&b, m, roughness);
    return b;
}

static inline vec3s bsdf_diffuse_towards(vec3s normal, vec3s to_viewer,
                                         const struct bsdf_material *m, bool diffuse_only)
{
    const vec3s base = glms_vec3_scale(m->albedo, (1.0f - m->metallic) * BSDF_INV_PI);
    if (diffuse_only || !(m->dielectric_f90 > 0.0f)) return base;
    const float roughness = bsdf_clamp(m->roughness, GGX_MIN_ROUGHNESS, 1.0f);
    const float n_v = bsdf_clamp(fabsf(glms_vec3_dot(normal, to_viewer)), BSDF_MIN_COSINE, 1.0f);
    const float reflected = bsdf_dielectric_albedo(m, ggx_albedo_at(n_v, roughness));
    return glms_vec3_scale(base, bsdf_max(1.0f - reflected, 0.0f));
}

static inline void bsdf_reserve_diffuse_samples(struct bsdf *b, float share)
{
    if (b->specular_probability > 1.0f - share) b->specular_probability = 1.0f - share;
}

// GGX D at the half vector along `sum` (sum of two unit vectors, squared length `sum2`):
// α² / (π (sin² + α² cos²)²). The sine comes from the cross product to avoid cancellation.
static inline float bsdf_distribution(const struct bsdf *b, vec3s sum, float sum2)
{
    float cosine = bsdf_max(glms_vec3_dot(b->normal, sum), 0.0f);
    float base = glms_vec3_norm2(glms_vec3_cross(b->normal, sum)) + cosine * cosine * b->alpha2;
    float ratio = sum2 / base;
    return b->alpha2 * BSDF_INV_PI * ratio * ratio;
}

static inline struct reflection bsdf_reflect(const struct bsdf *b, vec3s to_light)
{
    float cosine = glms_vec3_dot(b->normal, to_light);
    struct reflection r = { .pdf = (1.0f - b->specular_probability) * bsdf_max(cosine, 0.0f) *
                                   BSDF_INV_PI };
    if (cosine > 0.0f) r.f = b->diffuse;
    if (!(b->specular_probability > 0.0f)) return r;
    vec3s sum = glms_vec3_add(b->lobe_viewer, to_light);
    float sum2 = glms_vec3_norm2(sum);
    if (!(sum2 > 0.0f)) return r; // opposite directions have no half vector
    float d = bsdf_distribution(b, sum, sum2);
    // Heitz 2018, eq. 17: D_v(h) / (4 v·h) = G1(v) D(h) / (4 n·v).
    if (glms_vec3_dot(b->normal, sum) > 0.0f)
        r.pdf += b->specular_probability * d / (2.0f * (b->n_v + b->smith_v));
    if (!(cosine > 0.0f)) return r;
    if (b->backfacing) {
        sum = glms_vec3_add(b->to_viewer, to_light);
        sum2 = glms_vec3_norm2(sum);
        if (!(sum2 > 0.0f)) return r;
        d = bsdf_distribution(b, sum, sum2);
    }
    float n_l = bsdf_clamp(cosine, BSDF_MIN_COSINE, 1.0f);
    float smith_l = sqrtf(n_l * n_l * (1.0f - b->alpha2) + b->alpha2);
    float scale = d * 0.5f / (n_l * b->smith_v + b->n_v * smith_l);
    float v_h = bsdf_clamp(0.5f * sqrtf(sum2), 0.0f, 1.0f); // |v + l|² = 2 + 2 v·l = 4 (v·h)²
    r.f = glms_vec3_muladds(bsdf_fresnel(b, v_h), scale, r.f);
    return r;
}

static inline vec3s bsdf_sample(const struct bsdf *b, float choice, vec2s u)
{
    if (choice < b->specular_probability) return bsdf_sample_specular(b, u);
    return bsdf_to_world(b, sample_hemisphere_cosine(u));
}
