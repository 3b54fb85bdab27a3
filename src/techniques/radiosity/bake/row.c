#include "techniques/radiosity/bake/row.h"

#include "core/rng.h"

bool radiosity_rows_init(struct radiosity_rows *rows, struct host *host,
                         const struct radiosity_scene *scene)
{
    const struct radiosity_tree *tree = &scene->map.tree;
    *rows = (struct radiosity_rows){ .host = host, .tree = tree, .is_group = scene->is_group };
    rows->sum = host_alloc(host, tree->count, sizeof *rows->sum);
    rows->touched = host_alloc(host, tree->count, sizeof *rows->touched);
    rows->heap = host_alloc(host, tree->count, sizeof *rows->heap);
    rows->cut = host_alloc(host, tree->count, sizeof *rows->cut);
    rows->stratum = host_alloc(host, tree->count, sizeof *rows->stratum);
    rows->stratum_node = host_alloc(host, tree->count, sizeof *rows->stratum_node);
    return rows->sum && rows->touched && rows->heap && rows->cut && rows->stratum &&
           rows->stratum_node;
}

void radiosity_rows_finish(struct radiosity_rows *rows)
{
    if (!rows->host) return;
    host_free(rows->host, rows->sum);
    host_free(rows->host, rows->touched);
    host_free(rows->host, rows->heap);
    host_free(rows->host, rows->cut);
    host_free(rows->host, rows->stratum);
    host_free(rows->host, rows->stratum_node);
    *rows = (struct radiosity_rows){ 0 };
}

// ---- a heap, the heaviest entry first; of equal ones the lesser node

static bool precedes(const struct radiosity_entry *a, const struct radiosity_entry *b)
{
    if (a->factor.weight != b->factor.weight) return a->factor.weight > b->factor.weight;
    return a->node < b->node;
}

static void push(struct radiosity_entry *heap, uint32_t *count, struct radiosity_entry entry)
{
    uint32_t at = (*count)++;
    for (; at > 0 && precedes(&entry, &heap[(at - 1) / 2]); at = (at - 1) / 2)
        heap[at] = heap[(at - 1) / 2];
    heap[at] = entry;
}

static struct radiosity_entry pop(struct radiosity_entry *heap, uint32_t *count)
{
    const struct radiosity_entry first = heap[0], last = heap[--*count];
    uint32_t at = 0;
    for (uint32_t child = 1; child < *count; child = 2 * at + 1) {
        if (child + 1 < *count && precedes(&heap[child + 1], &heap[child])) child++;
        if (!precedes(&heap[child], &last)) break;
        heap[at] = heap[child];
        at = child;
    }
    heap[at] = last;
    return first;
}

// ---- rows

// Adds the factors of a cluster to its node and to all nodes above it.
static uint32_t add_upwards(struct radiosity_rows *rows, uint32_t cluster,
                            struct radiosity_factor factor, uint32_t touched)
{
    for (uint32_t n = cluster; n != RADIOSITY_NO_NODE; n = rows->tree->nodes[n].parent) {
        struct radiosity_factor *sum = &rows->sum[n];
        if (sum->weight == 0.0f) rows->touched[touched++] = n;
        sum->weight += factor.weight;
        for (int a = 0; a < 3; a++) sum->along[a] += factor.along[a];
    }
    return touched;
}

static struct radiosity_entry entry_of(const struct radiosity_rows *rows, uint32_t node)
{
    const struct radiosity_factor f = rows->sum[node];
    return (struct radiosity_entry){
        node, { f.weight, { f.along[0] / f.weight, f.along[1] / f.weight, f.along[2] / f.weight } }
    };
}

static uint32_t root_of(const struct radiosity_tree *tree)
{
    return tree->leaves > 1 ? tree->leaves : 0;
}

// Replaces an entry by those of its children that rays hit. False: there is no spare entry, or it
// is a cluster.
static bool refine(struct radiosity_rows *rows, uint32_t node, uint32_t spare, uint32_t *heap)
{
    const uint32_t *child = rows->tree->nodes[node].child;
    if (child[0] == RADIOSITY_NO_NODE) return false;
    const bool hit[2] = { rows->sum[child[0]].weight > 0.0f, rows->sum[child[1]].weight > 0.0f };
    if (hit[0] && hit[1] && spare == 0) return false;
    for (int k = 0; k < 2; k++)
        if (hit[k]) push(rows->heap, heap, entry_of(rows, child[k]));
    return true;
}

