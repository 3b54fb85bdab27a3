// Rays are distributed by the cosine to n_o over the cone around the bounding sphere, or over the
// hemisphere from a point inside of it: sin²θ ≤ s², density cosθ/(π s²).
#include "techniques/dnrt/bake/transfer.h"

#include "core/rng.h"
#include "core/sampling.h"
#include "trace/reflectance.h"

#include <math.h>

// What one ray met adds to the sums.
static void add_hit(const struct dnrt_sampling *how, const struct ray *ray,
                    const struct ray_hit *hit, struct dnrt_transfer *sum)
{
    const int count = SH_COUNT(how->bands);
    float at_normal[DNRT_MAX_COEFFICIENTS], at_direction[DNRT_MAX_COEFFICIENTS];
    struct surface surface;
    surface_at(how->trace, ray, hit, NULL, &surface);
    const vec3s reflectance = surface_reflectance(&surface);
    sh_eval(how->bands, surface.normal, at_normal);
    sh_eval(how->bands, ray->direction, at_direction);
    for (int j = 0; j < count; j++) {
        sum->reflected[j] = glms_vec3_muladds(reflectance, at_normal[j], sum->reflected[j]);
        sum->hidden[j] += at_direction[j];
    }
    if (!surface.front && !how->trace->meshes[hit->geometry].material->double_sided)
        sum->inside += 1.0f;
}

static void scale(struct dnrt_transfer *sum, int count, float factor)
{
    for (int j = 0; j < count; j++) {
        sum->reflected[j] = glms_vec3_scale(sum->reflected[j], factor);
        sum->hidden[j] *= factor;
    }
}

struct dnrt_transfer dnrt_transfer_at(const struct dnrt_sampling *how, vec3s point, uint32_t seed)
{
    struct dnrt_transfer sum = { .inside = 0.0f };
    const vec3s to_centre = glms_vec3_sub(how->centre, point);
    const vec3s n_o = vec3_unit(to_centre);
    const float sine = fminf(how->radius / fmaxf(glms_vec3_norm(to_centre), 1e-20f), 1.0f);
    vec3s tangent, bitangent;
    basis_of(n_o, &tangent, &bitangent);
    for (uint32_t i = 0; i < (uint32_t)how->rays; i++) {
        const vec2s disk = glms_vec2_scale(sample_disk(sobol_2d(i, seed)), sine);
        const float cosine = sqrtf(fmaxf(1.0f - glms_vec2_norm2(disk), 0.0f));
        struct ray ray = { point, glms_vec3_scale(n_o, cosine), 0.0f, INFINITY };
        ray.direction = glms_vec3_muladds(tangent, disk.x, ray.direction);
        ray.direction = glms_vec3_muladds(bitangent, disk.y, ray.direction);
        struct ray_hit hit;
        if (embree_closest(how->trace->embree, &ray, NULL, false, &hit))
            add_hit(how, &ray, &hit, &sum);
    }
    sum.inside /= (float)how->rays;
    scale(&sum, SH_COUNT(how->bands), sine * sine / (GLM_PIf * (float)how->rays));
    return sum;
}
