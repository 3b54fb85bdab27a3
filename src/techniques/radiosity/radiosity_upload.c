// From a bake, which is untrusted, to tables on the GPU.
#include "techniques/radiosity/radiosity_state.h"

#include "core/half.h"

#include <math.h>
#include <string.h>

struct content {
    const uint32_t *source, *cluster_source;
    const uint16_t *factor, *cluster_factor;
    const uint8_t *part;
    const float *reflectance, *sky, *emitted, *point, *inverse_distance;
    const uint32_t *seam_texel;
    const float *seam_weight;
    struct radiosity_seams seams;
    uint32_t *shown; // [texels] whose light each one shows
    size_t sources, cluster_sources;
    bool *hidden;
};

static bool find_tensors(struct radiosity *s, const struct tensors *bake, struct content *out)
{
    const uint64_t n = radiosity_rows(s->map.texel_count);
    const uint64_t c = radiosity_cluster_rows(&s->map);
    const uint64_t k = (uint64_t)s->options.sources;
    struct host *host = s->host;
#define EXPECT(name, type, ...)                                                                    \
    tensors_expect(host, bake, name, type,                                                         \
                   (int)(sizeof((const uint64_t[]){ __VA_ARGS__ }) / sizeof(uint64_t)),            \
                   (const uint64_t[]){ __VA_ARGS__ })
    *out = (struct content){ .sources = k, .cluster_sources = 2 * k };
    return (out->source = EXPECT(RADIOSITY_SOURCE, TENSOR_U32, n, k)) &&
           (out->factor = EXPECT(RADIOSITY_FACTOR, TENSOR_F16, n, k, 3)) &&
           (out->reflectance = EXPECT(RADIOSITY_ALBEDO, TENSOR_F32, n, 3)) &&
           (out->sky = EXPECT(RADIOSITY_SKY, TENSOR_F32, n, 4)) &&
           (out->emitted = EXPECT(RADIOSITY_EMITTED, TENSOR_F32, n, 3, 4)) &&
           (out->part = EXPECT(RADIOSITY_PART, TENSOR_U8, n)) &&
           (out->inverse_distance = EXPECT(RADIOSITY_DISTANCE, TENSOR_F32, n)) &&
           (out->point = EXPECT(RADIOSITY_POINT, TENSOR_F32, n, 4)) &&
           (out->cluster_source = EXPECT(RADIOSITY_CLUSTER_SOURCE, TENSOR_U32, c, 2 * k)) &&
           (out->cluster_factor = EXPECT(RADIOSITY_CLUSTER_FACTOR, TENSOR_F16, c, 2 * k));
#undef EXPECT
}

// Rows of the places beside seams, which the charts have.
static bool find_seams(struct radiosity *s, const struct tensors *bake, struct content *c)
{
    if (!radiosity_seams_init(&c->seams, &s->map, RADIOSITY_SEAM_POINTS)) return false;
    const uint64_t shape[2] = { radiosity_rows(c->seams.count), RADIOSITY_SEAM_ENTRIES };
    c->seam_texel = tensors_expect(s->host, bake, RADIOSITY_SEAM_TEXEL, TENSOR_U32, 2, shape);
    c->seam_weight = tensors_expect(s->host, bake, RADIOSITY_SEAM_WEIGHT, TENSOR_F32, 2, shape);
    bool ok = c->seam_texel && c->seam_weight;
    for (size_t i = 0; ok && i < (size_t)c->seams.count * RADIOSITY_SEAM_ENTRIES; i++)
        if (c->seam_texel[i] >= s->map.texel_count || !isfinite(c->seam_weight[i]))
            ok = host_fail(s->host, FAIL_FORMAT, "bake of radiosity: texel %u of a seam",
                           c->seam_texel[i]);
    if (!ok) radiosity_seams_finish(&c->seams);
    return ok;
}

