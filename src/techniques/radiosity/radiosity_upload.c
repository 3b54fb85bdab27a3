// From a bake, which is untrusted, to tables on the GPU.
#include "techniques/radiosity/radiosity_state.h"

#include "core/half.h"

#include <math.h>
#include <string.h>

struct content {
    const uint32_t *source, *cluster_source;
    const uint16_t *factor, *cluster_factor;
    const uint8_t *part;
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
    *out = (struct content){ .sources = k, .cluster_sources = 2 * k };
    return (out->source = EXPECT(RADIOSITY_SOURCE, TENSOR_U32, n, k)) &&
           (out->factor = EXPECT(RADIOSITY_FACTOR, TENSOR_F16, n, k, 3)) &&
           (out->part = EXPECT(RADIOSITY_PART, TENSOR_U8, n)) &&
           (out->nearness = EXPECT(RADIOSITY_NEARNESS, TENSOR_F32, n, 4)) &&
           light_map_find_texels(&out->texels, s->host, &s->map.charts, bake) &&
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

// Every `stride`-th value is a form factor.
static bool are_below_2(const uint16_t *half, size_t count, size_t stride)
{
    for (size_t i = 0; i < count; i++)
        if (half[i * stride] >> (32 - RADIOSITY_NODE_BITS)) return false;
    return true;
}

static bool check_factors(struct radiosity *s, const struct content *c)
{
    if (are_below_2(c->factor, s->map.texel_count * c->sources, 3) &&
        are_below_2(c->cluster_factor, s->map.cluster_count * c->cluster_sources, 1))
        return true;
    return host_fail(s->host, FAIL_FORMAT, "bake of radiosity: a form factor is not in 0…2");
}

static bool check_sources(struct radiosity *s, const struct content *c)
{
    const uint32_t nodes = s->map.tree.count;
    if (are_below(c->source, s->map.texel_count * c->sources, nodes) &&
        are_below(c->cluster_source, s->map.cluster_count * c->cluster_sources, nodes))
        return true;
    return host_fail(s->host, FAIL_FORMAT, "bake of radiosity: a source of light is beyond %u",
                     nodes);
}

// ---- clusters

// Mean reflectance, and area of texels that are not hidden.
static vec4s cluster_of(const struct radiosity *s, const struct content *c, uint32_t cluster)
{
    const struct radiosity_map *map = &s->map;
    vec3s reflected = vec3_of(0, 0, 0);
    float sum = 0.0f;
    for (uint32_t m = map->first[cluster]; m < map->first[cluster + 1]; m++) {
        const uint32_t texel = map->members[m];
        const float area = light_map_texel_area(&c->texels, texel);
        const float *reflectance = c->texels.reflectance + 4 * (size_t)texel;
        sum += area;
        const float diffuse = 0.5f + 0.5f * reflectance[3]; // radiosity_direct.comp
        for (int k = 0; k < 3; k++) reflected.raw[k] += area * diffuse * reflectance[k];
    }
    return vec4_of(sum > 0.0f ? glms_vec3_divs(reflected, sum) : reflected, sum);
}

struct power {
    const struct content *content;
    const struct radiosity_tree *tree;
    const vec4s *clusters;
    float *from, *to; // [nodes]
};

static void fill_nodes(const struct power *p, float *x)
{
    for (uint32_t n = p->tree->leaves; n < p->tree->count; n++) {
        const struct radiosity_node *node = &p->tree->nodes[n];
        float sum = 0.0f, area = 0.0f;
        if (node->count > RADIOSITY_GROUP) continue;
        for (uint32_t c = node->first; c < node->first + node->count; c++) {
            sum += p->clusters[c].w * x[c];
            area += p->clusters[c].w;
        }
        x[n] = area > 0.0f ? sum / area : 0.0f;
    }
}

// One step of the power method; the largest ratio bounds the spectral radius from above (Collatz
// 1942).
static float power_step(const struct power *p)
{
    const struct content *c = p->content;
    float most = 0.0f;
    fill_nodes(p, p->from);
    for (size_t i = 0; i < p->tree->leaves; i++) {
        float sum = 0.0f;
        for (size_t k = 0; k < c->cluster_sources; k++) {
            const size_t at = i * c->cluster_sources + k;
            if (c->cluster_factor[at] == 0) break;
            sum += float_from_half(c->cluster_factor[at]) * p->from[c->cluster_source[at]];
        }
        // Clusters that reflect nothing would end with the ratio 0/0.
        p->to[i] = fmaxf(sum * glms_vec3_max(glms_vec3(p->clusters[i])), 1e-30f);
        most = fmaxf(most, p->to[i] / p->from[i]);
    }
    return most;
}

enum { POWER_STEPS = 24 };
static const float MOST_RADIUS = 0.999f;

static bool find_spectral_radius(struct radiosity *s, const struct content *c,
                                 const vec4s *clusters)
{
    struct power p = { c, &s->map.tree, clusters,
                       host_alloc(s->host, s->map.tree.count, sizeof(float)),
                       host_alloc(s->host, s->map.tree.count, sizeof(float)) };
    const bool ok = p.from && p.to;
    s->spectral_radius = MOST_RADIUS;
    for (uint32_t i = 0; ok && i < s->map.cluster_count; i++) p.from[i] = 1.0f;
    for (int k = 0; ok && k < POWER_STEPS; k++) {
        s->spectral_radius = fminf(s->spectral_radius, power_step(&p));
        float *last = p.from;
        p.from = p.to;
        p.to = last;
    }
    host_free(s->host, p.from);
    host_free(s->host, p.to);
    return ok;
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

static bool upload_clusters(struct radiosity *s, const struct content *c)
{
    const uint32_t count = s->map.cluster_count;
    vec4s *clusters = host_alloc(s->host, light_map_table_capacity(count), sizeof *clusters);
    for (uint32_t i = 0; clusters && i < count; i++) clusters[i] = cluster_of(s, c, i);
    const bool ok = clusters && find_spectral_radius(s, c, clusters);
    return light_map_table_upload(s->host, s->gpu, "clusters", GPU_RGBA32F, clusters, count,
                                  &s->tables.clusters) &&
           ok && upload_members(s) && upload_groups(s);
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

static bool upload_all(struct radiosity *s, const struct content *c, const struct tensors *bake)
{
    return light_map_upload_texels(&c->texels, s->host, s->gpu, &s->tables.texels) &&
           light_map_upload_sky(&c->texels, s->host, s->gpu, bake, &s->tables.sky) &&
           radiosity_upload_factors(s, c->source, c->factor, c->cluster_source,
                                    c->cluster_factor) &&
           upload_light_map(s, c, bake) && upload_clusters(s, c) &&
           radiosity_view_init(s, c->texels.point, c->nearest_valid);
}

bool radiosity_upload(struct radiosity *s, const struct tensors *bake)
{
    struct content c;
    if (!find_tensors(s, bake, &c)) return false;
    if (s->map.texel_count == 0) return true;
    if (!subdivide(s, &c) || !check_sources(s, &c) || !check_factors(s, &c)) return false;
    c.nearest_valid = light_map_nearest_valid(&c.texels, s->host);
    const bool ok = c.nearest_valid && upload_all(s, &c, bake);
    host_free(s->host, c.nearest_valid);
    return ok;
}
