// From the tensors of a bake, which are untrusted, to tables and images.
#include "techniques/radiosity/probes/probes.h"

#include "techniques/common/probes/rays.h"
#include "techniques/radiosity/probes/probes_shared.h"
#include "techniques/radiosity/radiosity_shared.h"
#include "techniques/radiosity/radiosity_tensors.h"

#include "technique_shaders.h"

#include <string.h>

enum { SH = 9 };

struct content {
    const uint32_t *source;
    const uint16_t *factor, *depth;
    const vec4s *place;
    const float *sky, *emitted;
};

struct upload {
    struct radiosity_probes *to;
    struct host *host;
    struct gpu *gpu;
    struct content from;
    uint32_t *owner; // of each probe: the one whose light it shows
};

static bool find_tensors(struct upload *u, const struct tensors *bake)
{
    const uint64_t n = u->to->count, k = u->to->entries;
    struct content *c = &u->from;
#define EXPECT(name, type, ...)                                                                    \
    tensors_expect(u->host, bake, name, type,                                                      \
                   (int)(sizeof((const uint64_t[]){ __VA_ARGS__ }) / sizeof(uint64_t)),            \
                   (const uint64_t[]){ __VA_ARGS__ })
    return (c->source = EXPECT(RADIOSITY_PROBE_SOURCE, TENSOR_U32, n, k)) &&
           (c->factor = EXPECT(RADIOSITY_PROBE_FACTOR, TENSOR_F16, n, k, 4)) &&
           (c->place = EXPECT(RADIOSITY_PROBE_PLACE, TENSOR_F32, n, 4)) &&
           (c->sky = EXPECT(RADIOSITY_PROBE_SKY, TENSOR_F32, n, SH)) &&
           (c->emitted = EXPECT(RADIOSITY_PROBE_EMITTED, TENSOR_F32, n, SH, 3)) &&
           (c->depth = EXPECT(RADIOSITY_PROBE_DEPTH, TENSOR_F16, n, PROBE_DEPTHS, 2));
#undef EXPECT
}

static bool check_sources(const struct upload *u, uint32_t nodes)
{
    const size_t count = (size_t)u->to->count * u->to->entries;
    for (size_t i = 0; i < count; i++)
        if (u->from.source[i] >= (nodes > 0 ? nodes : 1))
            return host_fail(u->host, FAIL_FORMAT,
                             "bake of radiosity: a probe's source of light is beyond %u", nodes);
    return true;
}

static bool upload(const struct upload *u, const char *name, void *items, size_t bytes,
                   gpu_buffer *out)
{
    const struct gpu_buffer_desc desc = { name, bytes, GPU_BUFFER_STORAGE };
    const bool ok = items && gpu_buffer_create(u->gpu, &desc, out) &&
                    gpu_buffer_upload(u->gpu, *out, 0, items, bytes);
    host_free(u->host, items);
    return ok;
}

// ---- tables

static bool upload_table(const struct upload *u)
{
    const size_t count = u->to->count;
    const struct frame_probes grid = u->to->volume.grid;
    struct radiosity_gpu_probe *table = host_alloc(u->host, count, sizeof *table);
    for (uint32_t i = 0; table && i < count; i++) {
        table[i].place = probe_offset(grid, i, u->from.place[i]);
        memcpy(table[i].sky, u->from.sky + SH * (size_t)u->owner[i], sizeof table[i].sky);
        memcpy(table[i].emitted, u->from.emitted + 3 * SH * (size_t)u->owner[i],
               sizeof table[i].emitted);
    }
    return upload(u, "probe_table", table, count * sizeof *table, &u->to->table);
}

// Entries of all probes side by side, as those of texels.
static bool upload_factors(const struct upload *u)
{
    const size_t count = u->to->count, entries = u->to->entries;
    uint32_t(*words)[3] = host_alloc(u->host, count * entries, sizeof *words);
    for (size_t i = 0; words && i < count; i++)
        for (size_t k = 0; k < entries; k++) {
            const size_t from = u->owner[i] * entries + k;
            const uint16_t *factor = u->from.factor + 4 * from;
            uint32_t *word = words[k * count + i];
            word[0] = u->from.source[from];
            word[1] = factor[0] | (uint32_t)factor[1] << 16;
            word[2] = factor[2] | (uint32_t)factor[3] << 16;
        }
    return upload(u, "probe_factors", words, count * entries * sizeof *words, &u->to->factors);
}

// ---- images

static bool make_images(const struct upload *u)
{
    struct probe_volume *volume = &u->to->volume;
    const struct gpu_image_desc desc =
        probe_volume_desc("probe_volume", volume->grid, FRAME_PROBE_SLABS + 1);
    const struct gpu_sampler_desc linear = { .name = "probe_depth",
                                             .filter = GPU_LINEAR,
                                             .wrap_u = GPU_CLAMP,
                                             .wrap_v = GPU_CLAMP,
                                             .wrap_w = GPU_CLAMP };
    return probe_depth_create(u->host, u->gpu, u->to->count, u->from.depth, &volume->depth) &&
           gpu_image_create(u->gpu, &desc, &volume->image) &&
           gpu_sampler_get(u->gpu, &linear, &u->to->linear);
}

static bool make_pipelines(const struct upload *u, bool specular)
{
    struct radiosity_probes *p = u->to;
    const struct {
        const char *name;
        const struct gpu_shader *shader;
        gpu_pipeline *out;
    } rows[] = {
        { "probes", &shader_radiosity_probes_gather_comp, &p->gather },
        { "apply",
          specular ? &shader_radiosity_probes_apply_specular_comp
                   : &shader_radiosity_probes_apply_diffuse_comp,
          &p->apply },
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
        if (!gpu_compute_pipeline_create(u->gpu, rows[i].name, rows[i].shader, NULL, 0,
                                         rows[i].out))
            return false;
    return true;
}

bool radiosity_probes_init(struct radiosity_probes *out, const struct radiosity_probes_create *how,
                           const struct tensors *bake)
{
    *out = (struct radiosity_probes){ .entries = 2 * (uint32_t)how->options->sources };
    out->volume.grid = radiosity_probe_grid(how->map, how->options);
    out->count = probe_grid_count(out->volume.grid);
    struct upload u = { .to = out, .host = how->host, .gpu = how->gpu };
    const bool ok = find_tensors(&u, bake) && check_sources(&u, how->map->tree.count) &&
                    (u.owner = probe_owners(u.host, out->volume.grid, u.from.place)) &&
                    upload_table(&u) && upload_factors(&u) && make_images(&u) &&
                    make_pipelines(&u, how->options->specular);
    host_free(u.host, u.owner);
    return ok;
}

void radiosity_probes_finish(struct radiosity_probes *p, struct gpu *gpu)
{
    gpu_buffer *const buffers[] = { &p->table, &p->factors };
    gpu_pipeline *const pipelines[] = { &p->gather, &p->apply };
    for (int i = 0; i < 2; i++) gpu_buffer_destroy(gpu, buffers[i]);
    for (int i = 0; i < 2; i++) gpu_pipeline_destroy(gpu, pipelines[i]);
    gpu_image_destroy(gpu, &p->volume.image);
    gpu_image_destroy(gpu, &p->volume.depth);
}

uint64_t radiosity_probes_memory(const struct radiosity_options *options)
{
    const uint64_t probes = radiosity_probes_most(options);
    return probes * (sizeof(struct radiosity_gpu_probe) + 24 * (uint64_t)options->sources +
                     PROBE_VOLUME_BYTES);
}
