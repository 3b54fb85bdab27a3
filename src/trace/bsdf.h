// The BSDF of a surface: brdf.glsl on the CPU, with importance sampling. Lambert plus GGX; the
// specular lobe is sampled by the distribution of visible normals (bsdf.c), the diffuse lobe by the
// cosine.
//
// Functions called per ray are inline: passing vectors by value costs more than their arithmetic.
#pragma once

#include "core/sampling.h"

struct bsdf {
    vec3s normal, tangent, bitangent; // orthonormal
    vec3s to_viewer;                  // unit
    vec3s diffuse;                    // Lambertian BRDF, 1/sr: albedo · (1 − metallic) / π
    vec3s f0;                         // reflectance at normal incidence
    float alpha, alpha2;              // roughness², at least 0.045², and its square
    float specular_probability;       // of sampling the specular lobe; 0: no such lobe
    float n_v, smith_v;               // |n·v|, and the square root in Smith's term for the viewer
    vec3s lobe_viewer; // to_viewer; if backfacing, its mirror image on the normal's side
    bool backfacing;   // the shading normal points away from the viewer
};

// normal and to_viewer: unit. diffuse_only: without the specular lobe.
static inline struct bsdf bsdf_of(vec3s normal, vec3s to_viewer, vec3s albedo, float metallic,
                                  float roughness, bool diffuse_only);
// Reserves at least `share` of the samples for the diffuse lobe, so that irradiance estimates
// converge on any material.
static inline void bsdf_reserve_diffuse_samples(struct bsdf *bsdf, float share);

struct reflection {
    vec3s f;   // 1/sr, without the cosine; 0 below the horizon
    float pdf; // of bsdf_sample, 1/sr
};
static inline struct reflection bsdf_reflect(const struct bsdf *bsdf,
                                             vec3s to_light); // to_light: unit
// An incident direction. choice (unit interval) selects the lobe, u (unit square) the direction.
// Some samples lie below the horizon, where f is 0.
static inline vec3s bsdf_sample(const struct bsdf *bsdf, float choice, vec2s u);

// ---- implementation

static const float BSDF_INV_PI = 0.31830988618f;
static const float BSDF_MIN_ROUGHNESS = 0.045f;  // brdf.glsl: BRDF_MIN_ROUGHNESS
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

static inline vec3s bsdf_fresnel(vec3s f0, float v_h)
{
    float m = 1.0f - v_h, m2 = m * m, s = m2 * m2 * m;
    return vec3_of(f0.x + (1.0f - f0.x) * s, f0.y + (1.0f - f0.y) * s, f0.z + (1.0f - f0.z) * s);
}

static inline vec3s bsdf_to_world(const struct bsdf *b, vec3s v)
{
    vec3s p = glms_vec3_scale(b->tangent, v.x);
    p = glms_vec3_muladds(b->bitangent, v.y, p);
    return glms_vec3_muladds(b->normal, v.z, p);
}

static inline struct bsdf bsdf_of(vec3s normal, vec3s to_viewer, vec3s albedo, float metallic,
                                  float roughness, bool diffuse_only)
{
    float rough = bsdf_max(roughness, BSDF_MIN_ROUGHNESS), alpha = rough * rough;
    struct bsdf b = {
        .normal = normal, .to_viewer = to_viewer, .alpha = alpha, .alpha2 = alpha * alpha
    };
    basis_of(normal, &b.tangent, &b.bitangent);
    b.diffuse = glms_vec3_scale(albedo, (1.0f - metallic) * BSDF_INV_PI);
    if (diffuse_only) return b;
    float n_v = glms_vec3_dot(normal, to_viewer);
    b.n_v = bsdf_clamp(fabsf(n_v), BSDF_MIN_COSINE, 1.0f);
    b.smith_v = sqrtf(b.n_v * b.n_v * (1.0f - b.alpha2) + b.alpha2);
    b.backfacing = n_v < BSDF_MIN_COSINE;
    b.lobe_viewer = b.backfacing ? bsdf_mirrored_viewer(&b) : to_viewer;
    float d = 0.04f * (1.0f - metallic); // F0 of a dielectric is 0.04
    b.f0 = vec3_of(d + albedo.x * metallic, d + albedo.y * metallic, d + albedo.z * metallic);
    float specular = luminance(bsdf_fresnel(b.f0, b.n_v));
    float diffuse = luminance(albedo) * (1.0f - metallic);
    b.specular_probability = 1.0f;
    if (diffuse > 0.0f)
        b.specular_probability = bsdf_clamp(specular / (specular + diffuse), BSDF_MIN_PROBABILITY,
                                            1.0f - BSDF_MIN_PROBABILITY);
    return b;
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
    r.f = glms_vec3_muladds(bsdf_fresnel(b->f0, v_h), scale, r.f);
    return r;
}

static inline vec3s bsdf_sample(const struct bsdf *b, float choice, vec2s u)
{
    if (choice < b->specular_probability) return bsdf_sample_specular(b, u);
    return bsdf_to_world(b, sample_hemisphere_cosine(u));
}
