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

// fmaxf and fminf are calls, for the sake of NaN.
static inline float larger(float a, float b)
{
    return a > b ? a : b;
}

static inline float clamped(float x, float low, float high)
{
    return x < low ? low : x < high ? x : high;
}

static inline vec3s fresnel(vec3s f0, float v_h)
{
    float m = 1.0f - v_h, m2 = m * m, s = m2 * m2 * m;
    return vec3_of(f0.x + (1.0f - f0.x) * s, f0.y + (1.0f - f0.y) * s, f0.z + (1.0f - f0.z) * s);
}

static inline vec3s to_world(const struct bsdf *b, vec3s v)
{
    vec3s p = glms_vec3_scale(b->tangent, v.x);
    p = glms_vec3_muladds(b->bitangent, v.y, p);
    return glms_vec3_muladds(b->normal, v.z, p);
}

// The viewer as the sampler has it. Where the normal turns away from the viewer, the lobe of the
// mirrored viewer is sampled: what is reflected takes |n·v| likewise.
static void place_eye(struct bsdf *b)
{
    float n_v = glms_vec3_dot(b->normal, b->to_eye), a2 = b->alpha * b->alpha;
    b->n_v = clamped(fabsf(n_v), MIN_COSINE, 1.0f);
    b->smith_v = sqrtf(b->n_v * b->n_v * (1.0f - a2) + a2);
    b->turned = n_v < MIN_COSINE;
    b->local_eye = vec3_of(glms_vec3_dot(b->to_eye, b->tangent),
                           glms_vec3_dot(b->to_eye, b->bitangent), b->n_v);
    b->eye = b->to_eye;
    if (!b->turned) return;
    b->local_eye = glms_vec3_normalize(b->local_eye);
    b->eye = to_world(b, b->local_eye);
}

struct bsdf bsdf_of(vec3s normal, vec3s to_eye, vec3s albedo, float metallic, float roughness,
                    bool diffuse_only)
{
    float rough = larger(roughness, MIN_ROUGHNESS);
    struct bsdf b = { .normal = normal, .to_eye = to_eye, .alpha = rough * rough };
    basis_of(normal, &b.tangent, &b.bitangent);
    b.diffuse = glms_vec3_scale(albedo, (1.0f - metallic) * INV_PI);
    if (diffuse_only) return b;
    place_eye(&b);
    vec3s dielectric = vec3_of(0.04f, 0.04f, 0.04f);
    b.f0 = glms_vec3_lerp(dielectric, albedo, metallic);
    float gloss = luminance(fresnel(b.f0, b.n_v));
    float matte = luminance(b.diffuse) / INV_PI;
    b.gloss_share =
        matte > 0.0f ? clamped(gloss / (gloss + matte), MIN_SHARE, 1.0f - MIN_SHARE) : 1.0f;
    return b;
}

void bsdf_sample_evenly(struct bsdf *b, float share)
{
    b->gloss_share = fminf(b->gloss_share, 1.0f - share);
}

static inline vec3s half_vector(vec3s a, vec3s b)
{
    vec3s sum = glms_vec3_add(a, b);
    float length2 = glms_vec3_norm2(sum);
    return length2 > 0.0f ? glms_vec3_scale(sum, 1.0f / sqrtf(length2)) : sum;
}

// D of GGX at the half vector (brdf.glsl: sin² from the cross product keeps its digits).
static inline float distribution(const struct bsdf *b, vec3s h)
{
    vec3s cross = glms_vec3_cross(b->normal, h);
    float n_h = clamped(glms_vec3_dot(b->normal, h), 0.0f, 1.0f);
    float a2 = b->alpha * b->alpha;
    float base = glms_vec3_norm2(cross) + n_h * n_h * a2;
    return a2 * INV_PI / (base * base);
}

struct reflection bsdf_reflect(const struct bsdf *b, vec3s to_light)
{
    float cosine = glms_vec3_dot(b->normal, to_light);
    struct reflection r = { .pdf = (1.0f - b->gloss_share) * larger(cosine, 0.0f) * INV_PI };
    if (cosine > 0.0f) r.f = b->diffuse;
    if (!(b->gloss_share > 0.0f)) return r;
    vec3s h = half_vector(b->eye, to_light);
    float d = distribution(b, h);
    // Heitz 2018, eq. 17: D_v(h) / (4 v·h) = G1(v) D(h) / (4 n·v).
    if (glms_vec3_dot(b->normal, h) > 0.0f)
        r.pdf += b->gloss_share * d / (2.0f * (b->n_v + b->smith_v));
    if (!(cosine > 0.0f)) return r;
    if (b->turned) {
        h = half_vector(b->to_eye, to_light);
        d = distribution(b, h);
    }
    float n_l = clamped(cosine, MIN_COSINE, 1.0f), a2 = b->alpha * b->alpha;
    float smith_l = sqrtf(n_l * n_l * (1.0f - a2) + a2);
    float scale = d * 0.5f / (n_l * b->smith_v + b->n_v * smith_l);
    float v_h = clamped(glms_vec3_dot(b->to_eye, h), 0.0f, 1.0f);
    r.f = glms_vec3_muladds(fresnel(b->f0, v_h), scale, r.f);
    return r;
}

static vec3s sample_gloss(const struct bsdf *b, vec2s u)
{
    vec3s v = b->local_eye;
    vec3s stretched = glms_vec3_normalize(vec3_of(b->alpha * v.x, b->alpha * v.y, v.z));
    float length2 = stretched.x * stretched.x + stretched.y * stretched.y;
    vec3s t1 = length2 > 0.0f ? glms_vec3_scale(vec3_of(-stretched.y, stretched.x, 0.0f),
                                                1.0f / sqrtf(length2))
                              : vec3_of(1, 0, 0);
    vec3s t2 = glms_vec3_cross(stretched, t1);
    vec2s p = sample_disk(u);
    float s = 0.5f * (1.0f + stretched.z);
    float y = (1.0f - s) * sqrtf(larger(0.0f, 1.0f - p.x * p.x)) + s * p.y;
    float z = sqrtf(larger(0.0f, 1.0f - p.x * p.x - y * y));
    vec3s n = glms_vec3_scale(stretched, z);
    n = glms_vec3_muladds(t1, p.x, n);
    n = glms_vec3_muladds(t2, y, n);
    vec3s h = glms_vec3_normalize(vec3_of(b->alpha * n.x, b->alpha * n.y, larger(0.0f, n.z)));
    vec3s l = glms_vec3_sub(glms_vec3_scale(h, 2.0f * glms_vec3_dot(v, h)), v);
    return to_world(b, l);
}

vec3s bsdf_sample(const struct bsdf *b, float choice, vec2s u)
{
    if (choice < b->gloss_share) return sample_gloss(b, u);
    return to_world(b, sample_hemisphere_cosine(u));
}
