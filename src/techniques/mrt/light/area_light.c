// Irradiance of emissive surfaces and of the sky at texels.
#include "techniques/mrt/light/area_light.h"

#include "techniques/mrt/level/wall.h"

#include "core/rng.h"

#include <stdatomic.h>
#include <string.h>

enum {
    PROBES = 8,
    LEAST_RAYS = 64,
    MOST_RAYS = 512,
    ALL_RAYS = 1 << 21, // of all texels, while each has LEAST_RAYS
    LIGHT_SAMPLES = 128,
};

static const float RAY_OFFSET = 1e-3f; // m, along the normal

struct job {
    const struct trace_scene *scene;
    struct mrt_geometry_texel *texels;
    struct mrt_ray_cells cells;
    int rays;
    const struct mrt_reflectors *wanted; // NULL: it is not asked whether there are any
    atomic_bool has_reflectors;
};

struct view {
    struct job *job;
    struct mrt_reflector_hits *hits;
};

static void add_hit(void *user, const struct ray *ray, const struct ray_hit *hit, vec3s local,
                    const struct texel_hit *at_hit)
{
    const struct view *view = user;
    struct job *job = view->job;
    (void)local;
    if (job->wanted && mrt_reflectors_have(job->wanted, job->scene, ray, hit, at_hit))
        atomic_store_explicit(&job->has_reflectors, true, memory_order_relaxed);
    mrt_reflectors_add_hit(view->hits, job->scene, ray, hit, at_hit);
}

// Less what uniform light of its irradiance would have: a control variate, whose part along the
// surface is 0 in the mean.
static vec3s vector_of(const struct texel_light *light, const float uniform[3])
{
    const float radiance = light->irradiance / GLM_PIf;
    vec3s vector;
    for (int k = 0; k < 3; k++) vector.raw[k] = light->vector[k] - radiance * uniform[k];
    return vector;
}

// A surface that hides a part of the block reflects its share of the irradiance that the texel has.
static vec3s hidden_of(const struct mrt_reflector_hits *hits)
{
    const vec3s one = vec3_of(1, 1, 1);
    vec3s hidden = vec3_of(0, 0, 0);
    for (uint32_t k = 0; k < hits->count; k++)
        if (hits->at[k].in_block)
            hidden = glms_vec3_muladds(glms_vec3_sub(one, hits->at[k].reflectance),
                                       hits->at[k].share, hidden);
    return glms_vec3_minv(hidden, one);
}

// Places of samples: the parts that have the texel's surface.
static uint32_t places_of(const struct mrt_geometry_texel *at, vec3s middle,
                          vec3s places[MRT_PARTS * MRT_PARTS])
{
    uint32_t count = 0;
    for (int part = 0; part < MRT_PARTS * MRT_PARTS; part++)
        if (at->parts >> part & 1) places[count++] = glms_vec3_add(middle, mrt_part_way(at, part));
    return count;
}

static void gather(void *user, size_t i, struct mrt_reflector_hits *hits)
{
    struct job *job = user;
    struct mrt_geometry_texel *at = &job->texels[i];
    struct view view = { job, hits };
    struct texel_lights light;
    uint8_t further[MRT_MOST_CELLS];
    at->reflected = (struct mrt_reflector_row){ 0 };
    if (!at->found) return;
    if (job->cells.side) mrt_ray_cells_of(&job->cells, i, further);
    vec3s places[MRT_PARTS * MRT_PARTS];
    const vec3s middle = glms_vec3_muladds(at->normal, RAY_OFFSET, at->position);
    const struct texel_receiver receiver = {
        .position = middle,
        .normal = at->normal,
        .places = places,
        .place_count = places_of(at, middle, places),
        .rays = job->rays,
        .light_samples = job->scene->lights.has_emitters ? LIGHT_SAMPLES : 0,
        .seed = pcg_hash((uint32_t)i) | 1u,
        .cells = { job->cells.side, further },
    };
    texel_gather_light(job->scene, &receiver, add_hit, &view, &light);
    at->hidden = hidden_of(hits);
    at->sky = light.sky.irradiance / GLM_PIf;
    at->sky_vector = glms_vec3_divs(vector_of(&light.sky, light.uniform_vector), GLM_PIf);
    for (int c = 0; c < 3; c++) {
        at->emitted.raw[c] = light.emitted[c].irradiance;
        at->emitted_vector[c] = vector_of(&light.emitted[c], light.uniform_vector);
    }
}

static struct mrt_reflector_row *row_of(void *user, size_t i)
{
    const struct job *job = user;
    return &job->texels[i].reflected;
}

