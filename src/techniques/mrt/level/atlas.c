// Tiles of the light map, and lookups.
#include "atlas.h"

#include "techniques/mrt/level/wall.h"

#include <math.h>

static int borders_of_tile(int resolution)
{
    return 4 * resolution + 4;
}

static void count_walls(const struct mrt_block_map *map, struct mrt_atlas *atlas)
{
    for (int b = 0; b < map->count; b++)
        for (int f = 0; f < CUBE_FACES; f++)
            atlas->tile_count += mrt_block_has_wall(&map->blocks[b], f);
}

// Tiles in rows, in about a square.
static void place_tiles(const struct mrt_block_map *map, struct mrt_atlas *atlas)
{
    int n = atlas->resolution, edge = n + 2, tile = 0;
    int columns = (int)ceilf(sqrtf((float)atlas->tile_count));
    for (int i = 0; i < CUBE_FACES * map->count; i++) {
        int block = i / CUBE_FACES, face = i % CUBE_FACES;
        atlas->tile_of_face[i] = -1;
        if (!mrt_block_has_wall(&map->blocks[block], face)) continue;
        atlas->tile_of_face[i] = tile;
        atlas->tiles[tile] =
            (struct mrt_tile){ block, face, tile * n * n, tile % columns * edge + 1,
                               tile / columns * edge + 1 };
        tile++;
    }
    atlas->texels = tile * n * n;
    atlas->width = columns * edge;
    atlas->height = (tile + columns - 1) / columns * edge;
}

bool mrt_atlas_init(struct host *host, const struct mrt_block_map *map, int resolution,
                    struct mrt_atlas *atlas)
{
    *atlas = (struct mrt_atlas){ .host = host, .resolution = resolution };
    count_walls(map, atlas);
    size_t tiles = (size_t)atlas->tile_count;
    size_t borders = tiles * (size_t)borders_of_tile(resolution);
    atlas->tiles = host_alloc(host, tiles, sizeof *atlas->tiles);
    atlas->tile_of_face =
        host_alloc(host, CUBE_FACES * (size_t)map->count, sizeof *atlas->tile_of_face);
    atlas->borders = host_alloc(host, borders, sizeof *atlas->borders);
    if (!atlas->tiles || !atlas->tile_of_face || !atlas->borders) {
        mrt_atlas_finish(atlas);
        return false;
    }
    place_tiles(map, atlas);
    for (int t = 0; t < atlas->tile_count; t++)
        mrt_atlas_make_borders(map, atlas, t,
                               atlas->borders + (size_t)t * (size_t)borders_of_tile(resolution));
    atlas->border_count = (int)borders;
    return true;
}

void mrt_atlas_finish(struct mrt_atlas *atlas)
{
    if (atlas->host) {
        host_free(atlas->host, atlas->tiles);
        host_free(atlas->host, atlas->tile_of_face);
        host_free(atlas->host, atlas->borders);
    }
    *atlas = (struct mrt_atlas){ 0 };
}
