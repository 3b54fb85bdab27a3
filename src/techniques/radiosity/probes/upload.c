// From the tensors of a bake, which are untrusted, to tables and images.
#include "techniques/radiosity/radiosity_state.h"

#include "techniques/common/probes/rays.h"
#include "techniques/radiosity/probes/probes_shared.h"

#include <string.h>

enum { SH = 9 };

struct content {
    const uint32_t *source;
    const uint16_t *factor, *depth;
    const vec4s *place;
    const float *sky, *emission;
    uint64_t columns; // of emission, at least 1
    uint32_t *owner;  // of each probe: the one whose light it shows
};

static bool find_tensors(struct radiosity *s, const struct tensors *bake, struct content *c)
{
    const uint64_t n = s->probes.count, k = s->probes.entries;
#define EXPECT(...) TENSORS_EXPECT(s->host, bake, __VA_ARGS__)
    return (c->source = EXPECT(RADIOSITY_PROBE_SOURCE, TENSOR_U32, n, k)) &&
           (c->factor = EXPECT(RADIOSITY_PROBE_FACTOR, TENSOR_F16, n, k, 4)) &&
           (c->place = EXPECT(RADIOSITY_PROBE_PLACE, TENSOR_F32, n, 4)) &&
           (c->sky = EXPECT(RADIOSITY_PROBE_SKY, TENSOR_F32, n, SH)) &&
           (c->emission = EXPECT(RADIOSITY_PROBE_EMISSION, TENSOR_F32, n, c->columns, SH)) &&
           (c->depth = EXPECT(RADIOSITY_PROBE_DEPTH, TENSOR_F16, n, PROBE_DEPTHS, 2));
#undef EXPECT
}

static bool check_sources(struct radiosity *s, const struct content *c)
{
    const size_t count = (size_t)s->probes.count * s->probes.entries;
    const uint32_t nodes = s->map.tree.count;
    for (size_t i = 0; i < count; i++)
        if (c->source[i] >= (nodes > 0 ? nodes : 1))
            return host_fail(s->host, FAIL_FORMAT,
                             "bake of radiosity: a probe's source of light is beyond %u", nodes);
    return true;
}

static bool upload_table(struct radiosity *s, const struct content *c)
{
    const size_t count = s->probes.count;
    const struct frame_probes grid = s->probes.volume.grid;
    struct radiosity_gpu_probe *table = host_alloc(s->host, count, sizeof *table);
    for (uint32_t i = 0; table && i < count; i++) {
        table[i].place = probe_offset(grid, i, c->place[i]);
        memcpy(table[i].sky, c->sky + SH * (size_t)c->owner[i], sizeof table[i].sky);
    }
    return light_map_buffer_upload(s->host, s->gpu, "probe_table", table, count * sizeof *table,
                                   &s->probes.table);
}

static bool upload_emission(struct radiosity *s, const struct content *c)
{
    const size_t count = s->probes.count;
    struct radiosity_gpu_probe_emission *table =
        host_alloc(s->host, c->columns * count, sizeof *table);
    for (size_t k = 0; table && k < c->columns; k++)
        for (size_t i = 0; i < count; i++)
            memcpy(&table[k * count + i], c->emission + SH * (c->owner[i] * c->columns + k),
                   sizeof *table);
    return light_map_buffer_upload(s->host, s->gpu, "probe_emission", table,
                                   c->columns * count * sizeof *table, &s->probes.emission);
}

// Entries of all probes side by side, as those of texels.
static bool upload_factors(struct radiosity *s, const struct content *c)
{
    const size_t count = s->probes.count, entries = s->probes.entries;
    uint32_t(*words)[3] = host_alloc(s->host, count * entries, sizeof *words);
    for (size_t i = 0; words && i < count; i++)
        for (size_t k = 0; k < entries; k++) {
            const size_t from = c->owner[i] * entries + k;
            const uint16_t *factor = c->factor + 4 * from;
            uint32_t *word = words[k * count + i];
            word[0] = c->source[from];
            word[1] = factor[0] | (uint32_t)factor[1] << 16;
            word[2] = factor[2] | (uint32_t)factor[3] << 16;
        }
    return light_map_buffer_upload(s->host, s->gpu, "probe_factors", words,
                                   count * entries * sizeof *words, &s->probes.factors);
}

bool radiosity_probes_upload(struct radiosity *s, const struct tensors *bake)
{
    struct radiosity_probes *p = &s->probes;
    struct content c = { .columns = emission_basis_rows(&s->materials.emission) };
    p->entries = 2 * (uint32_t)s->options.sources;
    p->volume.grid = radiosity_probe_grid(&s->map, &s->options);
    p->count = probe_grid_count(p->volume.grid);
    const bool ok = find_tensors(s, bake, &c) && check_sources(s, &c) &&
                    (c.owner = probe_owners(s->host, p->volume.grid, c.place)) &&
                    upload_table(s, &c) && upload_factors(s, &c) && upload_emission(s, &c) &&
                    probe_depth_create(s->host, s->gpu, p->count, c.depth, &p->volume.depth);
    host_free(s->host, c.owner);
    return ok;
}
