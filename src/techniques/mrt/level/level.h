// A level: the blocks of a map with their shapes of the dictionary, and the operator T_b→r that
// carries indirect light from each block through openings into others (Loos 2015, section 3.5.3).
#pragma once

#include "techniques/mrt/dictionary/dictionary.h"
#include "techniques/mrt/level/atlas.h"
#include "techniques/mrt/level/retrace.h"
#include "techniques/mrt/level/wall.h"

enum { MRT_LANES = 8 }; // of the solver

struct mrt_level_options {
    int max_depth; // openings that light passes at most; 0: none
    struct mrt_retrace_limits
        retrace; // bases in the proportions of the blocks, where they are cubes
};

// Light enters `block` by an opening, or by holes of a wall.
struct mrt_entry {
    int block, face;
};

// T_b→r is sparse: for each entry, one matrix for each block whose light reaches it.
struct mrt_link {
    int source;    // block
    size_t matrix; // offset in `matrices`: k_b rows of link_stride, the transposed k_r × k_b
};

struct mrt_level {
    struct host *host;
    const struct mrt_block_map *map;         // borrowed
    const struct mrt_dictionary *dictionary; // borrowed
    enum mrt_maze maze;                      // of the dictionary, as are the numbers
    int resolution;                          // texels along an edge of a wall
    int k_b, k_rlf, k_r;
    struct mrt_cube_place *place; // [blocks]
    struct mrt_retraces retraces; // of the limits `retrace`
    int *first_texel;             // [blocks + 1], of the level
    struct mrt_entry *entries;    // in the order of blocks, then faces
    int entry_count;
    int *entry_of_face;       // [CUBE_FACES · block + face], −1: none
    int *first_link;          // [entry_count + 1]
    struct mrt_link *links;   // of each entry in the order of sources
    struct matrix_f32 *holes; // [CUBE_FACES · block + face] what holes pass, while links are made
    int link_stride;          // k_r, rounded up to MRT_LANES; the rest is 0
    float *matrices;
};

// FAIL_UNSUPPORTED with the name of a block for which the dictionary has no cube: a shape without
// floor or ceiling, or neighbours that are tilted against each other, in a dictionary for
// two-dimensional mazes; cylinders in a dictionary of cubes (see mrt_block_map_as_cubes), cubes in
// one of tubes.
bool mrt_level_init(struct host *host, const struct mrt_block_map *map,
                    const struct mrt_dictionary *dictionary,
                    const struct mrt_level_options *options, struct mrt_level *level);
void mrt_level_finish(struct mrt_level *level); // accepts zero

static inline struct mrt_shape mrt_level_cell(const struct mrt_level *level, int block)
{
    return mrt_block_shape(&level->map->blocks[block], level->resolution);
}

// The bases of a block that replace those of its cube; NULL: none do.
static inline const struct mrt_retraced *mrt_level_retraced(const struct mrt_level *level,
                                                            int block)
{
    const int i = level->retraces.of_block ? level->retraces.of_block[block] : -1;
    return i < 0 ? NULL : &level->retraces.at[i];
}

// ---- paths.c

// Light that one block sends: a matrix k_r × k_b for each entry that it reaches.
struct mrt_sent {
    struct host *host;
    int *entry; // ascending
    float *matrices;
    int count;
};
bool mrt_send_from(struct host *host, const struct mrt_level *level, int block, int max_depth,
                   struct mrt_sent *out);
void mrt_sent_finish(struct mrt_sent *sent);
