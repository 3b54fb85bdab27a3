// Training: passes of paths, each guided by the records of the one before.
//
// Paths write their records to places of their own, and the tree is built from them in order: no
// sum depends on the order in which threads finish.
#include "trace/guide_train.h"

#include "core/parallel.h"
#include "core/rng.h"

#include <math.h>
#include <string.h>

enum {
    BATCH_RECORDS = PATH_BATCH * PATH_TRAIL,
    PATHS_PER_PIXEL = 2, // of all passes
    MAX_PATHS = 122880,  // of all passes: the last one has up to 2¹⁶ and 45 MB of records
    PASSES = 4,          // each with twice the paths of the one before
};
// Estimated gains of variance: at the end, to pay for the time of guided samples, and before the
// last passes, to train any further. Estimates are low: noise of later vertices is that of
// paths without the guide in training.
static const double MIN_GAIN = 1.06, PROMISING_GAIN = 1.005;
// Sample numbers of the first pass; those of images are smaller.
static const uint32_t FIRST_SAMPLE = UINT32_C(1) << 31;

struct pass {
    const struct guide_training *training;
    const struct guide *guide;
    uint32_t number, paths;
    struct guide_record *records; // [batch][BATCH_RECORDS]
    uint32_t *counts;             // [batch]
    uint64_t *rays;               // [batch]
};

// ---- records

// Variance counts relative to the squared light of its pixel, as relmse does, with a lower bound.
static float importance_scale(const struct guide *guide, const struct path_vertex *first)
{
    static const float LEAST = 0.1f; // of the mean
    if (!guide) return 1.0f;
    float light = guide_find(guide, first->position, first->normal)->radiance;
    float least = LEAST * guide->radiance, square = light * light + least * least;
    return square > 0.0f ? 1.0f / square : 0.0f;
}

// arriving: radiance from the sampled direction, cd/m².
static struct guide_record record_of(const struct path_vertex *v, vec3s arriving)
{
    struct guide_record r = { .position = v->position, .axis = direction_axis(v->normal) };
    struct direction_point p;
    r.importance = v->throughput * v->throughput;
    r.radiance = luminance(v->direct);
    if (!(v->cosine > 0.0f) || !direction_to_square(r.axis, v->direction, &p)) return r;
    float scale = v->cosine * p.sr, irradiance = luminance(arriving) * scale;
    r.at = p.at;
    r.reflected = luminance(glms_vec3_mul(v->f, arriving)) * scale;
    r.radiance += luminance(glms_vec3_mul(v->f, arriving)) * v->cosine / v->pdf;
    r.share = v->share;
    r.bsdf = v->bsdf_pdf * p.sr;
    r.all = v->pdf * p.sr;
    r.weight = irradiance / r.all;
    if (!(r.reflected > 0.0f) || !isfinite(r.weight)) r.reflected = 0.0f;
    return r;
}

// From the end of the path: light that leaves a vertex arrives at the one before.
static uint32_t add_records(const struct path_trail *trail, const struct guide *guide,
                            struct guide_record *out)
{
    if (trail->count == 0) return 0;
    vec3s leaving = vec3_of(0, 0, 0);
    float scale = importance_scale(guide, &trail->vertices[0]);
    for (int i = trail->count - 1; i >= 0; i--) {
        const struct path_vertex *v = &trail->vertices[i];
        vec3s arriving = glms_vec3_add(v->light, leaving);
        out[i] = record_of(v, arriving);
        out[i].importance *= scale;
        leaving = vec3_of(0, 0, 0);
        if (v->cosine > 0.0f)
            leaving = glms_vec3_scale(glms_vec3_mul(v->f, arriving), v->cosine / v->pdf);
    }
    return (uint32_t)trail->count;
}

// ---- passes

static uint32_t batches_of(uint32_t paths)
{
    return (paths + PATH_BATCH - 1) / PATH_BATCH;
}

