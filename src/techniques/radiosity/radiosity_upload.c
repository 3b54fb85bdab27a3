// From a bake, which is untrusted, to tables on the GPU.
#include "techniques/radiosity/radiosity_state.h"

#include <string.h>

struct content {
    struct radiosity_block_rows blocks;
    const uint32_t *cluster_source;
    const uint16_t *factor, *cluster_factor;
    const uint8_t *part;
    const float *surface; // [texels] struct texel_factors
    struct light_map_texels texels;
    const float *nearness;
    uint32_t *nearest_valid; // [texels]
    size_t sources, cluster_sources;
};

static bool find_tensors(struct radiosity *s, const struct tensors *bake, struct content *out)
{
    const uint64_t n = light_map_rows(s->map.texel_count);
    const uint64_t c = radiosity_cluster_rows(&s->map);
    const uint64_t k = (uint64_t)s->options.sources;
#define EXPECT(...) TENSORS_EXPECT(s->host, bake, __VA_ARGS__)
    *out = (struct content){ .blocks = { .texels = s->map.texel_count, .sources = k },
                             .sources = k,
                             .cluster_sources = 2 * k };
    return (out->blocks.start = EXPECT(RADIOSITY_BLOCK_START, TENSOR_U8, n)) &&
           (out->blocks.source = EXPECT(RADIOSITY_BLOCK_SOURCE, TENSOR_U32, n, k)) &&
           (out->blocks.share = EXPECT(RADIOSITY_BLOCK_SHARE, TENSOR_F16, n, k)) &&
           (out->factor = EXPECT(RADIOSITY_FACTOR, TENSOR_F16, n, k, 3)) &&
           (out->part = EXPECT(RADIOSITY_PART, TENSOR_U8, n)) &&
           (out->surface = EXPECT(RADIOSITY_SURFACE, TENSOR_F32, n, 10)) &&
           (out->nearness = EXPECT(RADIOSITY_NEARNESS, TENSOR_F32, n, 4)) &&
           light_map_find_texels(&out->texels, s->host, &s->map.charts, bake) &&
           (out->texels.fluence = EXPECT(LIGHT_MAP_SKY_FLUENCE, TENSOR_F32, n)) &&
           (out->cluster_source = EXPECT(RADIOSITY_CLUSTER_SOURCE, TENSOR_U32, c, 2 * k)) &&
           (out->cluster_factor = EXPECT(RADIOSITY_CLUSTER_FACTOR, TENSOR_F16, c, 2 * k));
#undef EXPECT
}

// The clusters that the bake has.
static bool subdivide(struct radiosity *s, const struct content *c)
{
    for (uint32_t i = 0; i < s->map.texel_count; i++)
        if (c->part[i] > 1)
            return host_fail(s->host, FAIL_FORMAT, "bake of radiosity: part %u of a texel",
                             (unsigned)c->part[i]);
    return radiosity_map_subdivide(&s->map, c->part);
}

static bool are_below(const uint32_t *at, size_t count, uint32_t limit)
{
    for (size_t i = 0; i < count; i++)
        if (at[i] >= limit) return false;
    return true;
}

static bool are_in_strata(const struct radiosity_block_rows *rows, uint32_t nodes)
{
    for (size_t i = 0; i < rows->texels * rows->sources; i++)
        if (radiosity_source_node(rows->source[i]) >= nodes ||
            radiosity_source_stratum(rows->source[i]) >= rows->sources)
            return false;
    return true;
}

// Every `stride`-th value is a form factor.
static bool are_below_2(const uint16_t *half, size_t count, size_t stride)
{
    for (size_t i = 0; i < count; i++)
        if (half[i * stride] >> (32 - RADIOSITY_NODE_BITS)) return false;
    return true;
}

static bool check_factors(struct radiosity *s, const struct content *c)
{
    const size_t entries = s->map.texel_count * c->sources;
    if (are_below_2(c->factor, entries, 3) && are_below_2(c->blocks.share, entries, 1) &&
        are_below_2(c->cluster_factor, s->map.cluster_count * c->cluster_sources, 1))
        return true;
    return host_fail(s->host, FAIL_FORMAT, "bake of radiosity: a form factor is not in 0…2");
}

static bool check_sources(struct radiosity *s, const struct content *c)
{
    const uint32_t nodes = s->map.tree.count;
    if (are_in_strata(&c->blocks, nodes) &&
        are_below(c->cluster_source, s->map.cluster_count * c->cluster_sources, nodes))
        return true;
    return host_fail(s->host, FAIL_FORMAT, "bake of radiosity: a source of light is beyond %u",
                     nodes);
}

// ---- clusters

static bool find_reflectance(struct radiosity *s, struct content *c)
{
    const struct radiosity_reflectance_input from = { (const struct texel_factors *)c->surface,
                                                      c->texels.point, c->cluster_source,
                                                      c->cluster_factor, c->cluster_sources };
    if (!radiosity_reflectance_init(&s->reflectance, s->host, &s->map, s->materials.of_instance,
                                    &from))
        return false;
    radiosity_reflectance_update(&s->reflectance, s->materials.known);
    c->texels.reflectance = s->reflectance.texels->raw;
    s->spectral_radius = s->reflectance.spectral_radius;
    return true;
}

