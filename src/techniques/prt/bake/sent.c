#include "techniques/prt/bake/sent.h"

#include "core/half.h"

bool prt_sent_init(struct prt_sent *out, const struct bake_task *task)
{
    const struct prt_scene *scene = task->job;
    const struct tensor *point = bake_task_input(task, LIGHT_MAP_POINT);
    const struct tensor *albedo = bake_task_input(task, LIGHT_MAP_ALBEDO);
    const struct tensor *emitted = bake_task_input(task, LIGHT_MAP_EMITTED);
    const struct tensor *bounces = bake_task_input(task, PRT_EMITTED);
    const struct tensor *direct = bake_task_input(task, PRT_DIRECT);
    const struct tensor *bounce = bake_task_input(task, PRT_BOUNCE);
    *out = (struct prt_sent){ 0 };
    if (!point || !albedo || !emitted || !bounces || !direct || !bounce) return false;
    *out = (struct prt_sent){ .scene = scene,
                              .receivers = scene->receivers.count,
                              .coefficients = prt_coefficients(&scene->options),
                              .albedo = albedo->data,
                              .emitted = emitted->data,
                              .emitted_bounces = bounces->data,
                              .direct = direct->data,
                              .bounce = bounce->data,
                              .nearest_valid =
                                  prt_receivers_nearest_valid(&scene->receivers, point->data) };
    return out->nearest_valid != NULL;
}

void prt_sent_finish(struct prt_sent *sent)
{
    if (sent->scene) host_free(sent->scene->receivers.host, sent->nearest_valid);
    *sent = (struct prt_sent){ 0 };
}

uint32_t prt_sent_receiver(const struct prt_scene *scene, const struct ray_hit *hit,
                           const struct texel_hit *at_hit, float choice)
{
    const struct prt_point point = { scene->trace->meshes[hit->geometry].instance, hit->triangle,
                                     hit->u, hit->v, at_hit->back };
    return at_hit->inside ? CHART_NONE : prt_receiver_at(&scene->receivers, &point, choice);
}

// Over π; the factor of shading normals is that of light from all directions
// (light_map_first_order_of_all).
static vec3s reflectance(const struct prt_sent *sent, uint32_t from)
{
    const float *albedo = sent->albedo + 4 * (size_t)from;
    const float factor = (0.5f + 0.5f * albedo[3]) / GLM_PIf;
    return vec3_of(factor * albedo[0], factor * albedo[1], factor * albedo[2]);
}

void prt_sent_radiance(const struct prt_sent *sent, uint32_t receiver, float *out)
{
    const uint32_t from = sent->nearest_valid[receiver];
    const vec3s reflected = reflectance(sent, from);
    for (size_t i = 0; i < sent->coefficients; i++) {
        const size_t at = i * sent->receivers + from;
        const float direct = float_from_half(sent->direct[at]);
        out[4 * i] = 0.0f;
        for (size_t c = 0; c < 3; c++)
            out[4 * i + 1 + c] =
                reflected.raw[c] * (direct + float_from_half(sent->bounce[3 * at + c]));
    }
}

vec3s prt_sent_emission(const struct prt_sent *sent, uint32_t receiver)
{
    const size_t from = sent->nearest_valid[receiver];
    vec3s out = reflectance(sent, (uint32_t)from);
    for (size_t c = 0; c < 3; c++)
        out.raw[c] *= sent->emitted[12 * from + 4 * c] + sent->emitted_bounces[3 * from + c];
    return out;
}
