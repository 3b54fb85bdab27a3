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
    BATCH_RECORDS = PATH_BATCH * PATH_TRAIL * PATH_TECHNIQUES,
    PATHS_PER_PIXEL = 1, // of all passes
    MAX_PATHS = 114688,  // of all passes: the last one has up to 2¹⁶ and 25 MB of records
    PASSES = 3,          // each with twice the paths of the one before
};
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

static struct guide_record record_of(const struct path_vertex *v, const struct path_found *found)
{
    struct guide_record r = { .position = v->position, .axis = direction_axis(v->normal) };
    struct direction_point p;
    if (!(found->pdf > 0.0f) || !direction_to_square(r.axis, found->direction, &p)) return r;
    float scale = found->cosine * p.sr, irradiance = luminance(found->light) * scale;
    r.at = p.at;
    r.reflected = luminance(glms_vec3_mul(found->f, found->light)) * scale;
    r.bsdf = found->bsdf_pdf * p.sr;
    r.all = found->pdf * p.sr;
    r.moment = irradiance * irradiance / r.all;
    if (!(r.reflected > 0.0f) || !isfinite(r.moment)) r.reflected = 0.0f;
    return r;
}

static uint32_t add_records(const struct path_trail *trail, struct guide_record *out)
{
    uint32_t count = 0;
    for (int i = 0; i < trail->count; i++) {
        const struct path_vertex *v = &trail->vertices[i];
        out[count] = record_of(v, &v->found[PATH_BSDF]);
        out[count].visit = true;
        out[count++].importance = v->throughput * v->throughput;
        out[count] = record_of(v, &v->found[PATH_GUIDE]);
        if (out[count].reflected > 0.0f) count++;
    }
    return count;
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
        pass->counts[batch] += add_records(&trails[i], out + pass->counts[batch]);
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

// Measured (bench/results/reference.md). With punctual lights a guided ray needs the surface that
// it hits and a shadow ray, else occlusion alone.
static double ray_cost(const struct light_table *lights)
{
    return lights->punctual_count > 0 ? 1.3 : 0.9;
}

static bool run_pass(const struct guide_training *t, uint32_t number, uint32_t paths,
                     struct guide **guide, uint64_t *rays)
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
        size_t count = compact(&pass);
        double cost = number + 1 < PASSES ? 0.0 : ray_cost(&t->settings.scene->lights);
        ok = guide_fit(t->host, pass.records, count, cost, guide);
    }
    host_free(t->host, pass.records);
    host_free(t->host, pass.counts);
    host_free(t->host, pass.rays);
    return ok;
}

bool guide_train(const struct guide_training *t, struct guide **guide, uint64_t *rays)
{
    const struct light_table *lights = &t->settings.scene->lights;
    *guide = NULL;
    if (!lights->has_sky && lights->punctual_count == 0) return true;
    double wanted = (double)PATHS_PER_PIXEL * t->width * t->height;
    uint32_t paths = (uint32_t)fmin(wanted, MAX_PATHS);
    for (uint32_t i = 0; i < PASSES; i++) {
        uint32_t part = (paths << i) / ((1u << PASSES) - 1u);
        if (part == 0) continue;
        if (!run_pass(t, i, part, guide, rays)) {
            guide_destroy(t->host, *guide);
            *guide = NULL;
            return false;
        }
        if (!*guide) break;
    }
    return true;
}
