// The light map of a level (Loos 2015, sections 3.5.2 and 4.6): one tile for each wall of each
// block, with a border of one texel. Bilinear lookup along the edge of a tile gives the same value
// as along the edge of the wall that continues it in a connected block. At creases and beside
// openings without such a wall the border repeats the tile. A tube's tile goes on around it.
//
// Light is known at the level's texels: those of mrt_block_shape(resolution) of each block, block
// after block.
#pragma once

#include "techniques/mrt/level/block_map.h"

enum { MRT_BORDER_SOURCES = 8 };

// A texel of the border: a weighted sum of texels of the level. Weights sum to 1.
struct mrt_border {
    uint32_t texel; // of the atlas: y · width + x
    uint32_t count;
    uint32_t source[MRT_BORDER_SOURCES];
    float weight[MRT_BORDER_SOURCES];
};

// A wall of a block, whose texel (x, y) is first_texel + y · resolution + x.
struct mrt_tile {
    int block, face;
    int first_texel;
    int x, y; // of its first texel in the atlas, inside the border
};

struct mrt_atlas {
    struct host *host;
    int resolution, width, height; // texels
    int texels;                    // of the level
    struct mrt_tile *tiles;
    int tile_count;
    int *tile_of_face; // [CUBE_FACES · block + face], −1: an opening; of a tube face 0 alone
    struct mrt_border *borders;
    int border_count;
};

bool mrt_atlas_init(struct host *host, const struct mrt_block_map *map, int resolution,
                    struct mrt_atlas *atlas);
void mrt_atlas_finish(struct mrt_atlas *atlas); // accepts zero

// ---- atlas_border.c

// A corner of a wall.
struct mrt_wall_corner {
    int block, face;
    int corner; // 0…3, of the face
};
// Crosses the edge from this corner to the next one (forward), or to the one before: to the wall
// that continues this one in a connected block. False: there is none, or the walls enclose an
// angle.
bool mrt_wall_continues(const struct mrt_block_map *map, struct mrt_wall_corner from, bool forward,
                        struct mrt_wall_corner *to);
// Fills the borders of a tile: 4 · resolution + 4.
void mrt_atlas_make_borders(const struct mrt_block_map *map, const struct mrt_atlas *atlas,
                            int tile, struct mrt_border *out);
