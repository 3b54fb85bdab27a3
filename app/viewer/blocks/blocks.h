// A block map as the user edits it (docs/block-maps.md): lengths in metres, corners and faces as in
// the file.
#pragma once

#include <stdbool.h>
#include <stddef.h>

enum {
    BLOCKS_MOST = 1024,
    BLOCK_FACES = 6,
    BLOCK_CORNERS = 8,
    BLOCK_NAME = 64,
    BLOCK_HOLES = 16, // parts of a face
};

struct block {
    char name[BLOCK_NAME], shape[16]; // shape: "cube", "straight" …
    float corner[BLOCK_CORNERS][3];   // bit 0 of the index: high x, bit 1 y, bit 2 z
    bool open[BLOCK_FACES];           // without a neighbour
    int neighbor[BLOCK_FACES];        // -1: none
    // Shares of parts of a wall that are open to its neighbour; all 0: the whole face is.
    float holes[BLOCK_FACES][BLOCK_HOLES];
};

struct blocks {
    int count;
    struct block *at;
    char *clutter, *walls; // names of nodes, as JSON; NULL: none
};

enum opening { OPENING_WALL, OPENING_OPEN, OPENING_NEIGHBOR };

extern const char *const block_faces[BLOCK_FACES]; // "-x", "+x", "-y" …
int block_face_find(const char *name);             // -1: no such face

// The map of a text that the library has made; false: out of memory. blocks_close accepts zero.
bool blocks_parse(struct blocks *out, const char *json);
void blocks_close(struct blocks *blocks);
bool blocks_copy(struct blocks *to, const struct blocks *from);
// JSON, which the caller frees; NULL: out of memory.
char *blocks_print(const struct blocks *blocks);
bool blocks_same(const struct blocks *a, const struct blocks *b);

// ---- one block

void block_bounds(const struct block *block, float low[3], float high[3]);
bool block_is_box(const struct block *block); // parallel to the axes
void block_set_box(struct block *block, const float low[3], const float high[3]);
void block_centre(const struct block *block, float out[3]);
void block_face_centre(const struct block *block, int face, float out[3]);
// Outward unit normal at the middle of a face.
void block_face_normal(const struct block *block, int face, float out[3]);
// Corner i, 0 to 3, around a face.
int block_face_corner(int face, int i);
enum opening block_opening(const struct block *block, int face);
bool block_has_holes(const struct block *block, int face);

// ---- changes of a map: those that add are -1 if there is no room or no memory

// A copy of `block` with a name of its own and without neighbours.
int blocks_add(struct blocks *blocks, const struct block *block);
// A block beyond a face, as long as this one, and open to it.
int blocks_extend(struct blocks *blocks, int block, int face);
void blocks_remove(struct blocks *blocks, int block);
// Moves a face, and with it that of its neighbour.
void blocks_move_face(struct blocks *blocks, int block, int face, const float by[3]);
// Moves a whole block; its neighbours stay.
void blocks_shift(struct blocks *blocks, int block, const float by[3]);
// Moves the corners of a face, and with them those of connected blocks that are there: openings
// stay, but blocks beside it lean.
void blocks_move_joined(struct blocks *blocks, int block, int face, const float by[3]);
// Moves a corner to a point, and with it the corners of connected blocks that are there.
void blocks_move_corner(struct blocks *blocks, int block, int corner, const float to[3]);
// The block whose face meets this one and has no other neighbour; -1: none.
int blocks_meeting(const struct blocks *blocks, int block, int face);
// OPENING_NEIGHBOR: to the block that meets the face; false if none does, or if the openings are
// those of a shape.
bool blocks_set_opening(struct blocks *blocks, int block, int face, enum opening opening);
// Makes walls of connected faces that do not meet any more; returns their number.
int blocks_disconnect(struct blocks *blocks);
