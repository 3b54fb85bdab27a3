#include "techniques/prt/bake/samples.h"

#include "core/rng.h"

#include <math.h>

int prt_sample_count(const struct prt_options *options)
{
    return options->at == PRT_AT_VERTEX ? 0 : options->rays / RAYS_PER_LIGHT_SAMPLE;
}

static float power_of(const struct prt_samples *s, uint32_t receiver)
{
    const bool hidden = !(s->point[4 * (size_t)receiver + 3] > 0.0f);
    const vec4s sent = s->sent[receiver];
    const float area_m2 = chart_texel_of(&s->scene->charts, receiver)->area_m2;
    return hidden ? 0.0f : fmaxf(area_m2 * (sent.x + sent.y + sent.z), 0.0f);
}

static void set_probabilities(struct prt_samples *s, uint32_t receivers)
{
    double total = 0.0;
    for (uint32_t i = 0; i < receivers; i++) total += (double)power_of(s, i);
    for (uint32_t i = 0; i < receivers; i++) {
        const double p = total > 0.0 ? (double)s->count * (double)power_of(s, i) / total : 0.0;
        s->probability[i] = (float)p;
        s->below[i + 1] = s->below[i] + p;
    }
}

bool prt_samples_init(struct prt_samples *out, const struct bake_task *task, const float *point,
                      const vec4s *sent)
{
    const struct prt_scene *scene = task->job;
    const uint32_t receivers = scene->receivers.count;
    *out = (struct prt_samples){ .scene = scene,
                                 .host = task->host,
                                 .point = point,
                                 .sent = sent,
                                 .count = prt_sample_count(&scene->options) };
    out->probability = host_alloc(out->host, receivers, sizeof *out->probability);
    out->below = host_alloc(out->host, (size_t)receivers + 1, sizeof *out->below);
    if (!out->probability || !out->below) return false;
    out->below[0] = 0.0;
    set_probabilities(out, receivers);
    return true;
}

void prt_samples_finish(struct prt_samples *s)
{
    if (!s->host) return;
    host_free(s->host, s->probability);
    host_free(s->host, s->below);
    *s = (struct prt_samples){ 0 };
}

// ---- gathering

// In front of the surface, where its rays start.
static vec3s place_of(const struct prt_samples *s, uint32_t receiver)
{
    const float *point = s->point + 4 * (size_t)receiver;
    return glms_vec3_muladds(prt_receiver_normal(&s->scene->receivers, receiver),
                             prt_receiver_reach(s->scene, receiver),
                             vec3_of(point[0], point[1], point[2]));
}

// F_ij without occluders, between middles of texels.
static float form_factor(const struct prt_samples *s, uint32_t i, uint32_t j, vec3s from, vec3s to)
{
    const struct prt_receivers *receivers = &s->scene->receivers;
    const vec3s path = glms_vec3_sub(to, from);
    const float r2 = glms_vec3_dot(path, path);
    const float out = glms_vec3_dot(prt_receiver_normal(receivers, i), path);
    const float in = -glms_vec3_dot(prt_receiver_normal(receivers, j), path);
    if (!(out > 0.0f && in > 0.0f && r2 > 0.0f)) return 0.0f;
    const float area_m2 = chart_texel_of(&s->scene->charts, j)->area_m2;
    return out * in * area_m2 / (GLM_PIf * r2 * r2);
}

// A ray that meets what no sample reaches stands for itself.
static float weight_of(const struct prt_samples *s, uint32_t j, float form_factor)
{
    const float rays = (float)s->scene->options.rays;
    return form_factor > 0.0f ? form_factor / (rays * form_factor + s->probability[j])
                              : 1.0f / rays;
}

// The receiver whose interval of the sum of probabilities has `at`.
static uint32_t receiver_at(const struct prt_samples *s, double at)
{
    uint32_t low = 0, high = s->scene->receivers.count;
    while (high - low > 1) {
        const uint32_t middle = low + (high - low) / 2;
        if (s->below[middle] <= at)
            low = middle;
        else
            high = middle;
    }
    return low;
}

static vec4s gather_hits(const struct prt_samples *s, uint32_t i, vec3s from, const uint32_t *hits)
{
    const int rays = s->scene->options.rays;
    vec4s sum = { { 0, 0, 0, 0 } };
    for (int k = 0; k < rays && hits[k] != CHART_NONE; k++) {
        const uint32_t j = hits[k];
        const float factor =
            s->probability[j] > 0.0f ? form_factor(s, i, j, from, place_of(s, j)) : 0.0f;
        sum = glms_vec4_muladds(s->sent[j], weight_of(s, j, factor), sum);
    }
    return sum;
}

// One sample in each of K intervals of equal power, at the same place of each.
static vec4s gather_samples(const struct prt_samples *s, uint32_t i, vec3s from)
{
    const double place = (double)rng_unit(pcg_hash(i));
    vec4s sum = { { 0, 0, 0, 0 } };
    for (int k = 0; k < s->count; k++) {
        const uint32_t j = receiver_at(s, (double)k + place);
        const vec3s to = place_of(s, j);
        const float factor = form_factor(s, i, j, from, to);
        if (!(factor > 0.0f) || !(s->probability[j] > 0.0f)) continue;
        if (trace_occluded(s->scene->trace, from, glms_vec3_sub(to, from), 1.0f)) continue;
        sum = glms_vec4_muladds(s->sent[j], weight_of(s, j, factor), sum);
    }
    return sum;
}

vec4s prt_samples_gather(const struct prt_samples *s, uint32_t i, const uint32_t *hits)
{
    const vec3s from = place_of(s, i);
    const bool lit = s->below[s->scene->receivers.count] > 0.0;
    const vec4s of_rays = gather_hits(s, i, from, hits);
    return lit ? glms_vec4_add(of_rays, gather_samples(s, i, from)) : of_rays;
}
