// Irradiance of emissive surfaces and of the sky at texels.
#include "techniques/mrt/light/area_light.h"

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
    struct mrt_geometry_texel *texels;
    int rays;
};

static void gather(void *user, size_t i)
{
    const struct job *job = user;
    struct mrt_geometry_texel *at = &job->texels[i];
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
    at->sky = light.sky.irradiance / GLM_PIf;
    for (int c = 0; c < 3; c++) at->emitted.raw[c] = light.emitted[c].irradiance;
}

bool mrt_area_light_texels(const struct trace_scene *scene, struct mrt_geometry_texel *texels,
                           size_t count)
{
    const bool emitters = scene->lights.has_emitters;
    struct job job = { scene, texels, emitters ? RAYS : PROBES };
    bool sky = false;
    parallel_for(count, 64, gather, &job);
    for (size_t i = 0; i < count; i++) sky = sky || texels[i].sky > 0.0f;
    if (emitters || !sky) return emitters;
    job.rays = RAYS;
    parallel_for(count, 64, gather, &job);
    return true;
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

// Without emitters and sky all probes are dark.
static bool light_probes(struct mrt_scene_images *images, const struct trace_scene *scene,
                         const struct mrt_block_map *map, int probes, bool any_light)
{
    const size_t count = (size_t)map->count * (size_t)mrt_probes_of_block(probes);
    if (probes == 0) return true;
    images->area_light = any_light ? mrt_area_light_probes_create(images->host, map, probes, scene)
                                   : host_alloc(images->host, count, sizeof *images->area_light);
    return images->area_light;
}

bool mrt_scene_images_init(struct host *host, const struct scene_pose *pose,
                           const struct scene_pose *walls, const struct mrt_block_map *map,
                           const struct mrt_atlas *atlas, int probes,
                           const struct mrt_geometry_texel *kept, struct mrt_scene_images *out)
{
    const size_t texels = (size_t)atlas->texels;
    *out = (struct mrt_scene_images){ .host = host };
    struct trace_scene *scene = trace_scene_create(host, pose);
    if (scene)
        out->geometry = kept            ? copy_of(host, kept, texels)
                        : walls == pose ? mrt_geometry_create(host, map, atlas, scene)
                                        : geometry_of(host, walls, map, atlas);
    bool ok = scene && out->geometry;
    if (ok) {
        const bool any_light = mrt_area_light_texels(scene, out->geometry, texels);
        ok = light_probes(out, scene, map, probes, any_light) &&
             mrt_outdoors_init(host, map, pose->bounds, scene, &out->outdoors);
    }
    trace_scene_destroy(scene);
    return ok;
}

void mrt_scene_images_finish(struct mrt_scene_images *images)
{
    if (!images->host) return;
    host_free(images->host, images->geometry);
    host_free(images->host, images->area_light);
    mrt_outdoors_finish(&images->outdoors);
    *images = (struct mrt_scene_images){ 0 };
}
