#include "trace/reflectance.h"

#include <math.h>

enum { COSINES = 16 };

// Hemispherical albedo of the dielectric's lobe with multiple scattering: ∫ 2 μ E(μ) dμ.
static vec3s lobe_albedo(const struct bsdf_material *m)
{
    const float roughness = fmaxf(m->roughness, GGX_MIN_ROUGHNESS);
    float a = 0.0f, b = 0.0f;
    for (int i = 0; i < COSINES; i++) {
        const float cosine = ((float)i + 0.5f) / COSINES;
        const struct ggx_albedo at = ggx_albedo_at(cosine, roughness);
        a += at.a * 2.0f * cosine / COSINES;
        b += at.b * 2.0f * cosine / COSINES;
    }
    const float loss = (1.0f - a - b) / (a + b);
    vec3s albedo;
    for (int c = 0; c < 3; c++)
        albedo.raw[c] = (m->dielectric_f0.raw[c] * a + m->dielectric_f90 * b) *
                        (1.0f + m->dielectric_f0.raw[c] * loss);
    return albedo;
}

vec3s surface_reflectance(const struct surface *surface)
{
    if (surface->unlit) return vec3_of(0, 0, 0);
    const struct bsdf_material *m = &surface->material;
    const vec3s lobe = lobe_albedo(m);
    const float transmitted = fminf(fmaxf(1.0f - glms_vec3_max(lobe), 0.0f), 1.0f);
    const vec3s sum = glms_vec3_muladds(m->albedo, transmitted, lobe);
    return glms_vec3_scale(sum, 1.0f - m->metallic);
}
