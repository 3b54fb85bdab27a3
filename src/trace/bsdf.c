// Lambert plus GGX, as brdf.glsl has them. The glossy lobe is sampled by the distribution of
// visible normals (Heitz 2018, "Sampling the GGX Distribution of Visible Normals", listing 1), the
// diffuse one by the cosine.
#include "trace/bsdf.h"

#include "core/sampling.h"

#include <math.h>

static const float INV_PI = 0.31830988618f;
static const float MIN_ROUGHNESS = 0.045f; // brdf.glsl: BRDF_MIN_ROUGHNESS
static const float MIN_COSINE = 1e-4f;     // there too: keeps G / (4 n·l n·v) finite
static const float MIN_SHARE = 0.05f;      // of a lobe that reflects at all

static float clampf(float x, float low, float high)
{
    return fminf(fmaxf(x, low), high);
}

static float schlick(float cosine)
{
    float m = 1.0f - cosine, m2 = m * m;
    return m2 * m2 * m;
}

static vec3s fresnel(vec3s f0, float v_h)
{
    float s = schlick(v_h);
    return vec3_of(f0.x + (1.0f - f0.x) * s, f0.y + (1.0f - f0.y) * s, f0.z + (1.0f - f0.z) * s);
}

struct bsdf bsdf_of(vec3s normal, vec3s to_eye, vec3s albedo, float metallic, float roughness,
                    bool diffuse_only)
{
    float rough = fmaxf(roughness, MIN_ROUGHNESS);
    struct bsdf b = { .normal = normal, .to_eye = to_eye, .alpha = rough * rough };
    basis_of(normal, &b.tangent, &b.bitangent);
    b.diffuse = glms_vec3_scale(albedo, (1.0f - metallic) * INV_PI);
    if (diffuse_only) return b;
    vec3s dielectric = vec3_of(0.04f, 0.04f, 0.04f);
    b.f0 = glms_vec3_lerp(dielectric, albedo, metallic);
    float n_v = clampf(fabsf(glms_vec3_dot(normal, to_eye)), MIN_COSINE, 1.0f);
    float gloss = luminance(fresnel(b.f0, n_v));
    float matte = luminance(b.diffuse) / INV_PI;
    b.gloss_share =
        matte > 0.0f ? clampf(gloss / (gloss + matte), MIN_SHARE, 1.0f - MIN_SHARE) : 1.0f;
    return b;
}

void bsdf_sample_evenly(struct bsdf *b, float share)
{
    b->gloss_share = fminf(b->gloss_share, 1.0f - share);
}

// D of GGX at the half vector (brdf.glsl: sin² from the cross product keeps its digits).
static float distribution(const struct bsdf *b, vec3s h)
{
    vec3s cross = glms_vec3_cross(b->normal, h);
    float n_h = clampf(glms_vec3_dot(b->normal, h), 0.0f, 1.0f);
    float a2 = b->alpha * b->alpha;
    float base = glms_vec3_dot(cross, cross) + n_h * n_h * a2;
    return a2 * INV_PI / (base * base);
}

static bool has_gloss(const struct bsdf *b)
{
    return b->gloss_share > 0.0f;
}

vec3s bsdf_eval(const struct bsdf *b, vec3s to_light)
{
    float cosine = glms_vec3_dot(b->normal, to_light);
    if (!(cosine > 0.0f)) return vec3_of(0, 0, 0);
    if (!has_gloss(b)) return b->diffuse;
    vec3s h = glms_vec3_normalize(glms_vec3_add(b->to_eye, to_light));
    float n_l = clampf(cosine, MIN_COSINE, 1.0f);
    float n_v = clampf(fabsf(glms_vec3_dot(b->normal, b->to_eye)), MIN_COSINE, 1.0f);
    float v_h = clampf(glms_vec3_dot(b->to_eye, h), 0.0f, 1.0f);
    float a2 = b->alpha * b->alpha;
    float smith_v = n_l * sqrtf(n_v * n_v * (1.0f - a2) + a2);
    float smith_l = n_v * sqrtf(n_l * n_l * (1.0f - a2) + a2);
    float scale = distribution(b, h) * 0.5f / (smith_v + smith_l);
    return glms_vec3_add(b->diffuse, glms_vec3_scale(fresnel(b->f0, v_h), scale));
}

