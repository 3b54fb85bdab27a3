#include "techniques/radiosity/radiosity_groups.h"

#include "core/half.h"
#include "core/rng.h"

#include <math.h>
#include <stdlib.h>

// ---- groups

static void mark_nodes(const struct radiosity_map *map, const struct radiosity_cluster_rows *rows,
                       bool *met)
{
    for (size_t i = 0; i < map->cluster_count * rows->entries; i++)
        if (rows->factor[i] != 0) met[rows->source[i]] = true;
}

// Nodes are numbered from the root downwards, and clusters last: the first that is met and has a
// cluster is its largest.
static void find_groups(struct radiosity_groups *out, const struct radiosity_map *map,
                        const bool *met)
{
    const struct radiosity_tree *tree = &map->tree;
    for (uint32_t c = 0; c < tree->leaves; c++) out->of[c] = CHART_NONE;
    for (uint32_t i = 0; i < tree->count; i++) {
        const uint32_t n =
            i < tree->count - tree->leaves ? tree->leaves + i : i - (tree->count - tree->leaves);
        const struct radiosity_node *node = &tree->nodes[n];
        const bool small = node->count <= RADIOSITY_GROUP;
        if (!small || (!met[n] && node->count > 1) || out->of[node->first] != CHART_NONE) continue;
        for (uint32_t c = 0; c < node->count; c++) out->of[node->first + c] = out->count;
        out->groups[out->count++] =
            (struct radiosity_gpu_group){ .first = node->first, .count = node->count };
    }
}

static void find_reflectances(struct radiosity_groups *out,
                              const struct radiosity_gpu_cluster *clusters)
{
    for (uint32_t g = 0; g < out->count; g++) {
        struct radiosity_gpu_group *group = &out->groups[g];
        vec3s sum = { 0 };
        for (uint32_t c = group->first; c < group->first + group->count; c++) {
            sum = glms_vec3_muladds(clusters[c].reflectance, clusters[c].area_m2, sum);
            group->area_m2 += clusters[c].area_m2;
        }
        if (group->area_m2 > 0.0f) group->reflectance = glms_vec3_divs(sum, group->area_m2);
    }
}

// ---- rows

struct entry {
    uint32_t group, first; // first: cluster, near ones of which are near in space
    float factor;
};

struct making {
    struct radiosity_groups *out;
    const struct radiosity_map *map;
    const struct radiosity_gpu_cluster *clusters;
    const struct radiosity_cluster_rows *rows;
    float *sum;        // [groups]; all 0 between the rows
    struct entry *row; // [groups]
};

static int by_factor(const void *a, const void *b)
{
    const struct entry *p = a, *q = b;
    if (p->factor != q->factor) return p->factor > q->factor ? -1 : 1;
    return p->first < q->first ? -1 : p->first > q->first;
}

static int by_place(const void *a, const void *b)
{
    const struct entry *p = a, *q = b;
    return p->first < q->first ? -1 : p->first > q->first;
}

static uint32_t add_cluster(const struct making *m, uint32_t cluster, float share, uint32_t count)
{
    for (size_t k = 0; k < m->rows->entries; k++) {
        const size_t at = cluster * m->rows->entries + k;
        const float factor = share * float_from_half(m->rows->factor[at]);
        if (!(factor > 0.0f)) break;
        const uint32_t group = m->out->of[m->map->tree.nodes[m->rows->source[at]].first];
        if (m->sum[group] == 0.0f)
            m->row[count++] = (struct entry){ group, m->out->groups[group].first, 0.0f };
        m->sum[group] += factor;
    }
    return count;
}

// Keeps `most` entries: the largest, and of the others some, chosen by factor with one random
// number, which all have the same. The sum is exact and the expected light as well.
static uint32_t shorten(struct entry *row, uint32_t count, uint32_t most, struct rng *rng)
{
    if (count <= most) return count;
    float rest = 0.0f;
    for (uint32_t i = 0; i < count; i++) rest += row[i].factor;
    qsort(row, count, sizeof *row, by_factor);
    uint32_t large = 0;
    for (; large + 1 < most && row[large].factor * (float)(most - large) >= rest; large++)
        rest -= row[large].factor;
    const float each = rest / (float)(most - large), offset = rng_float(rng);
    uint32_t kept = large;
    float sum = 0.0f;
    qsort(row + large, count - large, sizeof *row, by_place);
    for (uint32_t i = large; i < count && kept < most; i++) {
        sum += row[i].factor / each;
        if (sum > (float)(kept - large) + offset) row[kept++] = row[i];
    }
    for (uint32_t i = large; i < kept; i++) row[i].factor = rest / (float)(kept - large);
    return kept;
}

