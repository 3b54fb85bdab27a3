// Irradiance of emissive surfaces by the frame's virtual point lights, each a disk of the area that
// it stands for, and of the sky by cosine-distributed rays; both with shadow rays.
//
// On the axis of a disk of area A and radiance Φ/(π A), irradiance is Φ/π / (d² + A/π): finite at
// any distance.
#include "unbounced.h"

#include "core/parallel.h"
#include "core/sampling.h"
#include "core/rng.h"
#include "frame/emitters.h"

#include <math.h>

enum {
    EMITTER_SAMPLES = 128, // at most, per texel, evenly spaced in the list
    SKY_PROBE = 8,         // rays per texel that find out whether the sky is seen at all
    SKY_SAMPLES = 64,
};

// Of the distance: rays end before the emitter and begin before the texel's surface.
static const float SHORTENED = 1e-3f;

struct job {
    const struct trace_scene *scene;
    const struct emitters *emitters;
    struct mrt_scene_images *images;
    int sky_samples;
};

static vec3s above(const struct mrt_geometry_texel *texel, float distance)
{
    return glms_vec3_muladds(texel->normal, SHORTENED * distance, texel->position);
}

// Lux from one point, `share` of them standing for all.
static vec3s irradiance_of(const struct job *job, const struct mrt_geometry_texel *texel, int i,
                           float share)
{
    const struct frame_emitter *point = &job->emitters->points[i];
    const float area = job->emitters->origins[i].area_m2 * share;
    vec3s to = glms_vec3_sub(point->position, texel->position), dark = vec3_of(0, 0, 0);
    float distance2 = glms_vec3_norm2(to), distance = sqrtf(distance2);
    float cosines = -glms_vec3_dot(to, point->normal) * glms_vec3_dot(to, texel->normal);
    if (!(cosines > 0.0f) || glms_vec3_dot(to, texel->normal) < 0.0f) return dark;
    vec3s from = above(texel, distance);
    if (trace_occluded(job->scene, from, glms_vec3_sub(point->position, from), 1.0f - SHORTENED))
        return dark;
    cosines /= distance2;
    return glms_vec3_scale(point->flux, share * cosines / (GLM_PIf * distance2 + area));
}

// Each texel takes another subset, so that errors do not line up.
static void gather_emitters(const struct job *job, size_t i)
{
    const struct mrt_geometry_texel *texel = &job->images->geometry[i];
    const int count = job->emitters->count;
    const int step = (count + EMITTER_SAMPLES - 1) / EMITTER_SAMPLES;
    vec3s sum = vec3_of(0, 0, 0);
    if (!texel->found || count == 0) return;
    const int first = (int)(pcg_hash((uint32_t)i) % (uint32_t)step);
    const int taken = (count - first + step - 1) / step;
    const float share = (float)count / (float)taken;
    for (int k = first; k < count; k += step)
        sum = glms_vec3_add(sum, irradiance_of(job, texel, k, share));
    job->images->emitted[i] = sum;
}

static vec3s turned_to(vec3s normal, vec3s local)
{
    vec3s side = fabsf(normal.y) < 0.7f ? vec3_of(0, 1, 0) : vec3_of(1, 0, 0);
    vec3s u = vec3_unit(glms_vec3_cross(side, normal)), v = glms_vec3_cross(normal, u);
    return glms_vec3_add(glms_vec3_muladds(u, local.x, glms_vec3_scale(v, local.y)),
                         glms_vec3_scale(normal, local.z));
}

static void gather_sky(const struct job *job, size_t i)
{
    const struct mrt_geometry_texel *texel = &job->images->geometry[i];
    int seen = 0;
    if (!texel->found) return;
    for (int k = 0; k < job->sky_samples; k++) {
        vec2s u = sobol_2d((uint32_t)k, pcg_hash((uint32_t)i) | 1u);
        vec3s direction = turned_to(texel->normal, sample_hemisphere_cosine(u));
        vec3s from = above(texel, 1.0f);
        seen += !trace_occluded(job->scene, from, direction, INFINITY);
    }
    job->images->sky[i] = (float)seen / (float)job->sky_samples;
}

static void gather_first(void *user, size_t i)
{
    gather_emitters(user, i);
    gather_sky(user, i);
}

static void gather_again(void *user, size_t i)
{
    gather_sky(user, i);
}

static bool sees_sky(const struct mrt_scene_images *images, int texels)
{
    for (int i = 0; i < texels; i++)
        if (images->sky[i] > 0.0f) return true;
    return false;
}

static bool trace_light(struct mrt_scene_images *images, const struct scene_pose *pose,
                        const struct trace_scene *scene, int texels)
{
    struct emitters emitters = { 0 };
    struct job job = { scene, &emitters, images, SKY_PROBE };
    if (!emitters_init(&emitters, images->host, pose->scene)) {
        emitters_finish(&emitters);
        return false;
    }
    emitters_update(&emitters, pose);
    parallel_for((size_t)texels, 64, gather_first, &job);
    job.sky_samples = SKY_SAMPLES;
    if (sees_sky(images, texels)) parallel_for((size_t)texels, 64, gather_again, &job);
    emitters_finish(&emitters);
    return true;
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
