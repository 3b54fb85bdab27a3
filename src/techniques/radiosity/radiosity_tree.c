#include "techniques/radiosity/radiosity_tree.h"

#include <math.h>

struct build {
    struct radiosity_tree *tree;
    const struct radiosity_place *places;
    uint32_t *order, *scratch;
};

// Six coordinates of a place; those of the normal count half the size of the group, so that two
// sides of a wall part before two ends of it.
static float coordinate(const struct radiosity_place *place, int axis, float size)
{
    return axis < 3 ? place->position.raw[axis] : 0.5f * size * place->normal.raw[axis - 3];
}

struct cut {
    int axis;
    float size, at;
    bool splits;
};

static void range_of(const struct build *b, uint32_t first, uint32_t count, int axis, float size,
                     float *low, float *high)
{
    *low = *high = coordinate(&b->places[b->order[first]], axis, size);
    for (uint32_t i = 1; i < count; i++) {
        const float at = coordinate(&b->places[b->order[first + i]], axis, size);
        *low = at < *low ? at : *low;
        *high = at > *high ? at : *high;
    }
}

static struct cut cut_of(const struct build *b, uint32_t first, uint32_t count)
{
    struct cut cut = { .splits = false };
    float widest = 0.0f, low, high;
    for (int axis = 0; axis < 3; axis++) {
        range_of(b, first, count, axis, 0.0f, &low, &high);
        cut.size += (high - low) * (high - low);
    }
    cut.size = sqrtf(cut.size);
    for (int axis = 0; axis < 6; axis++) {
        range_of(b, first, count, axis, cut.size, &low, &high);
        const float middle = 0.5f * (low + high);
        if (!(high - low > widest) || !(middle > low)) continue;
        widest = high - low;
        cut.axis = axis;
        cut.at = middle;
        cut.splits = true;
    }
    return cut;
}

// Stable. Returns the number of places on the lower side; of equal places half.
static uint32_t subdivide(const struct build *b, uint32_t first, uint32_t count)
{
    const struct cut cut = cut_of(b, first, count);
    if (!cut.splits) return count / 2;
    uint32_t low = 0, high = 0;
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t place = b->order[first + i];
        if (coordinate(&b->places[place], cut.axis, cut.size) < cut.at)
            b->order[first + low++] = place;
        else
            b->scratch[high++] = place;
    }
    for (uint32_t i = 0; i < high; i++) b->order[first + low + i] = b->scratch[i];
    return low;
}

// Adds a node over these places and returns its number.
static uint32_t add_node(const struct build *b, uint32_t first, uint32_t count, uint32_t parent)
{
    struct radiosity_tree *tree = b->tree;
    const uint32_t at = count == 1 ? first : tree->count++;
    tree->nodes[at] =
        (struct radiosity_node){ first, count, parent, { RADIOSITY_NO_NODE, RADIOSITY_NO_NODE } };
    return at;
}

static void split_all(const struct build *b, uint32_t root)
{
    struct radiosity_tree *tree = b->tree;
    // Nodes are numbered in the order of their making, so that all that are left to split follow.
    for (uint32_t at = root; at < tree->count; at++) {
        struct radiosity_node *node = &tree->nodes[at];
        const uint32_t low = subdivide(b, node->first, node->count);
        node->child[0] = add_node(b, node->first, low, at);
        node->child[1] = add_node(b, node->first + low, node->count - low, at);
    }
}

bool radiosity_tree_init(struct radiosity_tree *out, struct host *host,
                         const struct radiosity_place *places, uint32_t leaves, uint32_t *order)
{
    *out = (struct radiosity_tree){ .host = host, .leaves = leaves, .count = leaves };
    out->nodes = host_alloc(host, 2 * (size_t)leaves, sizeof *out->nodes);
    struct build build = { out, places, order, host_alloc(host, leaves, sizeof(uint32_t)) };
    const bool ok = out->nodes && build.scratch;
    for (uint32_t i = 0; ok && i < leaves; i++) order[i] = i;
    if (ok && leaves > 0) split_all(&build, add_node(&build, 0, leaves, RADIOSITY_NO_NODE));
    host_free(host, build.scratch);
    if (!ok) radiosity_tree_finish(out);
    return ok;
}

void radiosity_tree_finish(struct radiosity_tree *tree)
{
    if (tree->host) host_free(tree->host, tree->nodes);
    *tree = (struct radiosity_tree){ 0 };
}
