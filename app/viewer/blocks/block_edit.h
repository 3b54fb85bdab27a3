// The block map in the viewer: the present one is read, edited and written to a file, which the
// method then uses.
#pragma once

#include "blocks.h"

struct ag_block_map;
struct viewer;

struct block_edit {
    struct blocks blocks; // count 0: none is edited
    int chosen;           // -1: none
    bool shown;           // the panel with them is shown
    bool joined;          // a face moves with the corners of connected blocks
    char file[512];       // of the button
};

void block_edit_init(struct viewer *v);
void block_edit_close(struct viewer *v);
// The present source has a block map: its debug view is "blocks".
bool block_edit_possible(const struct viewer *v);
// The map of the running method, in place of the edited one. False, with a message, if it has none.
bool block_edit_read(struct viewer *v);
bool block_edit_choose(struct viewer *v, int block);
// The block that is chosen; NULL: none.
const struct block *block_edit_chosen(const struct viewer *v);

// The library's map of edited blocks; NULL, with a message: they break a rule.
struct ag_block_map *block_edit_check(struct viewer *v, const struct blocks *blocks);

// Changes of the chosen block, or the map. Each is checked by the library: false, with a message
// and nothing changed, if the map would be wrong.
bool block_edit_move_face(struct viewer *v, int face, const float by[3]);
bool block_edit_shift(struct viewer *v, const float by[3]); // the whole block
bool block_edit_move_corner(struct viewer *v, int corner, const float to[3]);
bool block_edit_rename(struct viewer *v, const char *name);
bool block_edit_open(struct viewer *v, int face, enum opening opening);
bool block_edit_add(struct viewer *v); // a cube in front of the camera
bool block_edit_duplicate(struct viewer *v);
bool block_edit_extend(struct viewer *v, int face); // a block beyond a face
bool block_edit_remove(struct viewer *v);
// For undo: takes over a copy of a map.
void block_edit_restore(struct viewer *v, const struct blocks *blocks);

// ---- block_file.c

// Writes the map and has the method use it. False, with a message, if the file cannot be written or
// the method cannot use it.
bool block_edit_write(struct viewer *v, const char *path);
