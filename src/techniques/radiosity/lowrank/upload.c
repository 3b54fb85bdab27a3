// From the tensors of a bake, which are untrusted, to tables on the GPU. Modes that a region has
// not are left out.
#include "techniques/radiosity/lowrank/lowrank.h"

#include "core/half.h"
#include "techniques/radiosity/radiosity_table.h"
#include "techniques/radiosity/radiosity_tensors.h"

#include "technique_shaders.h"

#include <string.h>

enum { COMPONENTS = 3, MODE_BYTES = 12 };

struct content {
    const uint32_t *source;
    const uint16_t *project, *expand;
    const float *scale;
    size_t sources, modes; // of a region in the file
};

// Of a region on the GPU.
struct region {
    uint32_t projection, source, mode, counts;
};

struct upload {
    struct radiosity_lowrank *to;
    const struct radiosity_lowrank_create *how;
    struct content from;
    struct region *regions;
    size_t projections, sources, modes; // of all
};

static bool find_tensors(struct upload *u, const struct tensors *bake)
{
    const uint64_t n = radiosity_rows(u->to->regions), k = u->from.sources, m = u->from.modes;
    struct content *c = &u->from;
#define EXPECT(name, type, ...)                                                                    \
    tensors_expect(u->how->host, bake, name, type,                                                 \
                   (int)(sizeof((const uint64_t[]){ __VA_ARGS__ }) / sizeof(uint64_t)),            \
                   (const uint64_t[]){ __VA_ARGS__ })
    return (c->source = EXPECT(RADIOSITY_REGION_SOURCE, TENSOR_U32, n, k)) &&
           (c->project = EXPECT(RADIOSITY_REGION_PROJECT, TENSOR_U16, n, k, m)) &&
           (c->scale = EXPECT(RADIOSITY_REGION_SCALE, TENSOR_F32, n, m)) &&
           (c->expand =
                EXPECT(RADIOSITY_REGION_EXPAND, TENSOR_F16, n, RADIOSITY_REGION, m, COMPONENTS));
#undef EXPECT
}

static bool check_sources(const struct upload *u)
{
    const uint32_t nodes = u->how->map->tree.count;
    for (size_t i = 0; i < u->to->regions * u->from.sources; i++)
        if (u->from.source[i] >= nodes)
            return host_fail(u->how->host, FAIL_FORMAT,
                             "bake of radiosity: a region's source of light is beyond %u", nodes);
    return true;
}

// The norm of a region's transfer is a few times the square root of its texels, which the weights
// of the components quadruple at most (basis.c): what a mode has is below the number of texels.
static const float MOST_WEIGHT = RADIOSITY_REGION;

static bool check_scales(const struct upload *u)
{
    for (size_t i = 0; i < u->to->regions * u->from.modes; i++)
        if (!(u->from.scale[i] >= 0.0f && INT16_MAX * u->from.scale[i] <= MOST_WEIGHT))
            return host_fail(u->how->host, FAIL_FORMAT,
                             "bake of radiosity: the scale %g of a mode is not in 0…%g",
                             (double)u->from.scale[i], (double)(MOST_WEIGHT / INT16_MAX));
    return true;
}

// Irradiance: that of the first mode is a sum of form factors, others have 1 as the largest.
static bool check_expansions(const struct upload *u)
{
    const size_t rows = u->to->regions * RADIOSITY_REGION * u->from.modes;
    const uint16_t two = half_from_float(2.0f), sign = 0x8000;
    for (size_t i = 0; i < rows; i++)
        if ((u->from.expand[COMPONENTS * i] & ~sign) >= two)
            return host_fail(u->how->host, FAIL_FORMAT,
                             "bake of radiosity: the irradiance of a mode is not in -2…2");
    return true;
}

// ---- sizes

static uint32_t modes_of(const struct upload *u, size_t region)
{
    size_t count = u->from.modes;
    while (count > 0 && u->from.scale[region * u->from.modes + count - 1] == 0.0f) count--;
    return (uint32_t)count;
}

// Up to the last one that weighs in a mode.
static uint32_t sources_of(const struct upload *u, size_t region)
{
    const size_t modes = u->from.modes;
    const uint16_t *rows = u->from.project + region * u->from.sources * modes;
    size_t count = u->from.sources * modes;
    while (count > 0 && rows[count - 1] == 0) count--;
    return (uint32_t)((count + modes - 1) / modes);
}

