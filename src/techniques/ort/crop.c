// Axial slicing (Sunshine-Hill & Faloutsos 2006, section 5.1): a box is cut into two by a line
// between rows or runs, and each part is cropped to its bounding box. The paper does not say where.
// Here every line is a candidate, not only those at empty rows or columns, and the best one leaves
// the least cost. Boxes are cut further than that alone pays, for a ring or the letter L saves
// nothing before the second cut; then cuts that did not pay are taken back.
#include "techniques/ort/crop.h"

#include "core/host.h"

// The cost of a piece, in texels: its share of tables and of idle threads, as if each piece began a
// group of 32 threads that handle a run each. With costs of 0, 64, 128, 256, 512, 1024 and 4096 the
// 200 maps of tests/techniques/ort/test_bins.c have 377, 222, 156, 78, 19, 5 and 4 pieces each, in
// 14, 14, 16, 19, 23, 24 and 25 bins.
static const uint32_t PIECE_COST = 256;

bool ort_crop_init(struct ort_crop *crop, struct host *host, const struct ort_cover *cover)
{
    const uint32_t longer = cover->runs > cover->height ? cover->runs : cover->height;
    *crop = (struct ort_crop){ .host = host, .cover = cover };
    crop->costs = host_alloc(host, (size_t)longer + 1, sizeof *crop->costs);
    return crop->costs;
}

void ort_crop_finish(struct ort_crop *crop)
{
    if (!crop->host) return;
    host_free(crop->host, crop->costs);
    host_free(crop->host, crop->nodes);
    *crop = (struct ort_crop){ 0 };
}

// ---- costs

static uint32_t texels_of(const struct ort_box *box)
{
    const uint32_t runs = box->to[ORT_X] - box->from[ORT_X];
    return runs * ORT_RUN * (box->to[ORT_Y] - box->from[ORT_Y]);
}

static uint32_t bits_of(uint32_t word)
{
    uint32_t count = 0;
    for (; word; word &= word - 1) count++;
    return count;
}

// Texels of a box, and the pieces that slices.c makes of it.
static uint32_t cost_of(const struct ort_box *box)
{
    const uint32_t runs = box->to[ORT_X] - box->from[ORT_X];
    const uint32_t rows = box->to[ORT_Y] - box->from[ORT_Y];
    const uint32_t widest = ORT_BIN_SIDE / ORT_RUN;
    const uint32_t slices = runs / widest + bits_of(runs % widest);
    const uint32_t parts = (rows + ORT_BIN_SIDE - 1) / ORT_BIN_SIDE;
    return texels_of(box) + PIECE_COST * slices * parts;
}

// ---- a cut

// The bounding box of the occupied runs of some lines of a box, which are added from one end.
struct sweep {
    const struct ort_cover *cover;
    const struct ort_box *box;
    int axis;            // along which lines follow each other
    struct ort_box part; // from > to: nothing yet
    uint32_t cost;
};

static struct sweep begin_sweep(const struct ort_cover *cover, const struct ort_box *box, int axis)
{
    const struct ort_box nothing = { { box->to[0], box->to[1] }, { box->from[0], box->from[1] } };
    return (struct sweep){ .cover = cover, .box = box, .axis = axis, .part = nothing };
}

// Returns the cost of the lines so far. Bounds across only widen: all lines of a sweep together
// take no more steps than the box has lines of either axis.
static uint32_t add_line(struct sweep *sweep, uint32_t at)
{
    const int axis = sweep->axis, across = !axis;
    struct ort_box outside = *sweep->box, *part = &sweep->part;
    outside.from[axis] = at;
    outside.to[axis] = at + 1;
    if (ort_cover_count(sweep->cover, &outside) == 0) return sweep->cost;
    if (at < part->from[axis]) part->from[axis] = at;
    if (at >= part->to[axis]) part->to[axis] = at + 1;
    outside.to[across] = part->from[across];
    while (ort_cover_count(sweep->cover, &outside) > 0) outside.to[across]--;
    part->from[across] = outside.to[across];
    outside.to[across] = sweep->box->to[across];
    outside.from[across] = part->to[across];
    while (ort_cover_count(sweep->cover, &outside) > 0) outside.from[across]++;
    part->to[across] = outside.from[across];
    return sweep->cost = cost_of(part);
}

