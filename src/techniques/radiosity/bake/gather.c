// Cosine-distributed rays. Emissive surfaces are also sampled by power, and both kinds of samples
// are weighted by the balance heuristic (Veach 1997, section 9.2): rays alone find small emitters
// by chance.
#include "techniques/radiosity/bake/gather.h"

#include "core/rng.h"
#include "core/sampling.h"
#include "trace/surface.h"

#include <math.h>

bool radiosity_scene_init(struct radiosity_scene *scene, struct host *host,
                          const struct scene_pose *pose, const struct radiosity_options *options,
                          struct radiosity_map *map)
{
    const size_t instances = (size_t)pose->scene->instance_count;
    *scene = (struct radiosity_scene){ .host = host, .options = *options, .map = *map };
    *map = (struct radiosity_map){ 0 };
    if (!scene_statics_init(&scene->statics, host, pose)) return false;
    if (!scene->map.host && !radiosity_map_init(&scene->map, host, &scene->statics.pose, options))
        return false;
    scene->trace = trace_scene_create(host, &scene->statics.pose);
    scene->mesh_of = host_alloc(host, instances, sizeof *scene->mesh_of);
    if (!scene->trace || !scene->mesh_of) return false;
    for (size_t i = 0; i < instances; i++) scene->mesh_of[i] = UINT32_MAX;
    for (uint32_t m = 0; m < scene->trace->mesh_count; m++)
        scene->mesh_of[scene->trace->meshes[m].instance] = m;
    return radiosity_divide(scene);
}

void radiosity_scene_finish(struct radiosity_scene *scene)
{
    if (!scene->host) return;
    trace_scene_destroy(scene->trace);
    scene_statics_finish(&scene->statics);
    host_free(scene->host, scene->mesh_of);
    host_free(scene->host, scene->part);
    host_free(scene->host, scene->is_group);
    radiosity_map_finish(&scene->map);
    *scene = (struct radiosity_scene){ 0 };
}

// ---- the receiver

struct receiver {
    vec3s position, normal, tangent, bitangent; // position: offset against self-intersection
    float rays, light_samples;
    uint32_t seed;
};

static const struct trace_mesh *mesh_of(const struct radiosity_scene *scene, uint32_t texel,
                                        const struct chart_triangle **triangle)
{
    *triangle = chart_triangle_of(&scene->map.charts, texel);
    return &scene->trace->meshes[scene->mesh_of[(*triangle)->instance]];
}

static struct receiver receiver_of(const struct radiosity_scene *scene, uint32_t texel,
                                   vec3s position, uint64_t seed)
{
    const struct chart_triangle *triangle;
    const struct trace_mesh *mesh = mesh_of(scene, texel, &triangle);
    struct receiver r = { .normal = chart_texel_normal(&scene->map.charts, texel),
                          .rays = (float)scene->options.rays,
                          .seed = (uint32_t)rng_mix(seed ^ (uint64_t)texel << 32) | 1u };
    if (scene->trace->lights.has_emitters)
        r.light_samples = (float)(scene->options.rays / RADIOSITY_RAYS_PER_LIGHT_SAMPLE);
    basis_of(r.normal, &r.tangent, &r.bitangent);
    r.position = glms_vec3_muladds(r.normal, mesh->facets[triangle->triangle].reach, position);
    return r;
}

// ---- emissive surfaces

// A sample of radiance; pdf_light: of light samples, for this direction.
static void add_emission(struct radiosity_gather *gather, const struct receiver *r, vec3s direction,
                         vec3s radiance, float pdf_light)
{
    const float cosine = glms_vec3_dot(direction, r->normal);
    const float density = r->rays * cosine / GLM_PIf + r->light_samples * pdf_light;
    if (!(cosine > 0.0f) || !(density > 0.0f)) return;
    for (int c = 0; c < 3; c++) {
        const float light = radiance.raw[c] / density;
        gather->emitted[c].irradiance += light * cosine;
        for (int k = 0; k < 3; k++) gather->emitted[c].vector[k] += light * direction.raw[k];
    }
}

bool radiosity_sample_emitter(const struct radiosity_scene *scene, vec3s position,
                              const vec3s *normal, uint32_t k, uint32_t count, uint32_t seed,
                              struct emitter_sample *out)
{
    const vec2s jitter = sobol_2d(k, pcg_hash(seed));
    const float choice = fminf(((float)k + jitter.x) / (float)count, 1.0f - 0x1p-24f);
    *out =
        light_sample_emitter(scene->trace, position, choice, sobol_2d(k, pcg_hash(seed + 1u) | 1u));
    if (!(out->pdf > 0.0f) || (normal && !(glms_vec3_dot(out->to_light, *normal) > 0.0f)))
        return false;
    return !trace_occluded(scene->trace, position, glms_vec3_sub(out->position, position), 1.0f);
}