static void find_sizes(struct upload *u)
{
    double entries = 0.0;
    for (uint32_t r = 0; r < u->to->regions; r++) {
        const uint32_t tuples = (modes_of(u, r) + RADIOSITY_MODES - 1) / RADIOSITY_MODES;
        const uint32_t loads =
            (sources_of(u, r) + RADIOSITY_PROJECT_LOCAL - 1) / RADIOSITY_PROJECT_LOCAL;
        u->regions[r] =
            (struct region){ (uint32_t)u->projections, (uint32_t)u->sources, (uint32_t)u->modes,
                             tuples | loads << RADIOSITY_REGION_SHIFT };
        u->projections += (size_t)tuples * loads * RADIOSITY_PROJECT_LOCAL;
        u->sources += (size_t)loads * RADIOSITY_PROJECT_LOCAL;
        u->modes += (size_t)tuples * RADIOSITY_MODES;
        entries += (double)tuples * loads * RADIOSITY_PROJECT_LOCAL * RADIOSITY_MODES;
    }
    u->to->mean_entries = (float)(entries / u->to->regions);
    u->to->mean_modes = (float)u->modes / (float)u->to->regions;
}

static uint32_t tuples_of(const struct region *region)
{
    return region->counts & ((1u << RADIOSITY_REGION_SHIFT) - 1u);
}

static uint32_t loads_of(const struct region *region)
{
    return region->counts >> RADIOSITY_REGION_SHIFT;
}

// ---- tables

static bool upload(const struct upload *u, const char *name, enum gpu_format format, void *entries,
                   size_t count, gpu_image *out)
{
    return radiosity_table_upload(u->how->host, u->how->gpu, name, format, entries, count, out);
}

static void *room_for(const struct upload *u, size_t count, size_t bytes)
{
    return host_alloc(u->how->host, radiosity_table_room(count), bytes);
}

static bool upload_sources(const struct upload *u)
{
    uint32_t *nodes = room_for(u, u->sources, sizeof *nodes);
    for (size_t r = 0; nodes && r < u->to->regions; r++) {
        const struct region *region = &u->regions[r];
        const size_t room = (size_t)loads_of(region) * RADIOSITY_PROJECT_LOCAL;
        const size_t count = room < u->from.sources ? room : u->from.sources;
        memcpy(nodes + region->source, u->from.source + r * u->from.sources, count * sizeof *nodes);
    }
    return upload(u, "sources", GPU_R32U, nodes, u->sources, &u->to->sources);
}

// A texel has the weights of one source in a tuple of modes.
static void fill_projection(const struct upload *u, size_t r, uint16_t *out)
{
    const struct region *region = &u->regions[r];
    const size_t tuples = tuples_of(region), sources = u->from.sources, modes = u->from.modes;
    for (size_t i = 0; i < (size_t)loads_of(region) * RADIOSITY_PROJECT_LOCAL; i++)
        for (size_t t = 0; i < sources && t < tuples; t++) {
            const size_t load = i / RADIOSITY_PROJECT_LOCAL * tuples + t;
            const size_t at =
                region->projection + load * RADIOSITY_PROJECT_LOCAL + i % RADIOSITY_PROJECT_LOCAL;
            memcpy(out + RADIOSITY_MODES * at,
                   u->from.project + (r * sources + i) * modes + RADIOSITY_MODES * t,
                   RADIOSITY_MODES * sizeof *out);
        }
}

static bool upload_projections(const struct upload *u)
{
    uint16_t *words = room_for(u, u->projections, RADIOSITY_MODES * sizeof *words);
    for (size_t r = 0; words && r < u->to->regions; r++) fill_projection(u, r, words);
    return upload(u, "projections", GPU_RGBA32U, words, u->projections, &u->to->projections);
}

static size_t expansion_texels(size_t modes)
{
    return modes / RADIOSITY_MODES * COMPONENTS * RADIOSITY_REGION;
}

// A texel has a component of a row in a tuple of modes; rows of a tile are side by side.
static void fill_expansion(const struct upload *u, size_t r, uint16_t *out)
{
    const struct region *region = &u->regions[r];
    const size_t tuples = tuples_of(region), modes = u->from.modes;
    const size_t first = expansion_texels(region->mode);
    for (size_t row = 0; row < RADIOSITY_REGION; row++)
        for (size_t k = 0; k < RADIOSITY_MODES * tuples * COMPONENTS; k++) {
            const size_t mode = k / COMPONENTS, part = k % COMPONENTS;
            const size_t load = mode / RADIOSITY_MODES * COMPONENTS + part;
            const size_t at = first + row / RADIOSITY_TILE * RADIOSITY_TILE * COMPONENTS * tuples +
                              load * RADIOSITY_TILE + row % RADIOSITY_TILE;
            out[RADIOSITY_MODES * at + mode % RADIOSITY_MODES] =
                u->from.expand[(r * RADIOSITY_REGION + row) * modes * COMPONENTS + k];
        }
}

static bool upload_expansions(const struct upload *u)
{
    const size_t texels = expansion_texels(u->modes);
    uint16_t *words = room_for(u, texels, RADIOSITY_MODES * sizeof *words);
    for (size_t r = 0; words && r < u->to->regions; r++) fill_expansion(u, r, words);
    return upload(u, "expansions", GPU_RGBA32U, words, texels, &u->to->expansions);
}