struct pair {
    uint32_t x, y;
};

// Nodes of several clusters that are sources.
static bool upload_groups(struct radiosity *s)
{
    const struct radiosity_tree *tree = &s->map.tree;
    const size_t most = tree->count - tree->leaves;
    struct pair *groups = host_alloc(s->host, light_map_table_capacity(most), sizeof *groups);
    for (uint32_t i = tree->leaves; groups && i < tree->count; i++) {
        const struct radiosity_node *node = &tree->nodes[i];
        if (node->count > RADIOSITY_GROUP) continue;
        groups[s->group_count++] =
            (struct pair){ i, node->first | node->count << RADIOSITY_GROUP_SHIFT };
    }
    return light_map_table_upload(s->host, s->gpu, "groups", GPU_RG32U, groups, most,
                                  &s->tables.groups);
}

static bool upload_members(struct radiosity *s)
{
    const struct radiosity_map *map = &s->map;
    const size_t texels = map->texel_count, clusters = map->cluster_count;
    uint32_t *members = host_alloc(s->host, light_map_table_capacity(texels), sizeof *members);
    struct pair *spans = host_alloc(s->host, light_map_table_capacity(clusters), sizeof *spans);
    if (members) memcpy(members, map->members, texels * sizeof *members);
    for (size_t i = 0; spans && i < clusters; i++)
        spans[i] = (struct pair){ map->first[i], map->first[i + 1] - map->first[i] };
    const bool ok = light_map_table_upload(s->host, s->gpu, "members", GPU_R32U, members, texels,
                                           &s->tables.members);
    return light_map_table_upload(s->host, s->gpu, "spans", GPU_RG32U, spans, clusters,
                                  &s->tables.spans) &&
           ok;
}

static bool upload_clusters(struct radiosity *s)
{
    const uint32_t count = s->map.cluster_count;
    vec4s *clusters = host_alloc(s->host, light_map_table_capacity(count), sizeof *clusters);
    if (clusters) memcpy(clusters, s->reflectance.clusters, count * sizeof *clusters);
    return light_map_table_upload(s->host, s->gpu, "clusters", GPU_RGBA32F, clusters, count,
                                  &s->tables.clusters) &&
           upload_members(s) && upload_groups(s);
}

// The light map shows the smoothed sky where it shows smoothed light.
static bool upload_light_map(struct radiosity *s, const struct content *c,
                             const struct tensors *bake)
{
    const struct radiosity_surroundings around = { &c->texels, c->nearness, c->nearest_valid };
    float *smoothed = host_alloc(s->host, s->map.texel_count, 4 * sizeof *smoothed);
    const bool ok =
        smoothed && radiosity_upload_neighbours(s, &around, smoothed) &&
        light_map_upload(&s->light_map, (uint32_t)s->followed.places.count, c->nearest_valid,
                         s->options.smooth ? smoothed : c->texels.sky, bake);
    host_free(s->host, smoothed);
    return ok;
}

// Strata without a source give no light: a damaged row must not read those of the next block.
static bool check_strata(struct radiosity *s, const struct content *c,
                         const struct radiosity_strata *strata)
{
    for (uint32_t i = 0; i < s->map.texel_count; i++) {
        const uint32_t left = strata->count - strata->of[i];
        for (size_t k = left; k < c->sources; k++)
            if (c->factor[3 * (i * c->sources + k)] != 0)
                return host_fail(s->host, FAIL_FORMAT,
                                 "bake of radiosity: a form factor without a source of light");
    }
    return true;
}

static bool upload_factors(struct radiosity *s, const struct content *c)
{
    struct radiosity_strata strata;
    const bool ok =
        radiosity_strata_init(&strata, s->host, &c->blocks) && check_strata(s, c, &strata) &&
        radiosity_upload_factors(s, &(struct radiosity_sources){
                                        c->factor, &strata, c->cluster_source, c->cluster_factor });
    radiosity_strata_finish(&strata);
    return ok;
}

static bool upload_all(struct radiosity *s, const struct content *c, const struct tensors *bake)
{
    return light_map_upload_texels(&c->texels, s->host, s->gpu, &s->tables.texels) &&
           light_map_emission_upload(&s->emission, s->host, s->gpu, &s->materials.emission,
                                     s->map.texel_count, bake, true) &&
           light_map_upload_sky(&c->texels, s->host, s->gpu, bake, &s->tables.sky) &&
           upload_factors(s, c) && upload_light_map(s, c, bake) && upload_clusters(s) &&
           radiosity_view_init(s, c->texels.point, c->nearest_valid);
}

bool radiosity_upload(struct radiosity *s, const struct tensors *bake)
{
    struct content c;
    if (!find_tensors(s, bake, &c)) return false;
    if (s->map.texel_count == 0) return true;
    if (!subdivide(s, &c) || !check_sources(s, &c) || !check_factors(s, &c)) return false;
    c.nearest_valid = light_map_nearest_valid(&c.texels, s->host);
    const bool ok = c.nearest_valid && find_reflectance(s, &c) && upload_all(s, &c, bake);
    host_free(s->host, c.nearest_valid);
    return ok;
}
