// Cells become boxes, boxes between the same walls one, and boxes blocks.
#include "map_boxes.h"

#include "techniques/mrt/level/holes.h"

#include <math.h>
#include <stdio.h>

static const float MAX_ASPECT = 1.6f; // of boxes that are made larger: the dictionary has cubes

// A union of cells, from plane low[a] to plane high[a].
struct map_box {
    int low[3], high[3];
    unsigned open; // bit f: face f leads to one box with the same face, or outside
    unsigned hole; // bit f: face f has holes to one box with the same face
};

struct map_boxes {
    struct mrt_cells *cells;
    struct map_box *boxes;
    int *box_of_cell; // −1: none
    int count;
    int first; // number in the name of the first box
};

static void one_box_per_cell(struct map_boxes *boxes)
{
    const struct mrt_cells *cells = boxes->cells;
    for (int i = 0; i < mrt_cells_count(cells); i++) {
        boxes->box_of_cell[i] = -1;
        if (!cells->cell[i].free) continue;
        struct map_box *box = &boxes->boxes[boxes->count];
        boxes->box_of_cell[i] = boxes->count++;
        mrt_cell_place(cells, i, box->low);
        for (int a = 0; a < 3; a++) box->high[a] = box->low[a] + 1;
        box->open = cells->cell[i].open;
        box->hole = cells->cell[i].hole;
    }
}

static float box_edge(const struct map_boxes *boxes, const struct map_box *box, int axis)
{
    const float *plane = boxes->cells->plane[axis];
    return plane[box->high[axis]] - plane[box->low[axis]];
}

static bool is_cubic(const struct map_boxes *boxes, const struct map_box *box)
{
    float shortest = INFINITY, longest = 0.0f;
    for (int a = 0; a < 3; a++) {
        shortest = fminf(shortest, box_edge(boxes, box, a));
        longest = fmaxf(longest, box_edge(boxes, box, a));
    }
    return longest <= MAX_ASPECT * shortest;
}

// The box beyond an open face, or one with holes.
static int box_beyond(const struct map_boxes *boxes, const struct map_box *box, int face)
{
    int at[3] = { box->low[0], box->low[1], box->low[2] }, beyond[3];
    if (face & 1) at[face / 2] = box->high[face / 2] - 1;
    if (!((box->open | box->hole) >> face & 1u) || !mrt_cell_beyond(boxes->cells, at, face, beyond))
        return -1;
    return boxes->box_of_cell[mrt_cell_at(boxes->cells, beyond) - boxes->cells->cell];
}

// Faces beside the common one must be walls of both boxes: an opening of half a face has no shape
// in the dictionary.
static bool can_merge(const struct map_boxes *boxes, const struct map_box *a, int face,
                      const struct map_box *b)
{
    unsigned ends = 3u << (face & ~1);
    if (!(a->open >> face & 1u) || (a->open | b->open | a->hole | b->hole) & ~ends) return false;
    struct map_box both = *a;
    if (face & 1)
        both.high[face / 2] = b->high[face / 2];
    else
        both.low[face / 2] = b->low[face / 2];
    return is_cubic(boxes, &both);
}

static void merge(struct map_boxes *boxes, int i, int face, int j)
{
    struct map_box *a = &boxes->boxes[i];
    const struct map_box *b = &boxes->boxes[j];
    int axis = face / 2;
    if (face & 1)
        a->high[axis] = b->high[axis];
    else
        a->low[axis] = b->low[axis];
    a->open = (a->open & ~(1u << face)) | (b->open & 1u << face);
    a->hole = (a->hole & ~(1u << face)) | (b->hole & 1u << face);
    int last = --boxes->count;
    boxes->boxes[j] = boxes->boxes[last];
    for (int c = 0; c < mrt_cells_count(boxes->cells); c++) {
        int *box = &boxes->box_of_cell[c];
        if (*box == j) *box = i;
        if (*box == last) *box = j; // also where i is the last one
    }
}

