#include "block_edit.h"

#include "viewer/operations.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const float FIRST_EDGE = 2.0f; // m, of the first block of a map

void block_edit_init(struct viewer *v)
{
    v->block_edit.chosen = -1;
    snprintf(v->block_edit.file, sizeof v->block_edit.file, "afterglow-blocks.json");
}

void block_edit_close(struct viewer *v)
{
    blocks_close(&v->block_edit.blocks);
}

bool block_edit_possible(const struct viewer *v)
{
    return ag_technique_debug_view_find(v->method.chosen[ROLE_SOURCE], "blocks") >= 0;
}

const struct block *block_edit_chosen(const struct viewer *v)
{
    const struct block_edit *e = &v->block_edit;
    const bool is = e->chosen >= 0 && e->chosen < e->blocks.count;
    return is ? &e->blocks.at[e->chosen] : NULL;
}

// ---- the present map

static void replace(struct viewer *v, struct blocks *blocks)
{
    struct block_edit *e = &v->block_edit;
    blocks_close(&e->blocks);
    e->blocks = *blocks;
    if (e->chosen >= e->blocks.count) e->chosen = e->blocks.count - 1;
    viewer_note(v, "blocks", -1);
}

bool block_edit_read(struct viewer *v)
{
    struct ag_block_map *map = NULL;
    struct blocks blocks = { 0 };
    if (!viewer_check(
            v, ag_block_map_create(v->desc->scene, v->gi, v->desc->animation, v->time_s, &map)))
        return false;
    const bool done = blocks_parse(&blocks, ag_block_map_json(map));
    ag_block_map_destroy(map);
    if (done) {
        replace(v, &blocks);
        return true;
    }
    viewer_warn(v, "cannot edit the blocks: out of memory");
    blocks_close(&blocks);
    return false;
}

bool block_edit_choose(struct viewer *v, int block)
{
    if (block < 0 || block >= v->block_edit.blocks.count) {
        viewer_warn(v, "block %d is not one of %d", block, v->block_edit.blocks.count);
        return false;
    }
    v->block_edit.chosen = block;
    return true;
}

void block_edit_restore(struct viewer *v, const struct blocks *blocks)
{
    struct blocks copy;
    if (blocks_same(&v->block_edit.blocks, blocks)) return;
    if (blocks_copy(&copy, blocks))
        replace(v, &copy);
    else
        viewer_warn(v, "cannot restore the blocks: out of memory");
}

// ---- changes

struct ag_block_map *block_edit_check(struct viewer *v, const struct blocks *blocks)
{
    struct ag_block_map *map = NULL;
    char *text = blocks_print(blocks);
    if (!text)
        viewer_warn(v, "cannot change the blocks: out of memory");
    else
        viewer_check(v, ag_block_map_parse(v->desc->context, text, &map));
    free(text);
    return map;
}

static bool begin(struct viewer *v, struct blocks *next)
{
    if (!block_edit_chosen(v)) {
        viewer_warn(v, "choose a block first");
        return false;
    }
    if (blocks_copy(next, &v->block_edit.blocks)) return true;
    viewer_warn(v, "cannot change the blocks: out of memory");
    return false;
}

// Replaces the map by the changed one if the library accepts it, or if it has no blocks, which no
// file may state.
static bool take(struct viewer *v, struct blocks *next)
{
    const int parted = blocks_disconnect(next);
    struct ag_block_map *map = next->count > 0 ? block_edit_check(v, next) : NULL;
    if (next->count > 0 && !map) {
        blocks_close(next);
        return false;
    }
    ag_block_map_destroy(map);
    replace(v, next);
    if (parted > 0)
        viewer_say(v, "openings that are walls now, as their faces do not meet any more: %d",
                   parted);
    return true;
}

static bool refuse(struct viewer *v, struct blocks *next, const char *why)
{
    viewer_warn(v, "%s", why);
    blocks_close(next);
    return false;
}

static bool is_finite(const float p[3])
{
    return isfinite(p[0]) && isfinite(p[1]) && isfinite(p[2]);
}

