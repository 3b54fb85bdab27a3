#include "techniques/ort/bake/transfer.h"

#include "bake/plan.h"

#include <math.h>
#include <string.h>

bool ort_transfer_init(struct ort_transfer *out, const struct bake_task *task)
{
    const struct ort_scene *scene = task->job;
    const struct tensor *patches = bake_task_input(task, ORT_PATCHES);
    const struct tensor *bounces = bake_task_input(task, ORT_BOUNCES);
    if (!patches || !bounces || !ort_find_texels(&out->texels, task)) return false;
    out->patches = patches->data;
    out->bounces = bounces->data;
    out->patch_count = ort_patch_count(scene->map.texel_count);
    return true;
}

bool ort_receiver_init(struct ort_receiver *out, struct host *host, uint32_t patches)
{
    *out = (struct ort_receiver){ .indirect = host_alloc(host, 3 * (size_t)patches, sizeof(float)),
                                  .hit = host_alloc(host, 3 * (size_t)patches, sizeof(float)),
                                  .sent = host_alloc(host, 3 * (size_t)patches, sizeof(float)) };
    return out->indirect && out->hit && out->sent;
}

void ort_receiver_finish(struct ort_receiver *receiver, struct host *host)
{
    host_free(host, receiver->indirect);
    host_free(host, receiver->hit);
    host_free(host, receiver->sent);
}

// ---- a row

// Shares of the rays, times the reflectance of the texels that they meet.
static void add_hits(const struct ort_transfer *transfer, struct ort_receiver *r)
{
    const struct ort_texels *t = &transfer->texels;
    const size_t rays = (size_t)t->scene->options.rays, n = transfer->patch_count;
    const uint32_t *hits = t->hits + r->texel * rays;
    for (size_t k = 0; k < rays && hits[k] != CHART_NONE; k++) {
        const float *albedo = t->albedo + 4 * (size_t)hits[k];
        const uint32_t p = t->scene->patch_of[hits[k]];
        for (size_t c = 0; c < 3; c++) {
            const float share = albedo[c] / (float)rays;
            r->single[c] += share;
            r->hit[c * n + p] += share;
            r->sent[c * n + p] += (0.5f + 0.5f * albedo[3]) * share;
        }
    }
}

static void add_scaled(float *restrict sum, const float *restrict row, float factor, size_t count)
{
    for (size_t q = 0; q < count; q++) sum[q] += factor * row[q];
}

static void add_bounces(const struct ort_transfer *transfer, struct ort_receiver *r)
{
    const size_t n = transfer->patch_count;
    for (size_t c = 0; c < 3; c++) {
        float *indirect = r->indirect + c * n;
        for (size_t p = 0; p < n; p++)
            if (r->sent[c * n + p] > 0.0f)
                add_scaled(indirect, transfer->bounces + (c * n + p) * n, r->sent[c * n + p], n);
        for (size_t q = 0; q < n; q++) r->multiple[c] += indirect[q];
    }
}

struct scattering {
    const struct ort_transfer *transfer;
    struct ort_receiver *receiver;
};

static void add_near(void *user, uint32_t from)
{
    const struct scattering *s = user;
    const float area = ort_texel_area(&s->transfer->texels, from);
    float share[3];
    ort_transfer_scattered(s->transfer, s->receiver, from, share);
    for (int c = 0; c < 3; c++) s->receiver->scattered[c] += share[c] * area;
}

static void add_scattered(const struct ort_transfer *transfer, struct ort_receiver *r)
{
    const struct ort_scene *scene = transfer->texels.scene;
    ort_near_visit(&scene->near, chart_texel_of(&scene->map.charts, r->texel)->centroid, add_near,
                   &(struct scattering){ transfer, r });
}

