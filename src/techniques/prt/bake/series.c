#include "techniques/prt/bake/series.h"

#include "bake/plan.h"
#include "techniques/prt/bake/samples.h"

#include <math.h>
#include <string.h>

void prt_series_finish(struct prt_series *s)
{
    if (!s->host) return;
    host_free(s->scene->receivers.host, s->nearest_valid);
    host_free(s->host, s->term);
    host_free(s->host, s->sent);
    host_free(s->host, s->sum);
    *s = (struct prt_series){ 0 };
}

static bool is_hidden(const struct prt_series *s, size_t texel)
{
    return !(s->point[4 * texel + 3] > 0.0f);
}

bool prt_series_init(struct prt_series *s, const struct bake_task *task)
{
    const struct tensor *albedo = bake_task_input(task, LIGHT_MAP_ALBEDO);
    const struct tensor *point = bake_task_input(task, LIGHT_MAP_POINT);
    const struct tensor *hits = bake_task_input(task, PRT_HITS);
    *s = (struct prt_series){ 0 };
    if (!albedo || !point || !hits) return false;
    *s = (struct prt_series){ .scene = task->job,
                              .host = task->host,
                              .albedo = albedo->data,
                              .point = point->data,
                              .hits = hits->data };
    s->texels = s->scene->receivers.count;
    s->nearest_valid = prt_receivers_nearest_valid(&s->scene->receivers, s->point);
    s->term = host_alloc(s->host, s->texels, sizeof *s->term);
    s->sent = host_alloc(s->host, s->texels, sizeof *s->sent);
    s->sum = host_alloc(s->host, s->texels, sizeof *s->sum);
    return s->nearest_valid && s->term && s->sent && s->sum;
}

// The factor of shading normals is that of light from all directions
// (light_map_first_order_of_all).
static void reflect(struct prt_series *s)
{
    for (size_t i = 0; i < s->texels; i++) {
        const float *albedo = s->albedo + 4 * i, diffuse = 0.5f + 0.5f * albedo[3];
        for (int c = 0; c < 3; c++) s->sent[i].raw[c] = diffuse * albedo[c] * s->term[i].raw[c];
    }
    for (size_t i = 0; i < s->texels; i++)
        if (is_hidden(s, i)) s->sent[i] = s->sent[s->nearest_valid[i]];
}

static vec4s gather(const struct prt_series *s, size_t texel)
{
    const size_t rays = (size_t)s->scene->options.rays;
    const uint32_t *hit = s->hits + texel * rays;
    vec4s sum = { { 0, 0, 0, 0 } };
    for (size_t k = 0; k < rays && hit[k] != CHART_NONE; k++)
        sum = glms_vec4_add(sum, s->sent[hit[k]]);
    return glms_vec4_scale(sum, 1.0f / (float)rays);
}

// From the light that the last term sends to the next one, by rays.
static bool gather_all(struct prt_series *s, const struct bake_task *task)
{
    if (bake_task_cancelled(task)) return false;
    for (size_t i = 0; i < s->texels; i++) s->term[i] = gather(s, i);
    return true;
}

// The same, by rays and samples.
static bool sample_all(struct prt_series *s, const struct bake_task *task)
{
    enum { BETWEEN_CHECKS = 1024 };
    const size_t rays = (size_t)s->scene->options.rays;
    struct prt_samples samples;
    bool ok = prt_samples_init(&samples, task, s->point, s->sent);
    for (uint32_t i = 0; ok && i < s->texels; i++) {
        ok = i % BETWEEN_CHECKS != 0 || !bake_task_cancelled(task);
        if (!ok) break;
        s->term[i] = is_hidden(s, i) ? (vec4s){ { 0, 0, 0, 0 } }
                                     : prt_samples_gather(&samples, i, s->hits + i * rays);
    }
    prt_samples_finish(&samples);
    return ok;
}

// Returns the largest value of the newest term.
static float add_term(struct prt_series *s)
{
    float most = 0.0f;
    for (size_t i = 0; i < s->texels; i++) {
        s->sum[i] = glms_vec4_add(s->sum[i], s->term[i]);
        for (int c = 0; c < 3; c++) most = fmaxf(most, fabsf(s->term[i].raw[c]));
    }
    return most;
}

bool prt_series_sum(struct prt_series *s, const struct bake_task *task, float least, bool sampled)
{
    const bool by_samples = sampled && prt_sample_count(&s->scene->options) > 0;
    memset(s->sum, 0, s->texels * sizeof *s->sum);
    for (int b = 0; b < s->scene->options.bounces; b++) {
        reflect(s);
        if (!(by_samples && b == 0 ? sample_all(s, task) : gather_all(s, task))) return false;
        const float most = add_term(s);
        if (most < least || most == 0.0f) break;
    }
    return true;
}