// The viewer in the surface's frame. Where an interpolated normal turns away from the viewer, the
// lobe of the mirrored viewer is sampled: bsdf_eval takes |n·v| likewise.
static vec3s local_eye(const struct bsdf *b)
{
    vec3s v = vec3_of(glms_vec3_dot(b->to_eye, b->tangent), glms_vec3_dot(b->to_eye, b->bitangent),
                      fmaxf(fabsf(glms_vec3_dot(b->to_eye, b->normal)), MIN_COSINE));
    return glms_vec3_normalize(v);
}

static vec3s to_world(const struct bsdf *b, vec3s v)
{
    vec3s p = glms_vec3_scale(b->tangent, v.x);
    p = glms_vec3_muladds(b->bitangent, v.y, p);
    return glms_vec3_muladds(b->normal, v.z, p);
}

// Heitz 2018, eq. 17: D_v(h) / (4 v·h) = G1(v) D(h) / (4 n·v).
static float gloss_pdf(const struct bsdf *b, vec3s to_light)
{
    vec3s local = local_eye(b), eye = to_world(b, local);
    vec3s h = glms_vec3_normalize(glms_vec3_add(eye, to_light));
    if (!(glms_vec3_dot(h, b->normal) > 0.0f)) return 0.0f;
    float a2 = b->alpha * b->alpha;
    float root = sqrtf(a2 + (1.0f - a2) * local.z * local.z);
    return distribution(b, h) / (2.0f * (local.z + root));
}

float bsdf_pdf(const struct bsdf *b, vec3s to_light)
{
    float cosine = glms_vec3_dot(b->normal, to_light);
    float pdf = (1.0f - b->gloss_share) * fmaxf(cosine, 0.0f) * INV_PI;
    return has_gloss(b) ? pdf + b->gloss_share * gloss_pdf(b, to_light) : pdf;
}

static vec3s sample_gloss(const struct bsdf *b, vec2s u)
{
    vec3s v = local_eye(b);
    vec3s stretched = glms_vec3_normalize(vec3_of(b->alpha * v.x, b->alpha * v.y, v.z));
    float length2 = stretched.x * stretched.x + stretched.y * stretched.y;
    vec3s t1 = length2 > 0.0f ? glms_vec3_scale(vec3_of(-stretched.y, stretched.x, 0.0f),
                                                1.0f / sqrtf(length2))
                              : vec3_of(1, 0, 0);
    vec3s t2 = glms_vec3_cross(stretched, t1);
    vec2s p = sample_disk(u);
    float s = 0.5f * (1.0f + stretched.z);
    float y = (1.0f - s) * sqrtf(fmaxf(0.0f, 1.0f - p.x * p.x)) + s * p.y;
    float z = sqrtf(fmaxf(0.0f, 1.0f - p.x * p.x - y * y));
    vec3s n = glms_vec3_scale(stretched, z);
    n = glms_vec3_muladds(t1, p.x, n);
    n = glms_vec3_muladds(t2, y, n);
    vec3s h = glms_vec3_normalize(vec3_of(b->alpha * n.x, b->alpha * n.y, fmaxf(0.0f, n.z)));
    vec3s l = glms_vec3_sub(glms_vec3_scale(h, 2.0f * glms_vec3_dot(v, h)), v);
    return to_world(b, l);
}

vec3s bsdf_sample(const struct bsdf *b, float choice, vec2s u)
{
    if (choice < b->gloss_share) return sample_gloss(b, u);
    return to_world(b, sample_hemisphere_cosine(u));
}
