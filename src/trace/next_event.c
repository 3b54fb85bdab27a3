// Next-event estimation of punctual lights, emitters and the environment.
#include "trace/next_event.h"

#include "trace/light_sample.h"

#include <math.h>

// Unoccluded radiance reflected from a punctual light; 0 where the surface faces away.
static vec3s reflected(const struct surface *s, const struct bsdf *b,
                       const struct punctual_light *p)
{
    float cosine = glms_vec3_dot(b->normal, p->to_light);
    if (!(cosine > 0.0f) || !(glms_vec3_dot(s->geometric, p->to_light) > 0.0f))
        return vec3_of(0, 0, 0);
    vec3s f = bsdf_reflect(b, p->to_light).f;
    return glms_vec3_scale(glms_vec3_mul(f, p->illuminance), cosine);
}

static bool is_occluded(const struct trace_scene *scene, const struct ray *ray, uint64_t *rays)
{
    ++*rays;
    trace_watch(scene, ray, ray->far);
    return embree_occluded(scene->embree, ray);
}

static bool is_visible(const struct trace_scene *scene, const struct surface *s,
                       const struct punctual_light *p, uint64_t *rays)
{
    struct ray ray = { surface_leave(s, p->to_light), p->to_light, 0.0f, p->distance_m };
    return !is_occluded(scene, &ray, rays);
}

vec3s next_event_all_punctual(const struct trace_scene *scene, const struct surface *s,
                              const struct bsdf *b, uint64_t *rays)
{
    const struct light_table *lights = &scene->lights;
    vec3s sum = vec3_of(0, 0, 0);
    for (int i = 0; i < lights->punctual_count; i++) {
        struct punctual_light p = light_punctual(&lights->punctual[i], s->position);
        vec3s light = reflected(s, b, &p);
        if (!is_black(light) && is_visible(scene, s, &p, rays)) sum = glms_vec3_add(sum, light);
    }
    return sum;
}

struct arriving_light next_event_one_punctual(const struct trace_scene *scene,
                                              const struct surface *s, const struct bsdf *b,
                                              float choice, uint64_t *rays)
{
    const struct light_table *lights = &scene->lights;
    struct punctual_light chosen = { 0 };
    struct arriving_light none = { 0 }, light = none;
    float total = 0.0f, weight = 0.0f;
    // Weighted reservoir sampling (Chao 1982).
    for (int i = 0; i < lights->punctual_count; i++) {
        struct punctual_light p = light_punctual(&lights->punctual[i], s->position);
        vec3s candidate = reflected(s, b, &p);
        float w = luminance(candidate);
        if (!(w > 0.0f)) continue;
        total += w;
        float share = w / total;
        if (choice < share) {
            choice /= share;
            chosen = p;
            light.radiance = candidate;
            weight = w;
        } else {
            choice = (choice - share) / (1.0f - share);
        }
    }
    if (!(weight > 0.0f) || !is_visible(scene, s, &chosen, rays)) return none;
    const float cosine = glms_vec3_dot(b->normal, chosen.to_light), scale = total / weight;
    light.irradiance = glms_vec3_scale(chosen.illuminance, scale * cosine);
    light.radiance = glms_vec3_scale(light.radiance, scale);
    return light;
}

struct arriving_light next_event_one_emitter(const struct trace_scene *scene,
                                             const struct surface *s, const struct guided_bsdf *b,
                                             float choice, vec2s u, float directions,
                                             uint64_t *rays)
{
    struct arriving_light none = { 0 };
    struct emitter_sample e = light_sample_emitter(scene, s->position, choice, u);
    float cosine = glms_vec3_dot(b->bsdf.normal, e.to_light);
    if (is_black(e.radiance) || !(e.pdf > 0.0f) || !(cosine > 0.0f) ||
        !(glms_vec3_dot(s->geometric, e.to_light) > 0.0f))
        return none;
    vec3s from = surface_leave(s, e.to_light);
    struct ray ray = { from, glms_vec3_sub(e.position, from), 0.0f, 1.0f };
    if (is_occluded(scene, &ray, rays)) return none;
    struct reflection r = bsdf_reflect(&b->bsdf, e.to_light);
    float other = directions * guided_pdf(b, e.to_light, r.pdf);
    return light_arriving(r.f, e.radiance, cosine / e.pdf * power_heuristic(e.pdf, other));
}

struct arriving_light next_event_environment(const struct trace_scene *scene,
                                             const struct surface *s, const struct guided_bsdf *b,
                                             vec2s u, float directions, uint64_t *rays)
{
    const struct light_table *lights = &scene->lights;
    struct arriving_light none = { 0 };
    float pdf;
    const vec3s to_light =
        environment_sample(&lights->environment_table, &lights->environment, u, &pdf);
    const float cosine = glms_vec3_dot(b->bsdf.normal, to_light);
    if (!(pdf > 0.0f) || !(cosine > 0.0f) || !(glms_vec3_dot(s->geometric, to_light) > 0.0f))
        return none;
    struct ray ray = { surface_leave(s, to_light), to_light, 0.0f, INFINITY };
    if (is_occluded(scene, &ray, rays)) return none;
    struct reflection r = bsdf_reflect(&b->bsdf, to_light);
    const float other = directions * guided_pdf(b, to_light, r.pdf);
    return light_arriving(r.f, environment_map_light(&lights->environment, to_light),
                          cosine / pdf * power_heuristic(pdf, other));
}