// The mean of its clusters' rows by area.
static void make_row(const struct making *m, uint32_t g)
{
    struct radiosity_groups *out = m->out;
    const struct radiosity_gpu_group *group = &out->groups[g];
    struct rng rng = rng_for(g, 0, 0);
    uint32_t count = 0;
    for (uint32_t c = group->first; group->area_m2 > 0.0f && c < group->first + group->count; c++)
        count = add_cluster(m, c, m->clusters[c].area_m2 / group->area_m2, count);
    for (uint32_t i = 0; i < count; i++) {
        m->row[i].factor = m->sum[m->row[i].group];
        m->sum[m->row[i].group] = 0.0f;
    }
    count = shorten(m->row, count, out->entries, &rng);
    for (uint32_t i = 0; i < count; i++) {
        out->source[(size_t)i * out->count + g] = m->row[i].group;
        out->factor[(size_t)i * out->count + g] = m->row[i].factor;
    }
}

static bool make_rows(struct making *m)
{
    struct host *host = m->map->host;
    const size_t size = (size_t)m->out->entries * m->out->count;
    m->out->source = host_alloc(host, size, sizeof *m->out->source);
    m->out->factor = host_alloc(host, size, sizeof *m->out->factor);
    m->sum = host_alloc(host, m->out->count, sizeof *m->sum);
    m->row = host_alloc(host, m->out->count, sizeof *m->row);
    const bool ok = m->out->source && m->out->factor && m->sum && m->row;
    for (uint32_t g = 0; ok && g < m->out->count; g++) make_row(m, g);
    host_free(host, m->sum);
    host_free(host, m->row);
    return ok;
}

// ---- the spectral radius

// One step of the power method; the largest ratio bounds the spectral radius from above (Collatz
// 1942).
static float power_step(const struct radiosity_groups *groups, const float *from, float *to)
{
    float most = 0.0f;
    for (size_t g = 0; g < groups->count; g++) {
        float sum = 0.0f;
        for (size_t k = 0; k < groups->entries; k++) {
            const size_t at = k * groups->count + g;
            sum += groups->factor[at] * from[groups->source[at]];
        }
        // Groups that reflect nothing would end with the ratio 0/0.
        to[g] = fmaxf(sum * glms_vec3_max(groups->groups[g].reflectance), 1e-30f);
        most = fmaxf(most, to[g] / from[g]);
    }
    return most;
}

enum { POWER_STEPS = 24 };
static const float MOST_RADIUS = 0.999f;

static bool find_spectral_radius(struct radiosity_groups *groups)
{
    float *from = host_alloc(groups->host, groups->count, sizeof *from);
    float *to = host_alloc(groups->host, groups->count, sizeof *to);
    const bool ok = from && to;
    groups->spectral_radius = MOST_RADIUS;
    for (uint32_t i = 0; ok && i < groups->count; i++) from[i] = 1.0f;
    for (int k = 0; ok && k < POWER_STEPS; k++) {
        groups->spectral_radius = fminf(groups->spectral_radius, power_step(groups, from, to));
        float *last = from;
        from = to;
        to = last;
    }
    host_free(groups->host, from);
    host_free(groups->host, to);
    return ok;
}

bool radiosity_groups_init(struct radiosity_groups *out, const struct radiosity_map *map,
                           const struct radiosity_gpu_cluster *clusters,
                           const struct radiosity_cluster_rows *rows, uint32_t most)
{
    *out = (struct radiosity_groups){ .host = map->host, .entries = most };
    bool *met = host_alloc(map->host, map->tree.count, sizeof *met);
    out->groups = host_alloc(map->host, map->cluster_count, sizeof *out->groups);
    out->of = host_alloc(map->host, map->cluster_count, sizeof *out->of);
    bool ok = met && out->groups && out->of;
    if (ok) {
        mark_nodes(map, rows, met);
        find_groups(out, map, met);
        find_reflectances(out, clusters);
        struct making making = { out, map, clusters, rows, NULL, NULL };
        ok = make_rows(&making) && find_spectral_radius(out);
    }
    host_free(map->host, met);
    if (!ok) radiosity_groups_finish(out);
    return ok;
}

void radiosity_groups_finish(struct radiosity_groups *groups)
{
    if (!groups->host) return;
    host_free(groups->host, groups->groups);
    host_free(groups->host, groups->of);
    host_free(groups->host, groups->source);
    host_free(groups->host, groups->factor);
    *groups = (struct radiosity_groups){ 0 };
}
