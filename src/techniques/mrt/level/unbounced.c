// Irradiance of emissive surfaces and of the sky, by two kinds of samples that are weighed by the
// balance heuristic (Veach & Guibas 1995): cosine-distributed rays, good for emitters that fill the
// hemisphere, and the frame's virtual point lights with shadow rays, good for small ones.
//
// Densities are samples per square metre of emitter: a point has the mean one of its instance, a
// ray N cosθ cosθ' / (π d²) at distance d.
#include "unbounced.h"

#include "core/parallel.h"
#include "core/rng.h"
#include "core/sampling.h"
#include "frame/emitters.h"

#include <math.h>

enum {
    POINTS = 128, // at most, per texel, evenly spaced in the list
    PROBES = 8,   // rays per texel that find out whether the sky is seen at all
    RAYS = 64,
};

// Of the distance: rays end before the emitter and begin before the texel's surface.
static const float SHORTENED = 1e-3f;

struct job {
    const struct trace_scene *scene;
    const struct emitters *emitters;
    const float *points_per_m2; // [instances], of all points
    struct mrt_scene_images *images;
    int rays;
};

static vec3s above(const struct mrt_geometry_texel *texel, float distance)
{
    return glms_vec3_muladds(texel->normal, SHORTENED * distance, texel->position);
}

// Rays per square metre of an emitter at distance d.
static float ray_density(const struct job *job, float cosines, float distance2)
{
    return (float)job->rays * cosines / (GLM_PIf * distance2);
}

// Lux from one point. share: of all points over those taken.
static vec3s light_of_point(const struct job *job, const struct mrt_geometry_texel *texel, int i,
                            float share)
{
    const struct frame_emitter *point = &job->emitters->points[i];
    vec3s to = glms_vec3_sub(point->position, texel->position), dark = vec3_of(0, 0, 0);
    float distance2 = glms_vec3_norm2(to), receiver = glms_vec3_dot(to, texel->normal);
    float emitter = -glms_vec3_dot(to, point->normal);
    if (!(receiver > 0.0f && emitter > 0.0f)) return dark;
    vec3s from = above(texel, sqrtf(distance2));
    if (trace_occluded(job->scene, from, glms_vec3_sub(point->position, from), 1.0f - SHORTENED))
        return dark;
    float cosines = receiver * emitter / distance2;
    float density = job->points_per_m2[job->emitters->origins[i].instance] / share;
    float weight = density / (density + ray_density(job, cosines, distance2));
    return glms_vec3_scale(point->flux, weight * share * cosines / (GLM_PIf * distance2));
}

// Each texel takes another subset, so that errors do not line up.
static void gather_points(const struct job *job, size_t i)
{
    const struct mrt_geometry_texel *texel = &job->images->geometry[i];
    const int count = job->emitters->count, step = (count + POINTS - 1) / POINTS;
    if (count == 0) return;
    const int first = (int)(pcg_hash((uint32_t)i) % (uint32_t)step);
    const int taken = (count - first + step - 1) / step;
    const float share = (float)count / (float)taken;
    for (int k = first; k < count; k += step)
        job->images->emitted[i] =
            glms_vec3_add(job->images->emitted[i], light_of_point(job, texel, k, share));
}

static vec3s turned_to(vec3s normal, vec3s local)
{
    vec3s side = fabsf(normal.y) < 0.7f ? vec3_of(0, 1, 0) : vec3_of(1, 0, 0);
    vec3s u = vec3_unit(glms_vec3_cross(side, normal)), v = glms_vec3_cross(normal, u);
    return glms_vec3_add(glms_vec3_muladds(u, local.x, glms_vec3_scale(v, local.y)),
                         glms_vec3_scale(normal, local.z));
}

// π times the radiance of one ray's hit, weighed against points.
static vec3s light_of_hit(const struct job *job, const struct mrt_geometry_texel *texel,
                          vec3s direction, const struct trace_hit *hit)
{
    const int count = job->emitters->count, step = (count + POINTS - 1) / POINTS;
    if (count == 0) return vec3_of(0, 0, 0);
    float cosines =
        glms_vec3_dot(texel->normal, direction) * fabsf(glms_vec3_dot(hit->geometric, direction));
    float rays = ray_density(job, cosines, fmaxf(hit->distance * hit->distance, 1e-12f));
    float points = job->points_per_m2[hit->instance] / (float)step;
    return glms_vec3_scale(hit->emission, GLM_PIf * rays / fmaxf(rays + points, 1e-30f));
}