static bool merge_one(struct map_boxes *boxes)
{
    for (int i = 0; i < boxes->count; i++) {
        for (int f = 0; f < CUBE_FACES; f++) {
            int j = box_beyond(boxes, &boxes->boxes[i], f);
            if (j < 0 || !can_merge(boxes, &boxes->boxes[i], f, &boxes->boxes[j])) continue;
            merge(boxes, i, f, j);
            return true;
        }
    }
    return false;
}

static void set_block(const struct map_boxes *boxes, int i, struct mrt_block *block)
{
    char name[MRT_NAME_BYTES];
    const struct map_box *from = &boxes->boxes[i];
    struct box3 box;
    snprintf(name, sizeof name, "box %d", boxes->first + i);
    for (int a = 0; a < 3; a++) {
        box.min.raw[a] = boxes->cells->plane[a][from->low[a]];
        box.max.raw[a] = boxes->cells->plane[a][from->high[a]];
    }
    mrt_block_init(block, name, MRT_BLOCK_CUBE);
    mrt_block_set_box(block, box);
}

static bool is_blocked(const void *scene, vec3s from, vec3s way)
{
    const float length = glms_vec3_norm(way);
    return raycast_blocked(scene, from, vec3_unit(way), length);
}

static bool connect_by_holes(const char *what, const struct mrt_cells *cells,
                             struct mrt_block_map *map, int i, int face, int j)
{
    struct mrt_holes holes;
    if (mrt_find_holes(&map->blocks[i], face, is_blocked, cells->raycast, &holes) < MRT_LEAST_HOLE)
        return true;
    return mrt_connect_by_holes(what, map, i, face, j, cube_opposite(face), &holes);
}

static bool emit(struct host *host, const char *what, const struct map_boxes *boxes,
                 struct mrt_block_map *map)
{
    if (!mrt_block_map_init(host, what, (size_t)boxes->count, map)) return false;
    for (int i = 0; i < boxes->count; i++) {
        set_block(boxes, i, &map->blocks[i]);
        map->blocks[i].open = boxes->boxes[i].open;
    }
    bool ok = true;
    for (int i = 0; ok && i < boxes->count; i++) {
        for (int f = CUBE_RIGHT; ok && f < CUBE_FACES; f += 2) {
            int j = box_beyond(boxes, &boxes->boxes[i], f);
            if (j >= 0 && boxes->boxes[i].open >> f & 1u)
                ok = mrt_connect(what, map, i, f, j, cube_opposite(f));
            else if (j >= 0)
                ok = connect_by_holes(what, boxes->cells, map, i, f, j);
        }
    }
    ok = ok && mrt_block_map_check(what, map);
    if (!ok) mrt_block_map_finish(map);
    return ok;
}

// A cube needs a wall: where all six faces of a box are open, the last one is closed.
static void keep_a_wall(struct map_boxes *boxes)
{
    for (int i = 0; i < boxes->count; i++) {
        struct map_box *box = &boxes->boxes[i];
        int beyond = box_beyond(boxes, box, CUBE_TOP);
        if (box->open != CUBE_ALL_FACES) continue;
        box->open &= ~(1u << CUBE_TOP);
        if (beyond >= 0) boxes->boxes[beyond].open &= ~(1u << CUBE_BOTTOM);
    }
}

bool mrt_map_of_cells(struct host *host, const char *what, struct mrt_cells *cells, int first,
                      struct mrt_block_map *map)
{
    size_t count = (size_t)mrt_cells_count(cells);
    struct map_boxes boxes = { .cells = cells, .first = first };
    boxes.boxes = host_alloc(host, count, sizeof *boxes.boxes);
    boxes.box_of_cell = host_alloc(host, count, sizeof *boxes.box_of_cell);
    bool ok = boxes.boxes && boxes.box_of_cell;
    if (ok) {
        one_box_per_cell(&boxes);
        while (merge_one(&boxes)) {}
        keep_a_wall(&boxes);
        ok = emit(host, what, &boxes, map);
    }
    host_free(host, boxes.box_of_cell);
    host_free(host, boxes.boxes);
    return ok;
}