bool ort_receive(const struct ort_transfer *transfer, uint32_t texel, struct ort_receiver *r)
{
    const size_t bytes = 3 * (size_t)transfer->patch_count * sizeof(float);
    r->texel = texel;
    r->at = ort_texel_of(&transfer->texels, texel);
    memset(r->indirect, 0, bytes);
    memset(r->hit, 0, bytes);
    memset(r->sent, 0, bytes);
    memset(r->single, 0, sizeof r->single);
    memset(r->multiple, 0, sizeof r->multiple);
    memset(r->scattered, 0, sizeof r->scattered);
    if (!(r->at.area > 0.0f)) return false;
    if (transfer->texels.scene->options.transfer != ORT_SCATTERING) {
        add_hits(transfer, r);
        add_bounces(transfer, r);
    }
    if (transfer->texels.scene->kernel) add_scattered(transfer, r);
    return true;
}

// ---- between two texels

static bool sees(const struct trace_scene *trace, const struct ort_texel *a,
                 const struct ort_texel *b)
{
    const vec3s from = glms_vec3_muladds(a->normal, a->reach, a->position);
    const vec3s to = glms_vec3_muladds(b->normal, b->reach, b->position);
    return !trace_occluded(trace, from, glms_vec3_sub(to, from), 1.0f);
}

// A disk of the source's area in place of a point: the form factor stays below 1 (Wallace, Elmquist
// & Haines 1989, "A Ray Tracing Algorithm for Progressive Radiosity").
void ort_transfer_single(const struct ort_transfer *transfer, const struct ort_receiver *to,
                         uint32_t from, float out[3])
{
    const struct ort_texel source = ort_texel_of(&transfer->texels, from);
    const vec3s between = glms_vec3_sub(source.position, to->at.position);
    const float distance2 = glms_vec3_norm2(between);
    const float cosines = glms_vec3_dot(between, to->at.normal) *
                          -glms_vec3_dot(between, source.normal) / fmaxf(distance2, 1e-30f);
    const bool facing =
        glms_vec3_dot(between, to->at.normal) > 0.0f && cosines > 0.0f && source.area > 0.0f;
    const float factor = facing && sees(transfer->texels.scene->trace, &to->at, &source)
                             ? cosines / (GLM_PIf * distance2 + source.area)
                             : 0.0f;
    for (int c = 0; c < 3; c++) out[c] = factor * source.reflectance[c];
}

// Light of a patch comes from its texels by area and reflectance.
static void share_patch(const struct ort_transfer *transfer, const float *of_patches, uint32_t from,
                        float out[3])
{
    const uint32_t q = transfer->texels.scene->patch_of[from];
    const struct ort_patch *patch = &transfer->patches[q];
    const float *reflectance = transfer->texels.albedo + 4 * (size_t)from;
    for (size_t c = 0; c < 3; c++) {
        const float of_patch = patch->area * patch->reflectance[c];
        out[c] = of_patch > 0.0f
                     ? of_patches[c * transfer->patch_count + q] * reflectance[c] / of_patch
                     : 0.0f;
    }
}

void ort_transfer_patch(const struct ort_transfer *transfer, const struct ort_receiver *to,
                        uint32_t from, float out[3])
{
    share_patch(transfer, to->hit, from, out);
}

void ort_transfer_multiple(const struct ort_transfer *transfer, const struct ort_receiver *to,
                           uint32_t from, float out[3])
{
    share_patch(transfer, to->indirect, from, out);
}

void ort_transfer_scattered(const struct ort_transfer *transfer, const struct ort_receiver *to,
                            uint32_t from, float out[3])
{
    const struct ort_scene *scene = transfer->texels.scene;
    const struct charts *charts = &scene->map.charts;
    const vec3s between = glms_vec3_sub(chart_texel_of(charts, from)->centroid,
                                        chart_texel_of(charts, to->texel)->centroid);
    const struct ort_strip strip = scene->strips[from];
    const float area = ort_texel_area(&transfer->texels, from) / (float)strip.parts;
    memset(out, 0, 3 * sizeof *out);
    for (int i = -strip.parts / 2; i <= strip.parts / 2; i++) {
        float share[3];
        const vec3s part = glms_vec3_muladds(strip.side, (float)i, between);
        const bool is_own = from == to->texel && i == 0;
        ort_kernel_at(scene->kernel, is_own ? 0.0f : fmaxf(glms_vec3_norm(part), 1e-30f), area,
                      share);
        for (int c = 0; c < 3; c++) out[c] += share[c] / (float)strip.parts;
    }
}
