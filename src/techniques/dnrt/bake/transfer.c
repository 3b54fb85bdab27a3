// Rays in the cone around the bounding sphere. With one normal they are cosine-weighted about n_o:
// sin²θ ≤ s², density cosθ/(π s²); from inside the sphere, in the hemisphere. With several normals
// they are uniform; from inside, over all directions.
#include "techniques/dnrt/bake/transfer.h"

#include "core/rng.h"
#include "core/sampling.h"
#include "techniques/dnrt/bake/self.h"
#include "trace/reflectance.h"
#include "trace/texels/inside.h"

#include <math.h>

struct cone {
    vec3s axes[3]; // the last one is n_o
    float sine2;   // of its half angle
    float height;  // 1 − cos of the half angle; 2 from inside
};

static struct cone cone_of(const struct dnrt_sampling *how, vec3s point)
{
    const vec3s to_centre = glms_vec3_sub(how->centre, point);
    const float sine = how->radius / fmaxf(glms_vec3_norm(to_centre), 1e-20f);
    struct cone cone = { .axes[2] = vec3_unit(to_centre), .sine2 = fminf(sine * sine, 1.0f) };
    cone.height = sine < 1.0f ? cone.sine2 / (1.0f + sqrtf(1.0f - cone.sine2)) : 2.0f;
    basis_of(cone.axes[2], &cone.axes[0], &cone.axes[1]);
    return cone;
}

static vec3s direction_in(const struct cone *cone, const struct dnrt_sampling *how, vec2s u)
{
    const vec2s disk = sample_disk(u);
    const float radius2 = glms_vec2_norm2(disk);
    float cosine = sqrtf(fmaxf(1.0f - cone->sine2 * radius2, 0.0f)), scale = sqrtf(cone->sine2);
    if (how->normals > 1) {
        const float height = cone->height * radius2;
        cosine = 1.0f - height;
        scale = sqrtf(cone->height * (2.0f - height)); // the sine over the radius
    }
    const vec3s along = glms_vec3_scale(cone->axes[2], cosine);
    return glms_vec3_muladds(cone->axes[0], scale * disk.x,
                             glms_vec3_muladds(cone->axes[1], scale * disk.y, along));
}

// The cosine g of each normal over the density of the direction, without 1/π².
static void weights_of(const struct cone *cone, const struct dnrt_sampling *how, vec3s direction,
                       float *weights)
{
    const float area = 2.0f * GLM_PIf * cone->height;
    if (how->normals == 1) weights[0] = GLM_PIf * cone->sine2;
    for (int i = 0; how->normals > 1 && i < how->normals; i++) {
        const float cosine = direction.raw[how->normals == 3 ? i : i / 2];
        weights[i] = area * (how->normals == 3 ? cosine : fmaxf(i % 2 ? -cosine : cosine, 0.0f));
    }
}

// Adds the hit of a ray to the sums.
static void add_hit(const struct dnrt_sampling *how, const struct ray *ray,
                    const struct ray_hit *hit, const float *weights, struct rng *rng,
                    struct dnrt_transfer *sum)
{
    float at_direction[DNRT_MAX_COEFFICIENTS];
    vec3s reflected[DNRT_MAX_COEFFICIENTS];
    struct surface surface;
    surface_at(how->trace, ray, hit, NULL, &surface);
    dnrt_reflected(how->trace, how->bands, how->self, &surface, rng, reflected);
    sh_eval(how->bands, ray->direction, at_direction);
    for (int i = 0; i < how->normals; i++)
        for (int j = 0; j < SH_COUNT(how->bands); j++) {
            struct dnrt_vectors *of = &sum->of[i];
            of->reflected[j] = glms_vec3_muladds(reflected[j], weights[i], of->reflected[j]);
            of->hidden[j] += weights[i] * at_direction[j];
        }
    sum->backs += inside_side_of(how->trace, ray, hit) > 0;
}

static void scale(const struct dnrt_sampling *how, struct dnrt_transfer *sum)
{
    const float factor = 1.0f / (GLM_PIf * GLM_PIf * (float)how->rays);
    for (int i = 0; i < how->normals; i++)
        for (int j = 0; j < SH_COUNT(how->bands); j++) {
            sum->of[i].reflected[j] = glms_vec3_scale(sum->of[i].reflected[j], factor);
            sum->of[i].hidden[j] *= factor;
        }
}

void dnrt_transfer_at(const struct dnrt_sampling *how, vec3s point, uint32_t seed,
                      struct dnrt_transfer *out)
{
    const struct cone cone = cone_of(how, point);
    struct rng rng = rng_for(seed, 0, 0);
    *out = (struct dnrt_transfer){ .backs = 0 };
    for (uint32_t i = 0; i < (uint32_t)how->rays; i++) {
        const struct ray ray = { point, direction_in(&cone, how, sobol_2d(i, seed)), 0.0f,
                                 INFINITY };
        float weights[DNRT_MAX_NORMALS];
        struct ray_hit hit;
        if (!embree_closest(how->trace->embree, &ray, NULL, false, &hit)) continue;
        weights_of(&cone, how, ray.direction, weights);
        add_hit(how, &ray, &hit, weights, &rng, out);
    }
    scale(how, out);
}