struct cut {
    int axis;
    uint32_t at;         // the first line of the second part
    uint32_t cost;       // of both parts
    uint32_t off_middle; // twice the distance of the cut and the middle of the box
};

// The cut nearest to the middle wins among equal costs: the tree is less deep.
static bool is_better(const struct cut *cut, const struct cut *than)
{
    if (cut->cost != than->cost) return cut->cost < than->cost;
    return cut->off_middle < than->off_middle;
}

// Replaces `best` by a better cut along an axis.
static void find_cut(struct ort_crop *crop, const struct ort_box *box, int axis, struct cut *best)
{
    const uint32_t from = box->from[axis], to = box->to[axis];
    struct sweep before = begin_sweep(crop->cover, box, axis), after = before;
    for (uint32_t at = from; at + 1 < to; at++) crop->costs[at + 1 - from] = add_line(&before, at);
    for (uint32_t at = to - 1; at > from; at--) {
        const uint32_t twice = 2 * at, middle = from + to;
        const struct cut cut = { .axis = axis,
                                 .at = at,
                                 .cost = crop->costs[at - from] + add_line(&after, at),
                                 .off_middle = twice > middle ? twice - middle : middle - twice };
        if (is_better(&cut, best)) *best = cut;
    }
}

// ---- the tree

static bool reserve(struct ort_crop *crop, size_t more)
{
    const size_t count = crop->node_count + more;
    if (count <= crop->capacity) return true;
    const size_t capacity = count + count / 2 + 64;
    struct ort_crop_node *nodes = host_realloc(crop->host, crop->nodes, capacity, sizeof *nodes);
    if (!nodes) return false;
    crop->nodes = nodes;
    crop->capacity = capacity;
    return true;
}

static void add_node(struct ort_crop *crop, struct ort_box box)
{
    ort_cover_crop(crop->cover, &box);
    crop->nodes[crop->node_count++] = (struct ort_crop_node){ .box = box, .cost = cost_of(&box) };
}

// Cuts a box into two, unless its empty texels cost less than another piece.
static bool cut_node(struct ort_crop *crop, size_t index)
{
    const struct ort_box box = crop->nodes[index].box;
    const uint32_t occupied = ort_cover_count(crop->cover, &box) * ORT_RUN;
    if (texels_of(&box) - occupied <= PIECE_COST) return true;
    struct cut cut = { .cost = UINT32_MAX };
    find_cut(crop, &box, ORT_X, &cut);
    find_cut(crop, &box, ORT_Y, &cut);
    if (!reserve(crop, 2)) return false;
    struct ort_box first = box, second = box;
    first.to[cut.axis] = second.from[cut.axis] = cut.at;
    crop->nodes[index].child = (uint32_t)crop->node_count;
    add_node(crop, first);
    add_node(crop, second);
    return true;
}

// Takes cuts back that do not pay. Children follow their parents.
static void prune(struct ort_crop *crop)
{
    for (size_t i = crop->node_count; i-- > 0;) {
        struct ort_crop_node *node = &crop->nodes[i];
        if (!node->child) continue;
        const struct ort_crop_node *child = &crop->nodes[node->child];
        const uint32_t cost = child[0].cost + child[1].cost;
        if (cost < node->cost)
            node->cost = cost;
        else
            node->child = 0;
    }
}

// Moves the boxes of the leaves to the front.
static void collect_boxes(struct ort_crop *crop)
{
    crop->nodes[0].kept = true;
    for (size_t i = 0; i < crop->node_count; i++) {
        const struct ort_crop_node node = crop->nodes[i];
        if (!node.kept) continue;
        if (node.child)
            crop->nodes[node.child].kept = crop->nodes[node.child + 1].kept = true;
        else
            crop->nodes[crop->box_count++].box = node.box;
    }
}

bool ort_crop_map(struct ort_crop *crop)
{
    const struct ort_box all = { .to = { crop->cover->runs, crop->cover->height } };
    crop->node_count = crop->box_count = 0;
    if (ort_cover_count(crop->cover, &all) == 0) return true;
    if (!reserve(crop, 1)) return false;
    add_node(crop, all);
    for (size_t i = 0; i < crop->node_count; i++)
        if (!cut_node(crop, i)) return false;
    prune(crop);
    collect_boxes(crop);
    return true;
}