bool block_edit_move_face(struct viewer *v, int face, const float by[3])
{
    struct blocks next;
    if (!begin(v, &next)) return false;
    if (!is_finite(by)) return refuse(v, &next, "the distance is not finite");
    if (v->block_edit.joined)
        blocks_move_joined(&next, v->block_edit.chosen, face, by);
    else
        blocks_move_face(&next, v->block_edit.chosen, face, by);
    return take(v, &next);
}

bool block_edit_shift(struct viewer *v, const float by[3])
{
    struct blocks next;
    if (!begin(v, &next)) return false;
    if (!is_finite(by)) return refuse(v, &next, "the distance is not finite");
    blocks_shift(&next, v->block_edit.chosen, by);
    return take(v, &next);
}

bool block_edit_move_corner(struct viewer *v, int corner, const float to[3])
{
    struct blocks next;
    if (!begin(v, &next)) return false;
    if (!is_finite(to)) return refuse(v, &next, "the point is not finite");
    blocks_move_corner(&next, v->block_edit.chosen, corner, to);
    return take(v, &next);
}

bool block_edit_rename(struct viewer *v, const char *name)
{
    struct blocks next;
    if (!begin(v, &next)) return false;
    if (!name[0] || strlen(name) >= BLOCK_NAME)
        return refuse(v, &next, "a block's name has 1 to 63 bytes");
    snprintf(next.at[v->block_edit.chosen].name, BLOCK_NAME, "%s", name);
    return take(v, &next);
}

bool block_edit_open(struct viewer *v, int face, enum opening opening)
{
    struct blocks next;
    if (!begin(v, &next)) return false;
    if (!blocks_set_opening(&next, v->block_edit.chosen, face, opening))
        return refuse(v, &next,
                      opening == OPENING_NEIGHBOR
                          ? "no face of another block meets this one in all four corners"
                          : "the openings of this block are those of its shape");
    return take(v, &next);
}

static bool take_added(struct viewer *v, struct blocks *next, int added)
{
    if (added < 0)
        return refuse(v, next,
                      next->count >= BLOCKS_MOST ? "a map has at most 1024 blocks"
                                                 : "cannot add a block there");
    if (!take(v, next)) return false;
    v->block_edit.chosen = added;
    return true;
}

// As large as the blocks are at the mean, along the axes.
static struct block new_cube(const struct viewer *v)
{
    const struct blocks *blocks = &v->block_edit.blocks;
    struct block cube = { .shape = "cube" };
    float low[3], high[3], target[3], edge = blocks->count > 0 ? 0.0f : FIRST_EDGE;
    for (int i = 0; i < blocks->count; i++) {
        block_bounds(&blocks->at[i], low, high);
        for (int k = 0; k < 3; k++) edge += (high[k] - low[k]) / (3.0f * (float)blocks->count);
    }
    look_target(&v->look, target);
    for (int k = 0; k < 3; k++) {
        low[k] = target[k] - 0.5f * edge;
        high[k] = target[k] + 0.5f * edge;
    }
    block_set_box(&cube, low, high);
    return cube;
}

bool block_edit_add(struct viewer *v)
{
    struct blocks next;
    const struct block cube = new_cube(v);
    if (!blocks_copy(&next, &v->block_edit.blocks)) {
        viewer_warn(v, "cannot add a block: out of memory");
        return false;
    }
    return take_added(v, &next, blocks_add(&next, &cube));
}

bool block_edit_duplicate(struct viewer *v)
{
    struct blocks next;
    if (!begin(v, &next)) return false;
    return take_added(v, &next, blocks_add(&next, &next.at[v->block_edit.chosen]));
}

bool block_edit_extend(struct viewer *v, int face)
{
    struct blocks next;
    if (!begin(v, &next)) return false;
    if (next.at[v->block_edit.chosen].neighbor[face] >= 0)
        return refuse(v, &next, "the face has a neighbor already");
    return take_added(v, &next, blocks_extend(&next, v->block_edit.chosen, face));
}

bool block_edit_remove(struct viewer *v)
{
    struct blocks next;
    if (!begin(v, &next)) return false;
    blocks_remove(&next, v->block_edit.chosen);
    return take(v, &next);
}