static bool gather_all(struct job *job, struct mrt_reflectors *reflectors, size_t count, int rays)
{
    job->rays = rays;
    return mrt_reflectors_gather(
        reflectors, &(struct mrt_reflector_gather){ .gather = gather,
                                                    .row_of = row_of,
                                                    .user = job,
                                                    .count = count,
                                                    .rays = rays + (int)job->cells.most,
                                                    .weight = 1.0f });
}

// A power of two, for which points of the Sobol sequence are spread most evenly.
static int rays_of(size_t texels)
{
    int rays = LEAST_RAYS;
    while (rays < MOST_RAYS && 2 * (size_t)rays * texels <= ALL_RAYS) rays *= 2;
    return rays;
}

static bool gather_light(struct job *job, struct mrt_reflectors *reflectors,
                         const struct mrt_texel_list *texels)
{
    const int rays = rays_of(texels->count);
    const bool ok = mrt_ray_cells_init(job->scene, reflectors, texels, rays, &job->cells) &&
                    gather_all(job, reflectors, texels->count, rays);
    mrt_ray_cells_finish(&job->cells);
    return ok;
}

// Without emitters a few rays tell whether the sky or reflectors in blocks are seen at all.
bool mrt_area_light_texels(const struct trace_scene *scene, struct mrt_reflectors *reflectors,
                           const struct mrt_texel_list *texels, bool *lit)
{
    struct job job = { .scene = scene, .texels = texels->at };
    *lit = scene->lights.has_emitters;
    if (!*lit) {
        job.wanted = reflectors && reflectors->inside.texels ? reflectors : NULL;
        if (!gather_all(&job, NULL, texels->count, PROBES)) return false;
        *lit = atomic_load_explicit(&job.has_reflectors, memory_order_relaxed);
        job.wanted = NULL;
        for (size_t i = 0; i < texels->count; i++) *lit = *lit || texels->at[i].sky > 0.0f;
    }
    return !*lit || gather_light(&job, reflectors, texels);
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
                         struct mrt_reflectors *reflectors, int probes, bool lit)
{
    const size_t count = (size_t)reflectors->grid.map->count * (size_t)mrt_probes_of_block(probes);
    if (probes == 0) return true;
    images->area_light = lit ? mrt_area_light_probes_create(scene, reflectors, probes)
                             : host_alloc(images->host, count, sizeof *images->area_light);
    return images->area_light;
}

// Those which reflectors see are added to them, and receive direct light alone.
static bool light_reflectors(const struct trace_scene *scene, struct mrt_reflectors *reflectors)
{
    const size_t count = reflectors->count;
    struct mrt_geometry_texel *texels = copy_of(reflectors->host, reflectors->at, count);
    bool lit;
    bool ok = texels &&
              mrt_area_light_texels(scene, reflectors,
                                    &(struct mrt_texel_list){ .at = texels, .count = count }, &lit);
    if (ok) {
        memcpy(reflectors->at, texels, count * sizeof *texels);
        const struct mrt_texel_list seen = { .at = reflectors->at + count,
                                             .count = reflectors->count - count };
        ok = mrt_area_light_texels(scene, NULL, &seen, &lit);
    }
    host_free(reflectors->host, texels);
    return ok;
}

static bool light_all(struct mrt_scene_images *images, const struct trace_scene *scene,
                      const struct scene_pose *pose, struct mrt_reflectors *reflectors,
                      const struct mrt_atlas *atlas, int probes)
{
    const struct mrt_texel_list texels = { images->geometry, (size_t)atlas->texels,
                                           atlas->resolution };
    bool lit;
    return mrt_area_light_texels(scene, reflectors, &texels, &lit) &&
           light_probes(images, scene, reflectors, probes, lit) &&
           mrt_outdoors_init(scene, reflectors, pose->bounds, &images->outdoors) &&
           light_reflectors(scene, reflectors);
}

bool mrt_scene_images_init(struct mrt_reflectors *reflectors, const struct scene_pose *pose,
                           const struct scene_pose *walls, const struct mrt_atlas *atlas,
                           int probes, const struct mrt_geometry_texel *kept,
                           struct mrt_scene_images *out)
{
    struct host *host = reflectors->host;
    const struct mrt_block_map *map = reflectors->grid.map;
    const size_t texels = (size_t)atlas->texels;
    *out = (struct mrt_scene_images){ .host = host };
    struct trace_scene *scene = trace_scene_create(host, pose);
    if (scene)
        out->geometry = kept            ? copy_of(host, kept, texels)
                        : walls == pose ? mrt_geometry_create(host, map, atlas, scene)
                                        : geometry_of(host, walls, map, atlas);
    if (reflectors->own.has && map->count > 0 && !map->is_open &&
        !mrt_block_is_tube(&map->blocks[0]))
        reflectors->inside = (struct mrt_geometry){ map, atlas, out->geometry };
    const bool ok =
        scene && out->geometry && light_all(out, scene, pose, reflectors, atlas, probes);
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
