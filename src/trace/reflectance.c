#include "trace/reflectance.h"

#include <math.h>

enum { COSINES = 16 };

// (A, B) of a lobe, averaged over the hemisphere: ∫ 2 μ E(μ) dμ.
static struct ggx_albedo mean_albedo(float roughness)
{
    struct ggx_albedo mean = { 0.0f, 0.0f };
    for (int i = 0; i < COSINES; i++) {
        const float cosine = ((float)i + 0.5f) / COSINES;
        const struct ggx_albedo at = ggx_albedo_at(cosine, fmaxf(roughness, GGX_MIN_ROUGHNESS));
        mean.a += at.a * 2.0f * cosine / COSINES;
        mean.b += at.b * 2.0f * cosine / COSINES;
    }
    return mean;
}

// Hemispherical albedo of a lobe with multiple scattering.
static vec3s lobe_albedo(struct ggx_albedo mean, vec3s f0, float f90)
{
    const float loss = (1.0f - mean.a - mean.b) / (mean.a + mean.b);
    vec3s albedo;
    for (int c = 0; c < 3; c++)
        albedo.raw[c] = (f0.raw[c] * mean.a + f90 * mean.b) * (1.0f + f0.raw[c] * loss);
    return albedo;
}

vec3s bsdf_reflectance(const struct bsdf_material *m)
{
    const struct ggx_albedo mean = mean_albedo(m->roughness);
    const vec3s lobe = lobe_albedo(mean, m->dielectric_f0, m->dielectric_f90);
    const vec3s metal = lobe_albedo(mean, m->albedo, 1.0f);
    const float transmitted = fminf(fmaxf(1.0f - glms_vec3_max(lobe), 0.0f), 1.0f);
    const vec3s dielectric = glms_vec3_muladds(m->albedo, transmitted, lobe);
    return glms_vec3_lerp(dielectric, metal, m->metallic);
}

vec3s surface_reflectance(const struct surface *surface)
{
    return surface->unlit ? vec3_of(0, 0, 0) : bsdf_reflectance(&surface->material);
}