static void gather_rays(const struct job *job, size_t i)
{
    const struct mrt_geometry_texel *texel = &job->images->geometry[i];
    vec3s emitted = vec3_of(0, 0, 0), from = above(texel, 1.0f);
    int sky = 0;
    for (int k = 0; k < job->rays; k++) {
        vec2s u = sobol_2d((uint32_t)k, pcg_hash((uint32_t)i) | 1u);
        vec3s direction = turned_to(texel->normal, sample_hemisphere_cosine(u));
        struct trace_hit hit;
        if (!trace_closest(job->scene, from, direction, INFINITY, &hit))
            sky++;
        else
            emitted = glms_vec3_add(emitted, light_of_hit(job, texel, direction, &hit));
    }
    job->images->sky[i] = (float)sky / (float)job->rays;
    job->images->emitted[i] = glms_vec3_divs(emitted, (float)job->rays);
}

static void gather(void *user, size_t i)
{
    const struct job *job = user;
    if (!job->images->geometry[i].found) return;
    gather_rays(job, i);
    gather_points(job, i);
}

static bool sees_sky(const struct mrt_scene_images *images, int texels)
{
    for (int i = 0; i < texels; i++)
        if (images->sky[i] > 0.0f) return true;
    return false;
}

// Points over area, of each instance.
static float *density_of_points(struct host *host, const struct emitters *emitters, int instances)
{
    float *density = host_alloc(host, (size_t)instances, sizeof *density);
    float *area = host_alloc(host, (size_t)instances, sizeof *area);
    for (int i = 0; density && area && i < emitters->count; i++) {
        density[emitters->origins[i].instance] += 1.0f;
        area[emitters->origins[i].instance] += emitters->origins[i].area_m2;
    }
    for (int i = 0; density && area && i < instances; i++)
        density[i] = area[i] > 0.0f ? density[i] / area[i] : 0.0f;
    if (!area) {
        host_free(host, density);
        density = NULL;
    }
    host_free(host, area);
    return density;
}

static bool gather_all(struct mrt_scene_images *images, const struct emitters *emitters,
                       const struct trace_scene *scene, int instances, size_t texels)
{
    float *density = density_of_points(images->host, emitters, instances);
    struct job job = { scene, emitters, density, images, emitters->count > 0 ? RAYS : PROBES };
    if (!density) return false;
    parallel_for(texels, 64, gather, &job);
    if (job.rays == PROBES && sees_sky(images, (int)texels)) {
        job.rays = RAYS;
        parallel_for(texels, 64, gather, &job);
    }
    host_free(images->host, density);
    return true;
}

static bool trace_light(struct mrt_scene_images *images, const struct scene_pose *pose,
                        const struct trace_scene *scene, int texels)
{
    struct emitters emitters = { 0 };
    bool ok = emitters_init(&emitters, images->host, pose->scene);
    if (ok) {
        emitters_update(&emitters, pose);
        ok = gather_all(images, &emitters, scene, pose->scene->instance_count, (size_t)texels);
    }
    emitters_finish(&emitters);
    return ok;
}

bool mrt_scene_images_init(struct host *host, const struct scene_pose *pose,
                           const struct mrt_block_map *map, const struct mrt_atlas *atlas,
                           struct mrt_scene_images *out)
{
    *out = (struct mrt_scene_images){ .host = host };
    struct trace_scene *scene = trace_scene_create(host, pose);
    if (!scene) return false;
    out->geometry = mrt_geometry_create(host, map, atlas, scene);
    out->emitted = host_alloc(host, (size_t)atlas->texels, sizeof *out->emitted);
    out->sky = host_alloc(host, (size_t)atlas->texels, sizeof *out->sky);
    bool ok =
        out->geometry && out->emitted && out->sky && trace_light(out, pose, scene, atlas->texels);
    trace_scene_destroy(scene);
    return ok;
}

void mrt_scene_images_finish(struct mrt_scene_images *images)
{
    if (!images->host) return;
    host_free(images->host, images->geometry);
    host_free(images->host, images->emitted);
    host_free(images->host, images->sky);
    *images = (struct mrt_scene_images){ 0 };
}