static void trace_batch(void *user, size_t batch)
{
    const struct pass *pass = user;
    const struct guide_training *t = pass->training;
    struct path_settings settings = t->settings;
    settings.guide = pass->guide;
    if (settings.bounces < 0 || settings.bounces > PATH_TRAIL) settings.bounces = PATH_TRAIL;
    struct path_start starts[PATH_BATCH];
    struct path_sample samples[PATH_BATCH];
    struct path_trail trails[PATH_BATCH];
    uint32_t first = (uint32_t)batch * PATH_BATCH, count = 0;
    unsigned before = embree_flush_denormals();
    for (; count < PATH_BATCH && first + count < pass->paths; count++) {
        vec2s at = r2_sequence(first + count);
        starts[count] =
            t->start(t->user, at.x * (float)t->width, at.y * (float)t->height, &pass->rays[batch]);
        trails[count].count = 0;
        samples[count] = (struct path_sample){ .start = &starts[count],
                                               .pixel = first + count,
                                               .sample = FIRST_SAMPLE + pass->number,
                                               .trail = &trails[count] };
    }
    path_trace(&settings, samples, (int)count, &pass->rays[batch]);
    struct guide_record *out = pass->records + batch * BATCH_RECORDS;
    for (uint32_t i = 0; i < count; i++)
        pass->counts[batch] += add_records(&trails[i], pass->guide, out + pass->counts[batch]);
    embree_restore_denormals(before);
}

// Moves the records of all batches together.
static size_t compact(const struct pass *pass)
{
    size_t total = 0;
    for (size_t batch = 0; batch < batches_of(pass->paths); batch++) {
        const struct guide_record *from = pass->records + batch * BATCH_RECORDS;
        memmove(pass->records + total, from, pass->counts[batch] * sizeof *from);
        total += pass->counts[batch];
    }
    return total;
}

static bool run_pass(const struct guide_training *t, uint32_t number, uint32_t paths,
                     struct guide **guide, double *gain, uint64_t *rays)
{
    size_t batches = batches_of(paths);
    struct pass pass = { .training = t, .guide = *guide, .number = number, .paths = paths };
    pass.records = host_alloc(t->host, batches * BATCH_RECORDS, sizeof *pass.records);
    pass.counts = host_alloc(t->host, batches, sizeof *pass.counts);
    pass.rays = host_alloc(t->host, batches, sizeof *pass.rays);
    bool ok = pass.records && pass.counts && pass.rays;
    if (ok) {
        parallel_for(batches, 1, trace_batch, &pass);
        for (size_t i = 0; i < batches; i++) *rays += pass.rays[i];
        guide_destroy(t->host, *guide);
        ok = guide_fit(t->host, pass.records, compact(&pass), guide, gain);
    }
    host_free(t->host, pass.records);
    host_free(t->host, pass.counts);
    host_free(t->host, pass.rays);
    return ok;
}

static bool run_passes(const struct guide_training *t, uint32_t paths, struct guide **guide,
                       double *gain, uint64_t *rays)
{
    for (uint32_t i = 0; i < PASSES; i++) {
        uint32_t part = (paths << i) / ((1u << PASSES) - 1u);
        if (part == 0) continue;
        if (!run_pass(t, i, part, guide, gain, rays)) return false;
        if (!*guide || (i > 0 && *gain < PROMISING_GAIN)) break;
    }
    return true;
}

bool guide_train(const struct guide_training *t, struct guide **guide, uint64_t *rays)
{
    const struct light_table *lights = &t->settings.scene->lights;
    double gain = 1.0, wanted = (double)PATHS_PER_PIXEL * t->width * t->height;
    *guide = NULL;
    if (!lights->has_sky && lights->punctual_count == 0) return true;
    bool ok = run_passes(t, (uint32_t)fmin(wanted, MAX_PATHS), guide, &gain, rays);
    if (ok && gain > MIN_GAIN) return true;
    guide_destroy(t->host, *guide);
    *guide = NULL;
    return ok;
}
