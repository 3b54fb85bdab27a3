// Irradiance of emissive surfaces and of the sky at texels: points and cosine-distributed rays.
#include "unbounced.h"

#include "techniques/mrt/level/unbounced_samples.h"

#include "core/parallel.h"
#include "core/rng.h"
#include "core/sampling.h"

#include <math.h>
#include <string.h>

enum {
    PROBES = 8, // rays per texel that find out whether the sky is seen at all
    RAYS = 64,
};

static const float RAY_OFFSET = 1e-3f; // m, along the normal

struct job {
    struct mrt_emitter_samples samples;
    struct mrt_scene_images *images;
};

static struct mrt_receiver receiver_of(const struct job *job, size_t i)
{
    const struct mrt_geometry_texel *texel = &job->images->geometry[i];
    return (struct mrt_receiver){ texel->position, texel->normal };
}

static void gather_points(const struct job *job, size_t i)
{
    const struct mrt_receiver at = receiver_of(job, i);
    const struct mrt_point_subset subset = mrt_points_of(&job->samples, i);
    for (int k = subset.first; k < job->samples.emitters->count; k += subset.step) {
        vec3s direction, light = mrt_light_of_point(&job->samples, &at, k, &subset, &direction);
        float cosine = fmaxf(glms_vec3_dot(direction, at.normal), 0.0f);
        job->images->emitted[i] = glms_vec3_muladds(light, cosine, job->images->emitted[i]);
    }
}

static vec3s turned_to(vec3s normal, vec3s local)
{
    vec3s side = fabsf(normal.y) < 0.7f ? vec3_of(0, 1, 0) : vec3_of(1, 0, 0);
    vec3s u = vec3_unit(glms_vec3_cross(side, normal)), v = glms_vec3_cross(normal, u);
    return glms_vec3_add(glms_vec3_muladds(u, local.x, glms_vec3_scale(v, local.y)),
                         glms_vec3_scale(normal, local.z));
}

static void gather_rays(const struct job *job, size_t i)
{
    const struct mrt_receiver at = receiver_of(job, i);
    vec3s emitted = vec3_of(0, 0, 0);
    vec3s from = glms_vec3_muladds(at.normal, RAY_OFFSET, at.position);
    int sky = 0;
    for (int k = 0; k < job->samples.rays; k++) {
        vec2s u = sobol_2d((uint32_t)k, pcg_hash((uint32_t)i) | 1u);
        vec3s direction = turned_to(at.normal, sample_hemisphere_cosine(u));
        struct trace_hit hit;
        if (!trace_closest(job->samples.scene, from, direction, INFINITY, &hit))
            sky++;
        else
            emitted = glms_vec3_add(emitted, mrt_light_of_hit(&job->samples, &at, direction, &hit));
    }
    job->images->sky[i] = (float)sky / (float)job->samples.rays;
    job->images->emitted[i] = glms_vec3_divs(emitted, (float)job->samples.rays);
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

static void gather_all(struct job *job, size_t texels)
{
    const bool emitters = job->samples.emitters->count > 0;
    job->samples.rays = emitters ? RAYS : PROBES;
    parallel_for(texels, 64, gather, job);
    if (emitters || !sees_sky(job->images, (int)texels)) return;
    job->samples.rays = RAYS;
    parallel_for(texels, 64, gather, job);
}

// What light is traced onto.
struct level_points {
    const struct mrt_block_map *map;
    const struct mrt_atlas *atlas;
    int probes;
};

static bool gather_probes(struct job *job, const struct level_points *level)
{
    struct mrt_scene_images *images = job->images;
    const size_t count = (size_t)level->map->count * (size_t)mrt_probes_of_block(level->probes);
    // Texels have found neither emitters nor the sky.
    if (job->samples.rays == PROBES)
        images->unbounced = host_alloc(images->host, count, sizeof *images->unbounced);
    else
        images->unbounced =
            mrt_unbounced_probes_create(images->host, level->map, level->probes, &job->samples);
    return images->unbounced;
}

// level: of the probes; NULL: texels alone.
static bool trace_light(struct mrt_scene_images *images, const struct scene_pose *pose,
                        const struct trace_scene *scene, size_t texels,
                        const struct level_points *level)
{
    struct emitters emitters = { 0 };
    struct job job = { .images = images };
    bool ok = emitters_init(&emitters, images->host, pose->scene);
    if (ok) emitters_update(&emitters, pose);
    ok = ok && mrt_emitter_samples_init(&job.samples, images->host, scene, &emitters,
                                        pose->scene->instance_count);
    if (ok) {
        gather_all(&job, texels);
        ok = !level || ((level->probes == 0 || gather_probes(&job, level)) &&
                        mrt_outdoors_init(images->host, level->map, pose->bounds, &job.samples,
                                          &images->outdoors));
    }
    mrt_emitter_samples_finish(&job.samples);
    emitters_finish(&emitters);
    return ok;
}

static struct mrt_geometry_texel *geometry_of(struct host *host, const struct scene_pose *walls,
                                              const struct mrt_block_map *map,
                                              const struct mrt_atlas *atlas)
{
    struct trace_scene *scene = trace_scene_create(host, walls);
    struct mrt_geometry_texel *out = scene ? mrt_geometry_create(host, map, atlas, scene) : NULL;
    trace_scene_destroy(scene);
    return out;
}

static struct mrt_geometry_texel *copy_of(struct host *host, const struct mrt_geometry_texel *from,
                                          size_t count)
{
    struct mrt_geometry_texel *out = host_alloc(host, count, sizeof *out);
    if (out) memcpy(out, from, count * sizeof *out);
    return out;
}

bool mrt_scene_images_init(struct host *host, const struct scene_pose *pose,
                           const struct scene_pose *walls, const struct mrt_block_map *map,
                           const struct mrt_atlas *atlas, int probes,
                           const struct mrt_geometry_texel *kept, struct mrt_scene_images *out)
{
    const struct level_points level = { map, atlas, probes };
    const size_t texels = (size_t)atlas->texels;
    *out = (struct mrt_scene_images){ .host = host };
    struct trace_scene *scene = trace_scene_create(host, pose);
    bool ok = scene;
    if (ok) {
        out->geometry = kept            ? copy_of(host, kept, texels)
                        : walls == pose ? mrt_geometry_create(host, map, atlas, scene)
                                        : geometry_of(host, walls, map, atlas);
        out->emitted = host_alloc(host, texels, sizeof *out->emitted);
        out->sky = host_alloc(host, texels, sizeof *out->sky);
        ok = out->geometry && out->emitted && out->sky &&
             trace_light(out, pose, scene, texels, &level);
    }
    trace_scene_destroy(scene);
    return ok;
}

bool mrt_unbounced_texels(struct mrt_scene_images *images, const struct scene_pose *pose,
                          const struct trace_scene *scene, size_t texels)
{
    images->emitted = host_alloc(images->host, texels, sizeof *images->emitted);
    images->sky = host_alloc(images->host, texels, sizeof *images->sky);
    return images->emitted && images->sky && trace_light(images, pose, scene, texels, NULL);
}

void mrt_scene_images_finish(struct mrt_scene_images *images)
{
    if (!images->host) return;
    host_free(images->host, images->geometry);
    host_free(images->host, images->emitted);
    host_free(images->host, images->sky);
    host_free(images->host, images->unbounced);
    mrt_outdoors_finish(&images->outdoors);
    *images = (struct mrt_scene_images){ 0 };
}
