// Sampling of the GGX distribution of visible normals (Heitz 2018, "Sampling the GGX Distribution
// of Visible Normals", listing 1).
#include "trace/bsdf.h"

#include <math.h>

static vec3s in_frame(const struct bsdf *b, vec3s v, float z)
{
    return vec3_of(glms_vec3_dot(v, b->tangent), glms_vec3_dot(v, b->bitangent), z);
}

// A backfacing shading normal uses the lobe of the mirrored viewer, as the BRDF uses |n·v|.
vec3s bsdf_mirrored_viewer(const struct bsdf *b)
{
    return bsdf_to_world(b, glms_vec3_normalize(in_frame(b, b->to_viewer, b->n_v)));
}

vec3s bsdf_sample_specular(const struct bsdf *b, vec2s u)
{
    vec3s v = in_frame(b, b->lobe_viewer,
                       bsdf_max(glms_vec3_dot(b->lobe_viewer, b->normal), BSDF_MIN_COSINE));
    vec3s stretched = glms_vec3_normalize(vec3_of(b->alpha * v.x, b->alpha * v.y, v.z));
    float length2 = stretched.x * stretched.x + stretched.y * stretched.y;
    vec3s t1 = length2 > 0.0f ? glms_vec3_scale(vec3_of(-stretched.y, stretched.x, 0.0f),
                                                1.0f / sqrtf(length2))
                              : vec3_of(1, 0, 0);
    vec3s t2 = glms_vec3_cross(stretched, t1);
    vec2s p = sample_disk(u);
    float s = 0.5f * (1.0f + stretched.z);
    float y = (1.0f - s) * sqrtf(bsdf_max(0.0f, 1.0f - p.x * p.x)) + s * p.y;
    float z = sqrtf(bsdf_max(0.0f, 1.0f - p.x * p.x - y * y));
    vec3s n = glms_vec3_scale(stretched, z);
    n = glms_vec3_muladds(t1, p.x, n);
    n = glms_vec3_muladds(t2, y, n);
    vec3s h = glms_vec3_normalize(vec3_of(b->alpha * n.x, b->alpha * n.y, bsdf_max(0.0f, n.z)));
    vec3s l = glms_vec3_sub(glms_vec3_scale(h, 2.0f * glms_vec3_dot(v, h)), v);
    return bsdf_to_world(b, l);
}
