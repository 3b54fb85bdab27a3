#include "trace/texels/inside.h"

#include "core/rng.h"
#include "core/sampling.h"
#include "trace/trace_scene.h"

#include <math.h>

int inside_side_of(const struct trace_scene *scene, const struct ray *ray,
                   const struct ray_hit *hit)
{
    const struct trace_mesh *mesh = &scene->meshes[hit->geometry];
    if (mesh->material->double_sided) return 0;
    return glms_vec3_dot(mesh->facets[hit->triangle].normal, ray->direction) > 0.0f ? 1 : -1;
}

struct ray inside_ray(vec3s from, vec3s normal, uint32_t k)
{
    const vec3s local = sample_hemisphere_cosine(sobol_2d(k, 1));
    struct ray ray = { from, glms_vec3_scale(normal, local.z), 0.0f, INFINITY };
    vec3s u, v;
    basis_of(normal, &u, &v);
    ray.direction = glms_vec3_muladds(u, local.x, ray.direction);
    ray.direction = glms_vec3_muladds(v, local.y, ray.direction);
    return ray;
}

int inside_backs(const struct trace_scene *scene, vec3s from, vec3s normal, uint32_t first,
                 uint32_t end)
{
    int backs = 0;
    for (uint32_t k = first; k < end; k++) {
        const struct ray ray = inside_ray(from, normal, k);
        struct ray_hit hit;
        if (embree_closest(scene->embree, &ray, NULL, false, &hit))
            backs += inside_side_of(scene, &ray, &hit) > 0;
    }
    return backs;
}

struct crossed {
    const struct trace_scene *scene;
    const struct ray *ray;
    int sum;
};

static void cross(void *user, const struct ray_hit *hit)
{
    struct crossed *crossed = user;
    crossed->sum += inside_side_of(crossed->scene, crossed->ray, hit);
}

// Inside of a closed solid each ray meets one back more than outside, whatever else it passes: also
// where solids overlap, and the nearest surface is the front of another. Solids that touch share a
// plane: the back of one and the front of the other count, which are at one distance.
int inside_crossings(const struct trace_scene *scene, vec3s from, vec3s normal)
{
    struct crossed crossed = { scene, NULL, 0 };
    for (uint32_t k = 0; k < INSIDE_CROSSINGS; k++) {
        const struct ray ray = inside_ray(from, normal, k);
        crossed.ray = &ray;
        embree_all_hits(scene->embree, &ray, cross, &crossed);
    }
    return crossed.sum;
}

bool inside_solid(const struct trace_scene *scene, vec3s from, vec3s normal)
{
    return is_inside(inside_backs(scene, from, normal, 0, INSIDE_RAYS), INSIDE_RAYS) ||
           inside_crossings(scene, from, normal) > INSIDE_CROSSINGS / 2;
}