// The clusters that the bake has.
static bool divide(struct radiosity *s, const struct content *c)
{
    for (uint32_t i = 0; i < s->map.texel_count; i++)
        if (c->part[i] > 1)
            return host_fail(s->host, FAIL_FORMAT, "bake of radiosity: part %u of a texel",
                             (unsigned)c->part[i]);
    return radiosity_map_divide(&s->map, c->part);
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

static bool fits(struct radiosity *s, const char *name, size_t bytes)
{
    const uint64_t most = gpu_limits(s->gpu)->max_storage_bytes;
    if (bytes <= most) return true;
    return host_fail(s->host, FAIL_UNSUPPORTED,
                     "radiosity: its %s have %.0f MB, above the limit of %s, %.0f MB: give fewer "
                     "texels or sources",
                     name, (double)bytes * 1e-6, gpu_info(s->gpu)->name, (double)most * 1e-6);
}

static bool upload(struct radiosity *s, const char *name, void *items, size_t count, size_t size,
                   gpu_buffer *out)
{
    const size_t bytes = count * size;
    const struct gpu_buffer_desc desc = { name, bytes > 0 ? bytes : 16, GPU_BUFFER_STORAGE };
    const bool ok = items && fits(s, name, bytes) && gpu_buffer_create(s->gpu, &desc, out) &&
                    (bytes == 0 || gpu_buffer_upload(s->gpu, *out, 0, items, bytes));
    host_free(s->host, items);
    return ok;
}

// ---- texels

static float area_of(const struct radiosity *s, const struct content *c, uint32_t texel)
{
    return c->point[4 * (size_t)texel + 3] * radiosity_chart_texel(&s->map, texel)->area_m2;
}

static bool upload_texels(struct radiosity *s, const struct content *c)
{
    const uint32_t count = s->map.texel_count;
    struct radiosity_gpu_texel *texels = host_alloc(s->host, count, sizeof *texels);
    for (uint32_t i = 0; texels && i < count; i++) {
        texels[i] = (struct radiosity_gpu_texel){ .area_m2 = area_of(s, c, i),
                                                  .normal = s->map.texels[i].normal };
        memcpy(&texels[i].position, c->point + 4 * (size_t)i, 3 * sizeof(float));
        memcpy(&texels[i].reflectance, c->reflectance + 3 * (size_t)i, 3 * sizeof(float));
        memcpy(&texels[i].sky, c->sky + 4 * (size_t)i, 4 * sizeof(float));
        memcpy(texels[i].emitted, c->emitted + 12 * (size_t)i, 12 * sizeof(float));
    }
    return upload(s, "texels", texels, count, sizeof *texels, &s->buffers.texels);
}

static bool upload_points(struct radiosity *s, const struct content *c)
{
    const uint32_t count = s->map.texel_count, width = s->map.charts.width;
    struct radiosity_gpu_point *points = host_alloc(s->host, count, sizeof *points);
    for (uint32_t i = 0; points && i < count; i++) {
        const struct chart_texel *t = radiosity_chart_texel(&s->map, i);
        const uint32_t row = (s->map.texels[i].back ? s->map.charts.height : 0) + t->y;
        points[i].inverse_distance = c->inverse_distance[i];
        points[i].place = row * width + t->x;
        memcpy(&points[i].position, c->point + 4 * (size_t)i, 3 * sizeof(float));
    }
    return upload(s, "points", points, count, sizeof *points, &s->buffers.points);
}

// ---- clusters

static struct radiosity_gpu_cluster cluster_of(const struct radiosity *s, const struct content *c,
                                               uint32_t cluster)
{
    const struct radiosity_map *map = &s->map;
    struct radiosity_gpu_cluster out = { .first = map->first[cluster],
                                         .count = map->first[cluster + 1] - map->first[cluster] };
    float sum = 0.0f;
    for (uint32_t m = out.first; m < out.first + out.count; m++) {
        const uint32_t texel = map->members[m];
        const float area = area_of(s, c, texel);
        const float *reflectance = c->reflectance + 3 * (size_t)texel;
        sum += area;
        for (int k = 0; k < 3; k++) out.reflectance.raw[k] += area * reflectance[k];
    }
    out.area_m2 = sum;
    if (sum > 0.0f) out.reflectance = glms_vec3_divs(out.reflectance, sum);
    return out;
}

struct power {
    const struct content *content;
    const struct radiosity_tree *tree;
    const struct radiosity_gpu_cluster *clusters;
    float *from, *to; // [nodes]
};

static void fill_nodes(const struct power *p, float *x)
{
    for (uint32_t n = p->tree->leaves; n < p->tree->count; n++) {
        const struct radiosity_node *node = &p->tree->nodes[n];
        float sum = 0.0f, area = 0.0f;
        if (node->count > RADIOSITY_GROUP) continue;
        for (uint32_t c = node->first; c < node->first + node->count; c++) {
            sum += p->clusters[c].area_m2 * x[c];
            area += p->clusters[c].area_m2;
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
        p->to[i] = fmaxf(sum * glms_vec3_max(p->clusters[i].reflectance), 1e-30f);
        most = fmaxf(most, p->to[i] / p->from[i]);
    }
    return most;
}

enum { POWER_STEPS = 24 };
static const float MOST_RADIUS = 0.999f;

static bool find_spectral_radius(struct radiosity *s, const struct content *c,
                                 const struct radiosity_gpu_cluster *clusters)
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

// Nodes of several clusters: groups; the others are empty.
static bool upload_nodes(struct radiosity *s)
{
    const struct radiosity_tree *tree = &s->map.tree;
    const uint32_t count = tree->count - tree->leaves;
    struct radiosity_gpu_node *nodes = host_alloc(s->host, count, sizeof *nodes);
    for (uint32_t i = 0; nodes && i < count; i++) {
        const struct radiosity_node *node = &tree->nodes[tree->leaves + i];
        nodes[i] = (struct radiosity_gpu_node){ node->first,
                                                node->count <= RADIOSITY_GROUP ? node->count : 0 };
    }
    return upload(s, "nodes", nodes, count, sizeof *nodes, &s->buffers.nodes);
}

static bool upload_clusters(struct radiosity *s, const struct content *c)
{
    const uint32_t count = s->map.cluster_count;
    struct radiosity_gpu_cluster *clusters = host_alloc(s->host, count, sizeof *clusters);
    uint32_t *members = host_alloc(s->host, s->map.texel_count, sizeof *members);
    bool ok = clusters && members;
    for (uint32_t i = 0; ok && i < count; i++) clusters[i] = cluster_of(s, c, i);
    if (ok) memcpy(members, s->map.members, s->map.texel_count * sizeof *members);
    ok = ok && find_spectral_radius(s, c, clusters);
    ok &= upload(s, "clusters", clusters, count, sizeof *clusters, &s->buffers.clusters);
    ok &= upload(s, "members", members, s->map.texel_count, sizeof *members, &s->buffers.members);
    return ok && upload_nodes(s);
}

// ---- the light map

static bool upload_owners(struct radiosity *s, const struct content *c)
{
    const struct charts *charts = &s->map.charts;
    const size_t side = (size_t)charts->width * charts->height;
    uint32_t *owners = host_alloc(s->host, s->sides * side, sizeof *owners);
    for (size_t i = 0; owners && i < s->sides * side; i++) {
        const uint32_t texel = radiosity_texel_of_place(&s->map, i);
        owners[i] = texel == CHART_NONE ? CHART_NONE : c->shown[texel];
    }
    return upload(s, "owners", owners, s->sides * side, sizeof *owners, &s->buffers.owners);
}

// Entries of all places side by side.
static bool upload_seams(struct radiosity *s, const struct content *c)
{
    const size_t count = c->seams.count, entries = RADIOSITY_SEAM_ENTRIES;
    struct radiosity_gpu_seam *rows = host_alloc(s->host, count * entries, sizeof *rows);
    uint32_t *places = host_alloc(s->host, count, sizeof *places);
    for (size_t i = 0; rows && i < count * entries; i++)
        rows[i % entries * count + i / entries] =
            (struct radiosity_gpu_seam){ c->shown[c->seam_texel[i]], c->seam_weight[i] };
    if (places) memcpy(places, c->seams.places, count * sizeof *places);
    s->seam_places = (uint32_t)count;
    const bool ok = upload(s, "seams", rows, count * entries, sizeof *rows, &s->buffers.seams);
    return upload(s, "places", places, count, sizeof *places, &s->buffers.places) && ok;
}

// The affine map from the triangle's plane to one coordinate of the atlas.
static vec4s gradient_of(const struct chart_triangle *t, int axis)
{
    const vec3s a = glms_vec3_sub(t->corner[1], t->corner[0]);
    const vec3s b = glms_vec3_sub(t->corner[2], t->corner[0]);
    const vec3s normal = glms_vec3_cross(a, b);
    const float per_area2 = 1.0f / glms_vec3_norm2(normal);
    const float to_a = t->place[1].raw[axis] - t->place[0].raw[axis];
    const float to_b = t->place[2].raw[axis] - t->place[0].raw[axis];
    vec3s gradient = glms_vec3_scale(glms_vec3_cross(b, normal), to_a);
    gradient = glms_vec3_muladds(glms_vec3_cross(normal, a), to_b, gradient);
    gradient = glms_vec3_scale(gradient, per_area2);
    return vec4_of(gradient, t->place[0].raw[axis] - glms_vec3_dot(gradient, t->corner[0]));
}

static struct radiosity_gpu_triangle triangle_of(const struct radiosity *s, uint32_t chart_triangle)
{
    if (chart_triangle == CHART_NONE) return (struct radiosity_gpu_triangle){ .sides = 0 };
    const struct chart_triangle *t = &s->map.charts.triangles[chart_triangle];
    return (struct radiosity_gpu_triangle){
        .u = gradient_of(t, 0),
        .v = gradient_of(t, 1),
        .normal = t->normal,
        .sides = s->map.back_of[t->chart] == CHART_NONE ? 1 : 2,
    };
}

static bool upload_triangles(struct radiosity *s)
{
    const size_t count = s->map.triangle_0[s->instances];
    struct radiosity_gpu_triangle *triangles = host_alloc(s->host, count, sizeof *triangles);
    uint32_t *first = host_alloc(s->host, (size_t)s->instances + 1, sizeof *first);
    for (size_t i = 0; triangles && i < count; i++)
        triangles[i] = triangle_of(s, s->map.chart_triangle[i]);
    for (uint32_t i = 0; first && i <= s->instances; i++) first[i] = (uint32_t)s->map.triangle_0[i];
    const bool ok =
        upload(s, "triangles", triangles, count, sizeof *triangles, &s->buffers.triangles);
    return upload(s, "instances", first, (size_t)s->instances + 1, sizeof *first,
                  &s->buffers.instances) &&
           ok;
}

static bool upload_all(struct radiosity *s, const struct content *c)
{
    return upload_texels(s, c) &&
           radiosity_upload_factors(s, c->source, c->factor, c->cluster_source,
                                    c->cluster_factor) &&
           upload_points(s, c) && upload_clusters(s, c) && upload_owners(s, c) &&
           upload_seams(s, c) && upload_triangles(s) && radiosity_view_init(s, c->point);
}

bool radiosity_upload(struct radiosity *s, const struct tensors *bake)
{
    struct content c;
    if (!find_tensors(s, bake, &c)) return false;
    if (s->map.texel_count == 0) return true;
    if (!divide(s, &c) || !check_sources(s, &c) || !check_factors(s, &c)) return false;
    if (!find_seams(s, bake, &c)) return false;
    c.hidden = host_alloc(s->host, s->map.texel_count, sizeof *c.hidden);
    for (uint32_t i = 0; c.hidden && i < s->map.texel_count; i++)
        c.hidden[i] = !(c.point[4 * (size_t)i + 3] > 0.0f);
    if (c.hidden) c.shown = radiosity_fill(&s->map, c.hidden);
    const bool ok = c.shown && upload_all(s, &c);
    host_free(s->host, c.hidden);
    host_free(s->host, c.shown);
    radiosity_seams_finish(&c.seams);
    return ok;
}
