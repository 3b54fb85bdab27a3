// How a surface reflects: the frame's brdf.glsl on the CPU, with a sampler for it. Lambert plus
// GGX; the glossy lobe is sampled by the distribution of visible normals (bsdf.c), the diffuse one
// by the cosine.
//
// What every ray asks for is inline: three vectors handed from function to function cost more than
// the work.
#pragma once

#include "core/sampling.h"

struct bsdf {
    vec3s normal, tangent, bitangent; // an orthonormal frame
    vec3s to_eye;                     // unit
    vec3s diffuse;                    // Lambert's constant, 1/sr: albedo · (1 − metallic) / π
    vec3s f0;                         // reflectance at normal incidence
    float alpha, alpha2;              // roughness², at least 0.045², and its square
    float gloss_share;                // probability of sampling the glossy lobe; 0: there is none
    float n_v, smith_v;               // |n·v| and the root of Smith's term for the viewer
    vec3s eye;   // to_eye, or where `turned` its mirror image on the normal's side
    bool turned; // an interpolated normal turns away from the viewer
};

// normal and to_eye: unit. diffuse_only: Lambert's term alone.
static inline struct bsdf bsdf_of(vec3s normal, vec3s to_eye, vec3s albedo, float metallic,
                                  float roughness, bool diffuse_only);
// At least `share` of the samples go to Lambert's lobe, whatever the surface reflects: for those
// who measure irradiance.
static inline void bsdf_sample_evenly(struct bsdf *bsdf, float share);

struct reflection {
    vec3s f;   // 1/sr, without the cosine; 0 below the horizon
    float pdf; // of bsdf_sample, 1/sr
};
static inline struct reflection bsdf_reflect(const struct bsdf *bsdf,
                                             vec3s to_light); // to_light: unit
// A direction; choice picks the lobe, both from the unit interval and square. Below the horizon now
// and then: the light is lost there.
static inline vec3s bsdf_sample(const struct bsdf *bsdf, float choice, vec2s u);

// ---- how

static const float BSDF_INV_PI = 0.31830988618f;
static const float BSDF_MIN_ROUGHNESS = 0.045f; // brdf.glsl: BRDF_MIN_ROUGHNESS
static const float BSDF_MIN_COSINE = 1e-4f;     // there too: keeps G / (4 n·l n·v) finite
static const float BSDF_MIN_SHARE = 0.05f;      // of a lobe that reflects at all

vec3s bsdf_mirrored_eye(const struct bsdf *bsdf);
vec3s bsdf_sample_gloss(const struct bsdf *bsdf, vec2s u);

// fmaxf and fminf are calls, for the sake of NaN.
static inline float bsdf_larger(float a, float b)
{
    return a > b ? a : b;
}

static inline float bsdf_clamped(float x, float low, float high)
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

static inline struct bsdf bsdf_of(vec3s normal, vec3s to_eye, vec3s albedo, float metallic,
                                  float roughness, bool diffuse_only)
{
    float rough = bsdf_larger(roughness, BSDF_MIN_ROUGHNESS), alpha = rough * rough;
    struct bsdf b = { .normal = normal, .to_eye = to_eye, .alpha = alpha, .alpha2 = alpha * alpha };
    basis_of(normal, &b.tangent, &b.bitangent);
    b.diffuse = glms_vec3_scale(albedo, (1.0f - metallic) * BSDF_INV_PI);
    if (diffuse_only) return b;
    float n_v = glms_vec3_dot(normal, to_eye);
    b.n_v = bsdf_clamped(fabsf(n_v), BSDF_MIN_COSINE, 1.0f);
    b.smith_v = sqrtf(b.n_v * b.n_v * (1.0f - b.alpha2) + b.alpha2);
    b.turned = n_v < BSDF_MIN_COSINE;
    b.eye = b.turned ? bsdf_mirrored_eye(&b) : to_eye;
    float d = 0.04f * (1.0f - metallic); // a dielectric reflects 0.04
    b.f0 = vec3_of(d + albedo.x * metallic, d + albedo.y * metallic, d + albedo.z * metallic);
    float gloss = luminance(bsdf_fresnel(b.f0, b.n_v));
    float matte = luminance(albedo) * (1.0f - metallic);
    b.gloss_share = 1.0f;
    if (matte > 0.0f)
        b.gloss_share =
            bsdf_clamped(gloss / (gloss + matte), BSDF_MIN_SHARE, 1.0f - BSDF_MIN_SHARE);
    return b;
}

static inline void bsdf_sample_evenly(struct bsdf *b, float share)
{
    if (b->gloss_share > 1.0f - share) b->gloss_share = 1.0f - share;
}

// D of GGX at the half vector along `sum`, the sum of two unit vectors, of length² `sum2`: α² / (π
// (sin² + α² cos²)²), whose sine from the cross product keeps its digits (brdf.glsl).
static inline float bsdf_distribution(const struct bsdf *b, vec3s sum, float sum2)
{
    float cosine = bsdf_larger(glms_vec3_dot(b->normal, sum), 0.0f);
    float base = glms_vec3_norm2(glms_vec3_cross(b->normal, sum)) + cosine * cosine * b->alpha2;
    float ratio = sum2 / base;
    return b->alpha2 * BSDF_INV_PI * ratio * ratio;
}

static inline struct reflection bsdf_reflect(const struct bsdf *b, vec3s to_light)
{
    float cosine = glms_vec3_dot(b->normal, to_light);
    struct reflection r = { .pdf =
                                (1.0f - b->gloss_share) * bsdf_larger(cosine, 0.0f) * BSDF_INV_PI };
    if (cosine > 0.0f) r.f = b->diffuse;
    if (!(b->gloss_share > 0.0f)) return r;
    vec3s sum = glms_vec3_add(b->eye, to_light);
    float sum2 = glms_vec3_norm2(sum);
    if (!(sum2 > 0.0f)) return r; // light from straight behind
    float d = bsdf_distribution(b, sum, sum2);
    // Heitz 2018, eq. 17: D_v(h) / (4 v·h) = G1(v) D(h) / (4 n·v).
    if (glms_vec3_dot(b->normal, sum) > 0.0f)
        r.pdf += b->gloss_share * d / (2.0f * (b->n_v + b->smith_v));
    if (!(cosine > 0.0f)) return r;
    if (b->turned) {
        sum = glms_vec3_add(b->to_eye, to_light);
        sum2 = glms_vec3_norm2(sum);
        if (!(sum2 > 0.0f)) return r;
        d = bsdf_distribution(b, sum, sum2);
    }
    float n_l = bsdf_clamped(cosine, BSDF_MIN_COSINE, 1.0f);
    float smith_l = sqrtf(n_l * n_l * (1.0f - b->alpha2) + b->alpha2);
    float scale = d * 0.5f / (n_l * b->smith_v + b->n_v * smith_l);
    float v_h = bsdf_clamped(0.5f * sqrtf(sum2), 0.0f, 1.0f); // |v + l|² = 2 + 2 v·l = 4 (v·h)²
    r.f = glms_vec3_muladds(bsdf_fresnel(b->f0, v_h), scale, r.f);
    return r;
}

static inline vec3s bsdf_sample(const struct bsdf *b, float choice, vec2s u)
{
    if (choice < b->gloss_share) return bsdf_sample_gloss(b, u);
    return bsdf_to_world(b, sample_hemisphere_cosine(u));
}