static bool upload_scales(const struct upload *u)
{
    float *scales = room_for(u, u->modes, sizeof *scales);
    for (size_t r = 0; scales && r < u->to->regions; r++)
        memcpy(scales + u->regions[r].mode, u->from.scale + r * u->from.modes,
               RADIOSITY_MODES * tuples_of(&u->regions[r]) * sizeof *scales);
    return upload(u, "scales", GPU_R32F, scales, u->modes, &u->to->scales);
}

static bool upload_order(const struct upload *u)
{
    const size_t texels = u->how->map->texel_count;
    uint32_t *rows = radiosity_regions(u->how->map), *order = room_for(u, texels, sizeof *order);
    const bool ok = rows && order;
    if (ok) memcpy(order, rows, texels * sizeof *order);
    host_free(u->how->host, rows);
    return upload(u, "order", GPU_R32U, order, texels, &u->to->order) && ok;
}

static bool make_buffers(const struct upload *u)
{
    struct gpu *gpu = u->how->gpu;
    const size_t bytes = u->to->regions * sizeof *u->regions;
    const struct gpu_buffer_desc table = { "regions", bytes, GPU_BUFFER_STORAGE };
    const struct gpu_buffer_desc modes = { "modes", (u->modes > 0 ? u->modes : 1) * MODE_BYTES,
                                           GPU_BUFFER_STORAGE };
    return gpu_buffer_create(gpu, &table, &u->to->table) &&
           gpu_buffer_upload(gpu, u->to->table, 0, u->regions, bytes) &&
           gpu_buffer_create(gpu, &modes, &u->to->modes);
}

static bool make_pipelines(const struct upload *u)
{
    return gpu_compute_pipeline_create(u->how->gpu, "project",
                                       &shader_radiosity_lowrank_project_comp, NULL, 0,
                                       &u->to->project) &&
           gpu_compute_pipeline_create(u->how->gpu, "expand",
                                       gpu_limits(u->how->gpu)->subgroup_broadcast
                                           ? &shader_radiosity_lowrank_expand_subgroups_comp
                                           : &shader_radiosity_lowrank_expand_invocations_comp,
                                       NULL, 0, &u->to->expand);
}

static bool upload_all(struct upload *u)
{
    u->regions = host_alloc(u->how->host, u->to->regions, sizeof *u->regions);
    if (!u->regions) return false;
    find_sizes(u);
    return make_buffers(u) && upload_order(u) && upload_sources(u) && upload_projections(u) &&
           upload_expansions(u) && upload_scales(u) && make_pipelines(u);
}

bool radiosity_lowrank_init(struct radiosity_lowrank *out,
                            const struct radiosity_lowrank_create *how, const struct tensors *bake)
{
    *out = (struct radiosity_lowrank){ .regions = radiosity_region_count(how->map->texel_count) };
    struct upload u = { .to = out,
                        .how = how,
                        .from = { .sources = radiosity_lowrank_sources(how->options),
                                  .modes = radiosity_lowrank_modes(how->options) } };
    if (!find_tensors(&u, bake)) return false;
    if (out->regions == 0) return true;
    const bool ok = check_sources(&u) && check_scales(&u) && check_expansions(&u) && upload_all(&u);
    host_free(how->host, u.regions);
    return ok;
}

void radiosity_lowrank_finish(struct radiosity_lowrank *l, struct gpu *gpu)
{
    gpu_image *const images[] = { &l->order, &l->sources, &l->projections, &l->expansions,
                                  &l->scales };
    for (size_t i = 0; i < sizeof images / sizeof *images; i++) gpu_image_destroy(gpu, images[i]);
    gpu_buffer_destroy(gpu, &l->table);
    gpu_buffer_destroy(gpu, &l->modes);
    gpu_pipeline_destroy(gpu, &l->project);
    gpu_pipeline_destroy(gpu, &l->expand);
}

uint64_t radiosity_lowrank_memory(const struct radiosity_options *options, uint64_t texels)
{
    const uint64_t regions = radiosity_rows(radiosity_region_count((uint32_t)texels));
    const uint64_t sources = regions * radiosity_lowrank_sources(options);
    const uint64_t modes = regions * radiosity_lowrank_modes(options);
    const uint64_t projections = sources * radiosity_lowrank_modes(options) / RADIOSITY_MODES;
    return 4 * radiosity_table_room((size_t)texels) + regions * sizeof(struct region) +
           4 * radiosity_table_room((size_t)sources) +
           16 * radiosity_table_room((size_t)projections) +
           16 * radiosity_table_room(expansion_texels((size_t)modes)) +
           4 * radiosity_table_room((size_t)modes) + MODE_BYTES * modes;
}
