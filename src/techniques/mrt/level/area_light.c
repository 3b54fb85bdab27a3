// Irradiance of emissive surfaces and of the sky at texels.
#include "area_light.h"

#include "techniques/mrt/level/area_light_points.h"

#include "core/parallel.h"
#include "core/rng.h"

#include <string.h>

enum {
    PROBES = 8, // rays per texel that find out whether the sky is seen at all
    RAYS = 64,
    LIGHT_SAMPLES = 128,
};

static const float RAY_OFFSET = 1e-3f; // m, along the normal

struct job {
    const struct trace_scene *scene;
    struct mrt_scene_images *images;
    int rays;
};

static void gather(void *user, size_t i)
{
    const struct job *job = user;
    const struct mrt_geometry_texel *at = &job->images->geometry[i];
    struct texel_lights light;
    if (!at->found) return;
    const struct texel_receiver receiver = {
        .position = glms_vec3_muladds(at->normal, RAY_OFFSET, at->position),
        .normal = at->normal,
        .rays = job->rays,
        .light_samples = job->scene->lights.has_emitters ? LIGHT_SAMPLES : 0,
        .seed = pcg_hash((uint32_t)i) | 1u,
    };
    texel_gather_light(job->scene, &receiver, NULL, NULL, &light);
    job->images->sky[i] = light.sky.irradiance / GLM_PIf;
    for (int c = 0; c < 3; c++) job->images->emitted[i].raw[c] = light.emitted[c].irradiance;
}

static bool sees_sky(const struct mrt_scene_images *images, int texels)
{
    for (int i = 0; i < texels; i++)
        if (images->sky[i] > 0.0f) return true;
    return false;
}

static void gather_all(struct job *job, size_t texels)
{
    const bool emitters = job->scene->lights.has_emitters;
    job->rays = emitters ? RAYS : PROBES;
    parallel_for(texels, 64, gather, job);
    if (emitters || !sees_sky(job->images, (int)texels)) return;
    job->rays = RAYS;
    parallel_for(texels, 64, gather, job);
}

// Texels and probes that light is traced onto.
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
    if (job->rays == PROBES)
        images->area_light = host_alloc(images->host, count, sizeof *images->area_light);
    else
        images->area_light =
            mrt_area_light_probes_create(images->host, level->map, level->probes, job->scene);
    return images->area_light;
}

// level: of the probes; NULL: texels alone.
static bool trace_light(struct mrt_scene_images *images, const struct scene_pose *pose,
                        const struct trace_scene *scene, size_t texels,
                        const struct level_points *level)
{
    struct job job = { .scene = scene, .images = images };
    gather_all(&job, texels);
    return !level ||
           ((level->probes == 0 || gather_probes(&job, level)) &&
            mrt_outdoors_init(images->host, level->map, pose->bounds, scene, &images->outdoors));
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

bool mrt_area_light_texels(struct mrt_scene_images *images, const struct scene_pose *pose,
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
    host_free(images->host, images->area_light);
    mrt_outdoors_finish(&images->outdoors);
    *images = (struct mrt_scene_images){ 0 };
}
