// From the tensors of a bake, which are untrusted, to tables and images.
#include "techniques/radiosity/probes/probes.h"

#include "techniques/common/probes/depth_shared.h"
#include "techniques/radiosity/probes/probes_shared.h"
#include "techniques/radiosity/radiosity_shared.h"
#include "techniques/radiosity/radiosity_tensors.h"

#include "technique_shaders.h"

#include <math.h>
#include <string.h>

enum { SH = 9, SIDE = PROBE_DEPTH_SIDE, TILE = PROBE_DEPTH_TILE, SLABS = FRAME_PROBE_SLABS + 1 };

struct content {
    const uint32_t *source;
    const uint16_t *factor, *depth;
    const float *place, *sky, *emitted;
};

struct upload {
    struct radiosity_probes *to;
    struct host *host;
    struct gpu *gpu;
    struct content from;
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
           (c->depth = EXPECT(RADIOSITY_PROBE_DEPTH, TENSOR_F16, n, SIDE * SIDE, 2));
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

// ---- whose light a probe shows

static bool is_valid(const struct upload *u, uint32_t probe)
{
    return u->from.place[4 * (size_t)probe + 3] > 0.0f;
}

// What a neighbour along an axis shows; CHART_NONE: nothing yet.
static uint32_t shown_beside(const struct frame_probes *grid, const uint32_t *shown, uint32_t i)
{
    const int32_t row = grid->count_x, layer = row * grid->count_y;
    const int32_t at[3] = { (int32_t)i % row, (int32_t)i % layer / row, (int32_t)i / layer };
    const int32_t count[3] = { row, grid->count_y, grid->count_z }, stride[3] = { 1, row, layer };
    for (int a = 0; a < 3; a++)
        for (int step = -1; step <= 1; step += 2) {
            if (at[a] + step < 0 || at[a] + step >= count[a]) continue;
            const uint32_t value = shown[(int32_t)i + step * stride[a]];
            if (value != CHART_NONE) return value;
        }
    return CHART_NONE;
}

static bool sweep(const struct upload *u, const uint32_t *shown, uint32_t *next)
{
    bool changed = false;
    for (uint32_t i = 0; i < u->to->count; i++) {
        next[i] = shown[i] != CHART_NONE ? shown[i] : shown_beside(&u->to->grid, shown, i);
        changed |= next[i] != shown[i];
    }
    return changed;
}

// The nearest one that is not inside of something, in steps along the axes.
static bool upload_owners(const struct upload *u)
{
    const size_t count = u->to->count, bytes = count * sizeof(uint32_t);
    uint32_t *shown = host_alloc(u->host, count, sizeof *shown);
    uint32_t *next = host_alloc(u->host, count, sizeof *next);
    const bool ok = shown && next;
    for (uint32_t i = 0; ok && i < count; i++) shown[i] = is_valid(u, i) ? i : CHART_NONE;
    while (ok && sweep(u, shown, next)) memcpy(shown, next, bytes);
    for (uint32_t i = 0; ok && i < count; i++)
        if (shown[i] == CHART_NONE) shown[i] = i;
    host_free(u->host, next);
    return upload(u, "probe_owners", shown, bytes, &u->to->owners) && ok;
}

// ---- tables

static bool upload_table(const struct upload *u)
{
    const size_t count = u->to->count;
    const struct frame_probes grid = u->to->grid;
    struct radiosity_gpu_probe *table = host_alloc(u->host, count, sizeof *table);
    for (uint32_t i = 0; table && i < count; i++) {
        vec3s position, offset = vec3_of(0, 0, 0);
        memcpy(&position, u->from.place + 4 * (size_t)i, sizeof position);
        if (is_valid(u, i))
            offset = glms_vec3_divs(glms_vec3_sub(position, radiosity_probe_center(grid, i)),
                                    grid.spacing_m);
        table[i].place = vec4_of(offset, is_valid(u, i) ? 1.0f : 0.0f);
        memcpy(table[i].sky, u->from.sky + SH * (size_t)i, sizeof table[i].sky);
        memcpy(table[i].emitted, u->from.emitted + 3 * SH * (size_t)i, sizeof table[i].emitted);
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
            const uint16_t *factor = u->from.factor + 4 * (i * entries + k);
            uint32_t *word = words[k * count + i];
            word[0] = u->from.source[i * entries + k];
            word[1] = factor[0] | (uint32_t)factor[1] << 16;
            word[2] = factor[2] | (uint32_t)factor[3] << 16;
        }
    return upload(u, "probe_factors", words, count * entries * sizeof *words, &u->to->factors);
}

// ---- distances

// The square of an octahedral map that a texel of its tile shows: beyond an edge the map goes on at
// the same edge, mirrored.
static int square_of(int x, int y)
{
    x -= 1;
    y -= 1;
    if (x < 0 || x >= SIDE) {
        x = x < 0 ? 0 : SIDE - 1;
        y = SIDE - 1 - y;
    }
    if (y < 0 || y >= SIDE) {
        y = y < 0 ? 0 : SIDE - 1;
        x = SIDE - 1 - x;
    }
    return y * SIDE + x;
}

static uint32_t tile_columns(uint32_t probes)
{
    return (uint32_t)ceil(sqrt((double)probes));
}

static void fill_tile(const struct upload *u, uint32_t probe, uint16_t *texels)
{
    const size_t columns = tile_columns(u->to->count), width = columns * TILE;
    const uint16_t *from = u->from.depth + 2 * SIDE * SIDE * (size_t)probe;
    const size_t first = probe / columns * TILE * width + probe % columns * TILE;
    for (int y = 0; y < TILE; y++)
        for (int x = 0; x < TILE; x++)
            memcpy(texels + 2 * (first + (size_t)y * width + (size_t)x), from + 2 * square_of(x, y),
                   2 * sizeof *texels);
}

static bool make_depth(const struct upload *u)
{
    const uint32_t columns = tile_columns(u->to->count);
    const uint32_t rows = (u->to->count + columns - 1) / columns;
    const struct gpu_image_desc desc = { .name = "probe_depth",
                                         .format = GPU_RG16F,
                                         .width = columns * TILE,
                                         .height = rows * TILE,
                                         .usage = GPU_SAMPLED };
    const size_t texels = (size_t)desc.width * desc.height;
    uint16_t *values = host_alloc(u->host, texels, 2 * sizeof *values);
    for (uint32_t i = 0; values && i < u->to->count; i++) fill_tile(u, i, values);
    const bool ok = values && gpu_image_create(u->gpu, &desc, &u->to->depth) &&
                    gpu_image_upload(u->gpu, u->to->depth, 0, 0, values, texels * 4);
    host_free(u->host, values);
    return ok;
}

static bool make_volume(const struct upload *u)
{
    const struct frame_probes grid = u->to->grid;
    const struct gpu_image_desc desc = { .name = "probe_volume",
                                         .dimension = GPU_3D,
                                         .format = GPU_RGBA16F,
                                         .width = (uint32_t)grid.count_x,
                                         .height = (uint32_t)grid.count_y,
                                         .depth = SLABS * (uint32_t)grid.slab,
                                         .usage = GPU_SAMPLED | GPU_STORAGE };
    const struct gpu_sampler_desc linear = { .name = "probe_depth",
                                             .filter = GPU_LINEAR,
                                             .wrap_u = GPU_CLAMP,
                                             .wrap_v = GPU_CLAMP,
                                             .wrap_w = GPU_CLAMP };
    return gpu_image_create(u->gpu, &desc, &u->to->volume) &&
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
        { "apply_some",
          specular ? &shader_radiosity_probes_apply_some_specular_comp
                   : &shader_radiosity_probes_apply_some_comp,
          &p->apply_some },
        { "apply_all",
          specular ? &shader_radiosity_probes_apply_all_specular_comp
                   : &shader_radiosity_probes_apply_all_comp,
          &p->apply_all },
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
    *out = (struct radiosity_probes){ .grid = radiosity_probe_grid(how->map, how->options),
                                      .entries = 2 * (uint32_t)how->options->sources };
    out->count = radiosity_probe_count(out->grid);
    struct upload u = { .to = out, .host = how->host, .gpu = how->gpu };
    return find_tensors(&u, bake) && check_sources(&u, how->map->tree.count) && upload_owners(&u) &&
           upload_table(&u) && upload_factors(&u) && make_depth(&u) && make_volume(&u) &&
           make_pipelines(&u, how->options->specular);
}

void radiosity_probes_finish(struct radiosity_probes *p, struct gpu *gpu)
{
    gpu_buffer *const buffers[] = { &p->owners, &p->table, &p->factors };
    gpu_pipeline *const pipelines[] = { &p->gather, &p->apply_some, &p->apply_all };
    for (int i = 0; i < 3; i++) gpu_buffer_destroy(gpu, buffers[i]);
    for (int i = 0; i < 3; i++) gpu_pipeline_destroy(gpu, pipelines[i]);
    gpu_image_destroy(gpu, &p->volume);
    gpu_image_destroy(gpu, &p->depth);
}

uint64_t radiosity_probes_memory(const struct radiosity_options *options)
{
    const uint64_t probes = radiosity_probes_most(options);
    return probes * (sizeof(struct radiosity_gpu_probe) + 4 + 24 * (uint64_t)options->sources +
                     4 * TILE * TILE + 8 * SLABS);
}
