// The block map as a list, the chosen block by numbers.
#include "panel.h"

#include "overlay.h"
#include "viewer/operations.h"

#include <stdio.h>
#include <string.h>

enum { LABEL = 192 };

static void list_blocks(struct viewer *v)
{
    const struct blocks *blocks = &v->block_edit.blocks;
    char label[LABEL];
    for (int i = 0; i < blocks->count; i++) {
        float low[3], high[3];
        block_bounds(&blocks->at[i], low, high);
        snprintf(label, sizeof label, "%d %.40s: %.2f %.2f %.2f to %.2f %.2f %.2f", i,
                 blocks->at[i].name, (double)low[0], (double)low[1], (double)low[2],
                 (double)high[0], (double)high[1], (double)high[2]);
        if (ui_selectable(label, v->block_edit.chosen == i)) block_edit_choose(v, i);
    }
}

// ---- the chosen block

static void edit_name(struct viewer *v, const struct block *block)
{
    char name[BLOCK_NAME];
    snprintf(name, sizeof name, "%s", block->name);
    if (ui_line("name##block", name, sizeof name) && strcmp(name, block->name) != 0)
        block_edit_rename(v, name);
}

// The minimum moves the faces -x, -y and -z, the maximum the others.
static void edit_bounds(struct viewer *v, const struct block *block)
{
    float bounds[2][3];
    block_bounds(block, bounds[0], bounds[1]);
    for (int side = 0; side < 2; side++) {
        float edited[3];
        memcpy(edited, bounds[side], sizeof edited);
        if (!ui_numbers(side ? "maximum (m)" : "minimum (m)", edited, 3, 0.01f, "%.3f")) continue;
        for (int axis = 0; axis < 3; axis++) {
            float by[3] = { 0 };
            by[axis] = edited[axis] - bounds[side][axis];
            if (by[axis] != 0) block_edit_move_face(v, 2 * axis + side, by);
        }
    }
}

// The whole block.
static void edit_place(struct viewer *v, const struct block *block)
{
    float centre[3], by[3];
    block_centre(block, centre);
    memcpy(by, centre, sizeof by);
    if (!ui_numbers("centre (m)", by, 3, 0.01f, "%.3f")) return;
    for (int k = 0; k < 3; k++) by[k] -= centre[k];
    block_edit_shift(v, by);
}

static void edit_corners(struct viewer *v, const struct block *block)
{
    for (int c = 0; c < BLOCK_CORNERS; c++) {
        char label[32];
        float corner[3];
        memcpy(corner, block->corner[c], sizeof corner);
        snprintf(label, sizeof label, "corner %d (m)", c);
        if (!ui_numbers(label, corner, 3, 0.01f, "%.3f")) continue;
        block_edit_move_corner(v, c, corner);
        return; // the block may be elsewhere
    }
}

// "wall", "open" or the block beyond.
static void edit_opening(struct viewer *v, const struct block *block, int face)
{
    const struct blocks *blocks = &v->block_edit.blocks;
    const enum opening now = block_opening(block, face);
    const int beyond = now == OPENING_NEIGHBOR ? block->neighbor[face]
                                               : blocks_meeting(blocks, v->block_edit.chosen, face);
    char label[16], to[BLOCK_NAME + 16] = "";
    const char *const through = block_has_holes(block, face) ? "by holes to" : "to";
    if (beyond >= 0) snprintf(to, sizeof to, "%s %s", through, blocks->at[beyond].name);
    const char *const names[] = { "wall", "open", to };
    int index = (int)now;
    snprintf(label, sizeof label, "face %s", block_faces[face]);
    if (ui_choice(label, &index, names, beyond >= 0 ? 3 : 2)) {
        block_edit_open(v, face, (enum opening)index);
        return;
    }
    ui_tooltip(
        "A wall, an opening to the outside, or an opening to the block that meets this face. Holes "
        "such as doors are those of the map; wall and then the block opens the whole face.");
    if (now == OPENING_NEIGHBOR) return;
    ui_push(face);
    ui_same_line();
    if (ui_small_button("+")) block_edit_extend(v, face);
    ui_tooltip("A block beyond this face, open to it.");
    ui_pop();
}

// A change may move the blocks in memory, and ends the list of corners.
static void edit_block(struct viewer *v)
{
    edit_name(v, block_edit_chosen(v));
    edit_place(v, block_edit_chosen(v));
    const struct block *block = block_edit_chosen(v);
    if (strcmp(block->shape, "cube") != 0) ui_faint("a piece of a pipe: %s", block->shape);
    if (block_is_box(block))
        edit_bounds(v, block);
    else
        edit_corners(v, block);
    for (int f = 0; f < BLOCK_FACES; f++) edit_opening(v, block_edit_chosen(v), f);
    ui_switch("move connected blocks", &v->block_edit.joined);
    ui_tooltip("A face moves with the corners of connected blocks, which lean then. Without this, "
               "openings whose faces do not meet any more become walls.");
    if (ui_small_button("Duplicate")) block_edit_duplicate(v);
    ui_same_line();
    if (ui_small_button("Remove block")) block_edit_remove(v);
}

void panel_block_edit(struct viewer *v)
{
    struct block_edit *e = &v->block_edit;
    if (ui_button(e->blocks.count > 0 ? "Read the blocks again" : "Edit the blocks"))
        block_edit_read(v);
    ui_tooltip("The block map of the running method; changes that are not written are lost.");
    if (e->blocks.count == 0) return;
    e->shown = true;
    overlay_blocks(v);
    gizmo_draw(v);
    ui_same_line();
    if (ui_button("Add block")) block_edit_add(v);
    ui_tooltip("A cube in front of the camera.");
    if (block_edit_chosen(v)) edit_block(v);
    if (ui_section("Block list", true)) list_blocks(v);
    ui_line("block map", e->file, sizeof e->file);
    if (ui_button("Write and use")) block_edit_write(v, e->file);
    ui_tooltip("Writes the file and sets the option blocks: the old image stays until a bake that "
               "the new map needs is there.");
}
