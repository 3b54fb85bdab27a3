// Points and rays towards emitters.
#include "unbounced_samples.h"

#include "core/rng.h"

#include <math.h>

enum { POINTS = 128 }; // at most, per receiver, evenly spaced in the list

// Of the distance: rays end before the emitter and begin before the receiver's surface.
static const float SHORTENED = 1e-3f;

// Points over area, of each instance.
static bool make_densities(struct mrt_emitter_samples *s, int instances)
{
    const struct emitters *emitters = s->emitters;
    float *area = host_alloc(s->host, (size_t)instances, sizeof *area);
    s->points_per_m2 = host_alloc(s->host, (size_t)instances, sizeof *s->points_per_m2);
    bool ok = area && s->points_per_m2;
    for (int i = 0; ok && i < emitters->count; i++) {
        s->points_per_m2[emitters->origins[i].instance] += 1.0f;
        area[emitters->origins[i].instance] += emitters->origins[i].area_m2;
    }
    for (int i = 0; ok && i < instances; i++)
        s->points_per_m2[i] = area[i] > 0.0f ? s->points_per_m2[i] / area[i] : 0.0f;
    host_free(s->host, area);
    return ok;
}

bool mrt_emitter_samples_init(struct mrt_emitter_samples *out, struct host *host,
                              const struct trace_scene *scene, const struct emitters *emitters,
                              int instances)
{
    *out = (struct mrt_emitter_samples){ .host = host, .scene = scene, .emitters = emitters };
    return make_densities(out, instances);
}

void mrt_emitter_samples_finish(struct mrt_emitter_samples *samples)
{
    if (samples->host) host_free(samples->host, samples->points_per_m2);
    *samples = (struct mrt_emitter_samples){ 0 };
}

static int step_of(const struct mrt_emitter_samples *s)
{
    return (s->emitters->count + POINTS - 1) / POINTS;
}

struct mrt_point_subset mrt_points_of(const struct mrt_emitter_samples *samples, size_t i)
{
    const int count = samples->emitters->count, step = step_of(samples);
    if (count == 0) return (struct mrt_point_subset){ .step = 1 };
    const int first = (int)(pcg_hash((uint32_t)i) % (uint32_t)step);
    const int taken = (count - first + step - 1) / step;
    return (struct mrt_point_subset){ first, step, (float)count / (float)taken };
}

static bool is_surface(const struct mrt_receiver *receiver)
{
    return glms_vec3_norm2(receiver->normal) > 0.0f;
}

// Of rays, per steradian.
static float density_per_sr(const struct mrt_receiver *receiver, vec3s direction)
{
    return is_surface(receiver) ? fmaxf(glms_vec3_dot(receiver->normal, direction), 0.0f) / GLM_PIf
                                : 1.0f / (4.0f * GLM_PIf);
}

// Rays per square metre of an emitter.
static float ray_density(const struct mrt_emitter_samples *s, const struct mrt_receiver *receiver,
                         vec3s direction, float emitter_cosine, float distance2)
{
    return (float)s->rays * density_per_sr(receiver, direction) * emitter_cosine /
           fmaxf(distance2, 1e-12f);
}

vec3s mrt_light_of_point(const struct mrt_emitter_samples *samples,
                         const struct mrt_receiver *receiver, int i,
                         const struct mrt_point_subset *subset, vec3s *direction)
{
    const struct frame_emitter *point = &samples->emitters->points[i];
    vec3s to = glms_vec3_sub(point->position, receiver->position), dark = vec3_of(0, 0, 0);
    float distance = glms_vec3_norm(to);
    *direction = distance > 0.0f ? glms_vec3_divs(to, distance) : dark;
    float emitter = -glms_vec3_dot(*direction, point->normal);
    if (!(emitter > 0.0f) ||
        (is_surface(receiver) && !(glms_vec3_dot(*direction, receiver->normal) > 0.0f)))
        return dark;
    vec3s from = glms_vec3_muladds(receiver->normal, SHORTENED * distance, receiver->position);
    if (trace_occluded(samples->scene, from, glms_vec3_sub(point->position, from),
                       1.0f - SHORTENED))
        return dark;
    float density = samples->points_per_m2[samples->emitters->origins[i].instance] / subset->share;
    float rays = ray_density(samples, receiver, *direction, emitter, distance * distance);
    return glms_vec3_scale(point->flux, density / (density + rays) * subset->share * emitter /
                                            (GLM_PIf * distance * distance));
}

vec3s mrt_light_of_hit(const struct mrt_emitter_samples *samples,
                       const struct mrt_receiver *receiver, vec3s direction,
                       const struct trace_hit *hit)
{
    if (samples->emitters->count == 0) return vec3_of(0, 0, 0);
    float emitter = fabsf(glms_vec3_dot(hit->geometric, direction));
    float rays = ray_density(samples, receiver, direction, emitter, hit->distance * hit->distance);
    float points = samples->points_per_m2[hit->instance] / (float)step_of(samples);
    return glms_vec3_scale(hit->emission, GLM_PIf * rays / fmaxf(rays + points, 1e-30f));
}