static void sample_emitters(const struct radiosity_scene *scene, const struct receiver *r,
                            struct radiosity_gather *gather)
{
    const uint32_t count = (uint32_t)r->light_samples;
    for (uint32_t k = 0; k < count; k++) {
        struct emitter_sample s;
        if (radiosity_sample_emitter(scene, r->position, &r->normal, k, count, r->seed, &s))
            add_emission(gather, r, s.to_light, s.radiance, s.pdf);
    }
}

// ---- rays

static void add_sky(struct radiosity_gather *gather, const struct receiver *r, vec3s direction,
                    float cosine)
{
    gather->sky.irradiance += GLM_PIf / r->rays;
    for (int k = 0; k < 3; k++)
        gather->sky.vector[k] += GLM_PIf / r->rays * direction.raw[k] / cosine;
}

static void add_cluster(struct radiosity_gather *gather, const struct receiver *r, uint32_t cluster,
                        vec3s local)
{
    struct radiosity_factor *factor = &gather->factor[cluster];
    if (factor->weight == 0.0f) gather->met[gather->met_count++] = cluster;
    factor->weight += 1.0f / r->rays;
    factor->along[0] += local.x / (local.z * r->rays);
    factor->along[1] += local.y / (local.z * r->rays);
}

struct radiosity_seen radiosity_seen_at(const struct radiosity_scene *scene, const struct ray *ray,
                                        const struct ray_hit *hit)
{
    const struct trace_mesh *mesh = &scene->trace->meshes[hit->geometry];
    const float along = -glms_vec3_dot(mesh->facets[hit->triangle].normal, ray->direction);
    const bool back = along < 0.0f;
    struct radiosity_seen seen = { .cluster = CHART_NONE,
                                   .inside = back && !mesh->material->double_sided };
    if (seen.inside) return seen;
    if (mesh->material->emissive) {
        seen.emission = surface_emission(mesh, hit->triangle, hit->u, hit->v);
        seen.pdf = light_emitter_pdf(scene->trace, hit->geometry, hit->triangle, hit->distance,
                                     fabsf(along));
    }
    const uint32_t texel =
        chart_texel_at(&scene->map.charts, mesh->instance, hit->triangle, hit->u, hit->v, back);
    if (texel != CHART_NONE) seen.cluster = scene->map.cluster_of[texel];
    return seen;
}

static void add_hit(const struct radiosity_scene *scene, const struct receiver *r,
                    struct radiosity_gather *gather, const struct ray *ray,
                    const struct ray_hit *hit, vec3s local)
{
    const struct radiosity_seen seen = radiosity_seen_at(scene, ray, hit);
    if (glms_vec3_max(seen.emission) > 0.0f)
        add_emission(gather, r, ray->direction, seen.emission, seen.pdf);
    if (seen.cluster != CHART_NONE) add_cluster(gather, r, seen.cluster, local);
}

void radiosity_gather_clear(struct radiosity_gather *gather)
{
    struct radiosity_factor *factor = gather->factor;
    uint32_t *met = gather->met;
    for (uint32_t i = 0; i < gather->met_count; i++)
        factor[met[i]] = (struct radiosity_factor){ 0 };
    *gather = (struct radiosity_gather){ .factor = factor, .met = met };
}

// Directions along the surface have no finite weight in the vector irradiance.
static const float LEAST_COSINE = 1e-3f;
static const float LEAST_DISTANCE_M = 1e-6f;

void radiosity_gather(const struct radiosity_scene *scene, uint32_t texel, vec3s position,
                      uint64_t seed, struct radiosity_gather *gather)
{
    const struct receiver r = receiver_of(scene, texel, position, seed);
    radiosity_gather_clear(gather);
    for (uint32_t k = 0; k < (uint32_t)scene->options.rays; k++) {
        vec3s local = sample_hemisphere_cosine(sobol_2d(k, r.seed));
        local.z = fmaxf(local.z, LEAST_COSINE);
        struct ray ray = { r.position, glms_vec3_scale(r.normal, local.z), 0.0f, INFINITY };
        ray.direction = glms_vec3_muladds(r.tangent, local.x, ray.direction);
        ray.direction = glms_vec3_muladds(r.bitangent, local.y, ray.direction);
        struct ray_hit hit;
        if (embree_closest(scene->trace->embree, &ray, NULL, false, &hit)) {
            add_hit(scene, &r, gather, &ray, &hit, local);
            gather->inverse_distance += 1.0f / (fmaxf(hit.distance, LEAST_DISTANCE_M) * r.rays);
        } else {
            add_sky(gather, &r, ray.direction, local.z);
        }
    }
    sample_emitters(scene, &r, gather);
}