// Phases of the nodes of a row are independent of each other.
static float phase_of(uint32_t node, float phase)
{
    const float sum = phase + rng_unit(pcg_hash(node));
    return sum < 1.0f ? sum : sum - 1.0f;
}

// The group in a node that stands for it: the one at `phase` of the weights of its groups.
static uint32_t group_of(const struct radiosity_rows *rows, uint32_t node, float phase)
{
    const struct radiosity_node *nodes = rows->tree->nodes;
    float at = phase_of(node, phase) * rows->sum[node].weight;
    while (!rows->is_group[node]) {
        const uint32_t *child = nodes[node].child;
        const float low = rows->sum[child[0]].weight;
        const bool upper = at >= low && rows->sum[child[1]].weight > 0.0f;
        node = child[upper ? 1 : 0];
        if (upper) at -= low;
    }
    return node;
}

static uint32_t add_all(struct radiosity_rows *rows, const struct radiosity_gather *gather)
{
    uint32_t touched = 0;
    for (uint32_t i = 0; i < gather->hit_count; i++)
        touched = add_upwards(rows, gather->hit[i], gather->factor[gather->hit[i]], touched);
    return touched;
}

static void clear_sums(struct radiosity_rows *rows, uint32_t touched)
{
    for (uint32_t i = 0; i < touched; i++)
        rows->sum[rows->touched[i]] = (struct radiosity_factor){ 0 };
}

// Refines the nodes of the heap until there are `most`; returns their number.
static uint32_t refine_all(struct radiosity_rows *rows, uint32_t heap, uint32_t most,
                           struct radiosity_entry *out)
{
    uint32_t count = 0;
    while (heap > 0) {
        const struct radiosity_entry entry = pop(rows->heap, &heap);
        // Entries in the heap stay, in the end.
        const uint32_t spare = most - (count + heap + 1);
        if (!refine(rows, entry.node, spare, &heap)) out[count++] = entry;
    }
    return count;
}

static uint32_t refine_root(struct radiosity_rows *rows, uint32_t touched, uint32_t most,
                            struct radiosity_entry *out)
{
    uint32_t heap = 0;
    if (touched > 0) push(rows->heap, &heap, entry_of(rows, root_of(rows->tree)));
    return refine_all(rows, heap, most, out);
}

uint32_t radiosity_make_row(struct radiosity_rows *rows, const struct radiosity_gather *gather,
                            uint32_t most, float phase, struct radiosity_entry *out)
{
    const uint32_t touched = add_all(rows, gather);
    const uint32_t count = refine_root(rows, touched, most, out);
    for (uint32_t i = 0; i < count; i++) out[i].node = group_of(rows, out[i].node, phase);
    clear_sums(rows, touched);
    return count;
}

// ---- strata

uint32_t radiosity_stratum_of(const struct radiosity_rows *rows, uint32_t cluster)
{
    uint32_t node = cluster;
    while (rows->stratum[node] == 0) node = rows->tree->nodes[node].parent;
    return rows->stratum[node] - 1;
}

uint32_t radiosity_make_strata(struct radiosity_rows *rows, const struct radiosity_gather *sum,
                               uint32_t strata, uint32_t most, float phase,
                               struct radiosity_share *out)
{
    const uint32_t touched = add_all(rows, sum);
    uint32_t heap = 0, count = refine_root(rows, touched, strata, rows->cut);
    rows->stratum_count = count;
    for (uint32_t i = 0; i < count; i++) {
        rows->stratum_node[i] = rows->cut[i].node;
        rows->stratum[rows->cut[i].node] = 1 + i;
        push(rows->heap, &heap, rows->cut[i]);
    }
    count = refine_all(rows, heap, most, rows->cut);
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t node = rows->cut[i].node, stratum = radiosity_stratum_of(rows, node);
        out[i] = (struct radiosity_share){ group_of(rows, node, phase), stratum,
                                           rows->sum[node].weight /
                                               rows->sum[rows->stratum_node[stratum]].weight };
    }
    clear_sums(rows, touched);
    return count;
}

void radiosity_clear_strata(struct radiosity_rows *rows)
{
    for (uint32_t i = 0; i < rows->stratum_count; i++) rows->stratum[rows->stratum_node[i]] = 0;
    rows->stratum_count = 0;
}
