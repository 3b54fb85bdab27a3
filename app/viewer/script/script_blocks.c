// Commands of scripts that edit the block map.
#include "script_state.h"

#include "viewer/blocks/block_edit.h"
#include "viewer/operations.h"

#include <string.h>

static int face_of(const struct words *w, const char *name)
{
    const int face = block_face_find(name);
    if (face < 0) script_wrong(w->script, "a face is -x, +x, -y, +y, -z or +z:", name);
    return face;
}

static bool open_face(const struct words *w, const char *face, const char *how)
{
    static const char *const openings[] = { "wall", "open", "connect" };
    const int f = face_of(w, face);
    if (f < 0) return false;
    for (int i = 0; i < 3; i++)
        if (strcmp(openings[i], how) == 0)
            return script_done(w, block_edit_open(w->v, f, (enum opening)i));
    return script_wrong(w->script, "an opening is wall, open or connect:", how);
}

// Outwards along the normal.
static bool move_face(const struct words *w, const char *face, float metres)
{
    const struct block *block = block_edit_chosen(w->v);
    const int f = face_of(w, face);
    float by[3] = { 0 };
    if (f < 0) return false;
    if (block) block_face_normal(block, f, by);
    for (int k = 0; k < 3; k++) by[k] *= metres;
    return script_done(w, block_edit_move_face(w->v, f, by));
}

// Lines of one word.
static const struct {
    const char *name;
    bool (*run)(struct viewer *v);
} simple[] = { { "read", block_edit_read },
               { "add", block_edit_add },
               { "duplicate", block_edit_duplicate },
               { "remove", block_edit_remove } };

bool script_blocks(const struct words *w)
{
    struct viewer *v = w->v;
    char face[8], how[16];
    float to[3];
    int index;
    for (size_t i = 0; i < sizeof simple / sizeof *simple; i++)
        if (strcmp(w->rest, simple[i].name) == 0) return script_done(w, simple[i].run(v));
    if (sscanf(w->rest, "choose %d", &index) == 1)
        return script_done(w, block_edit_choose(v, index));
    if (sscanf(w->rest, "move %7s %f", face, to) == 2) return move_face(w, face, *to);
    if (sscanf(w->rest, "shift %f,%f,%f", to, to + 1, to + 2) == 3)
        return script_done(w, block_edit_shift(v, to));
    if (sscanf(w->rest, "corner %d %f,%f,%f", &index, to, to + 1, to + 2) == 4 && index >= 0 &&
        index < BLOCK_CORNERS)
        return script_done(w, block_edit_move_corner(v, index, to));
    if (sscanf(w->rest, "open %7s %15s", face, how) == 2) return open_face(w, face, how);
    if (sscanf(w->rest, "extend %7s", face) == 1) {
        const int f = face_of(w, face);
        return f >= 0 && script_done(w, block_edit_extend(v, f));
    }
    if (strcmp(w->rest, "join on") == 0 || strcmp(w->rest, "join off") == 0) {
        v->block_edit.joined = strcmp(w->rest, "join on") == 0;
        return true;
    }
    if (strncmp(w->rest, "rename ", 7) == 0)
        return script_done(w, block_edit_rename(v, w->rest + 7));
    if (strncmp(w->rest, "write ", 6) == 0) return script_done(w, block_edit_write(v, w->rest + 6));
    return script_wrong(
        w->script,
        "blocks takes read, choose N, move FACE M, shift X,Y,Z, corner N X,Y,Z, open FACE HOW, "
        "extend FACE, join on|off, rename NAME, add, duplicate, remove or write FILE:",
        w->rest);
}
