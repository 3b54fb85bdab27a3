#include "trace/share.h"

#include "trace/next_event.h"

#include <math.h>

// The end of a path as seen from a receiver.
struct connection {
    vec3s direction;  // to the end, unit
    float distance_m; // INFINITY: the environment
    float cosine;     // at the receiver
    float end_cosine; // at the end, of its facet
    float density; // of the receiver's sampling, per area at the end or per solid angle; times π
};

static bool is_blocked(const struct trace_scene *scene, const struct surface *s,
                       const struct path_end *end, const struct connection *c, uint64_t *rays)
{
    struct ray ray = { surface_leave(s, c->direction), c->direction, 0.0f, INFINITY };
    if (end->hit) {
        const vec3s to = surface_leave(&end->surface, glms_vec3_negate(c->direction));
        ray.direction = glms_vec3_sub(to, ray.origin);
        ray.far = 1.0f;
    }
    ++*rays;
    trace_watch(scene, &ray, ray.far);
    return embree_occluded(scene->embree, &ray);
}

// Sets all but the visibility; the density is 0 where one faces away from the other.
static void connect(const struct path_start *receiver, const struct path_end *end,
                    struct connection *c)
{
    const struct surface *s = &receiver->surface;
    *c = (struct connection){ .direction = end->direction, .distance_m = INFINITY };
    float falloff = 1.0f;
    if (end->hit) {
        const vec3s to = glms_vec3_sub(end->surface.position, s->position);
        const float distance2 = glms_vec3_norm2(to);
        if (!(distance2 > 0.0f)) return;
        c->distance_m = sqrtf(distance2);
        c->direction = glms_vec3_scale(to, 1.0f / c->distance_m);
        c->end_cosine = -glms_vec3_dot(end->surface.geometric, c->direction);
        falloff = c->end_cosine / distance2;
    }
    c->cosine = glms_vec3_dot(receiver->bsdf.normal, c->direction);
    if (c->cosine > 0.0f && glms_vec3_dot(s->geometric, c->direction) > 0.0f && falloff > 0.0f)
        c->density = c->cosine * falloff;
}

// Radiance from the end along the connection. Light that next-event estimation finds, too, is
// weighted by the densities of this receiver.
static vec3s light_from(const struct path_settings *settings, const struct path_end *end,
                        const struct connection *c)
{
    const struct trace_scene *scene = settings->scene;
    const struct surface *s = &end->surface;
    const float pdf = end->directions * c->cosine * BSDF_INV_PI;
    if (!end->hit) return path_environment(scene, c->direction, pdf);
    vec3s light = glms_vec3_mul(
        end->irradiance, bsdf_diffuse_towards(s->normal, glms_vec3_negate(c->direction),
                                              surface_bsdf_material(s), settings->diffuse_only));
    if (is_black(s->emission)) return light;
    const float other =
        light_emitter_pdf(scene, s->mesh, s->triangle, c->distance_m, c->end_cosine);
    return glms_vec3_muladds(s->emission, power_heuristic(pdf, other), light);
}

static bool is_dark(const struct path_end *end)
{
    return end->hit && is_black(end->irradiance) && is_black(end->surface.emission);
}

void path_share(const struct path_settings *settings, const struct path_start *const *receivers,
                int count, int own, const struct path_end *end, vec3s *irradiance, uint64_t *rays)
{
    struct connection at[PATH_SHARE];
    float sum = 0.0f;
    if (!end->sampled) return;
    // The step's cosine over its density is π.
    irradiance[own] = glms_vec3_muladds(end->rest, GLM_PIf, irradiance[own]);
    if (is_dark(end)) return;
    for (int i = 0; i < count; i++) {
        connect(receivers[i], end, &at[i]);
        if (i != own && at[i].density > 0.0f &&
            is_blocked(settings->scene, &receivers[i]->surface, end, &at[i], rays))
            at[i].density = 0.0f;
        sum += at[i].density;
    }
    for (int i = 0; i < count; i++)
        if (at[i].density > 0.0f)
            irradiance[i] = glms_vec3_muladds(light_from(settings, end, &at[i]),
                                              GLM_PIf * at[i].density / sum, irradiance[i]);
}
