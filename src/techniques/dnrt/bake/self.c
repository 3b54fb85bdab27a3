#include "techniques/dnrt/bake/self.h"

#include "core/sampling.h"
#include "trace/reflectance.h"

#include <math.h>

enum { MOST_BOUNCES = 16 };

static void add(int bands, const float *values, vec3s factor, vec3s *sum)
{
    for (int j = 0; j < SH_COUNT(bands); j++)
        sum[j] = glms_vec3_add(sum[j], glms_vec3_scale(factor, values[j]));
}

void dnrt_occluded(int bands, vec3s direction, float *out)
{
    static const float FACTORS[] = { 1.0f, 1.5f, 4.0f };
    sh_eval(bands, direction, out);
    for (int band = 0; band < bands; band++)
        for (int j = SH_COUNT(band); j < SH_COUNT(band + 1); j++) out[j] *= FACTORS[band];
}

vec3s dnrt_cosine_direction(const struct surface *surface, vec2s u)
{
    const vec3s local = sample_hemisphere_cosine(u);
    vec3s tangent, bitangent;
    basis_of(surface->normal, &tangent, &bitangent);
    const vec3s along = glms_vec3_scale(surface->normal, local.z);
    return glms_vec3_muladds(tangent, local.x, glms_vec3_muladds(bitangent, local.y, along));
}

void dnrt_reflected(const struct trace_scene *trace, int bands, bool self,
                    const struct surface *surface, struct rng *rng, vec3s *out)
{
    float values[SH_COUNT(3)];
    struct surface at = *surface;
    vec3s factor = surface_reflectance(&at);
    for (int j = 0; j < SH_COUNT(bands); j++) out[j] = vec3_of(0, 0, 0);
    sh_eval(bands, at.normal, values);
    add(bands, values, factor, out);
    for (int bounce = 0; self && bounce < MOST_BOUNCES; bounce++) {
        const float u = rng_float(rng);
        const vec3s direction = dnrt_cosine_direction(&at, (vec2s){ { u, rng_float(rng) } });
        const struct ray ray = { surface_leave(&at, direction), direction, 0.0f, INFINITY };
        struct ray_hit hit;
        if (!embree_closest(trace->embree, &ray, NULL, false, &hit)) return;
        dnrt_occluded(bands, direction, values);
        add(bands, values, glms_vec3_negate(factor), out);
        surface_at(trace, &ray, &hit, NULL, &at);
        factor = glms_vec3_mul(factor, surface_reflectance(&at));
        sh_eval(bands, at.normal, values);
        if (bounce + 1 < MOST_BOUNCES) add(bands, values, factor, out);
    }
}
