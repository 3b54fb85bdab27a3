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

static void fill_tile(const struct mrt_atlas *atlas, const struct mrt_tile *tile,
                      const float *values, int channels, float *out)
{
    int n = atlas->resolution, row = n * channels;
    for (int y = 0; y < n; y++) {
        const float *from = values + (size_t)(tile->first_texel + y * n) * (size_t)channels;
        float *to = out + ((size_t)(tile->y + y) * (size_t)atlas->width + (size_t)tile->x) *
                              (size_t)channels;
        for (int i = 0; i < row; i++) to[i] = from[i];
    }
}

void mrt_atlas_fill(const struct mrt_atlas *atlas, const float *values, int channels, float *out)
{
    for (int t = 0; t < atlas->tile_count; t++)
        fill_tile(atlas, &atlas->tiles[t], values, channels, out);
    for (int i = 0; i < atlas->border_count; i++) {
        const struct mrt_border *border = &atlas->borders[i];
        for (int c = 0; c < channels; c++) {
            float sum = 0.0f;
            for (uint32_t k = 0; k < border->count; k++)
                sum += border->weight[k] * values[border->source[k] * (size_t)channels + (size_t)c];
            out[border->texel * (size_t)channels + (size_t)c] = sum;
        }
    }
}

vec2s mrt_atlas_place(const struct mrt_atlas *atlas, int tile, float s, float t)
{
    const struct mrt_tile *at = &atlas->tiles[tile];
    float n = (float)atlas->resolution;
    return (vec2s){ { (float)at->x + s * n, (float)at->y + t * n } };
}

float mrt_atlas_look_up(const struct mrt_atlas *atlas, const float *filled, int channels,
                        int channel, vec2s place)
{
    float x = place.x - 0.5f, y = place.y - 0.5f, sum = 0.0f;
    int left = (int)floorf(x), top = (int)floorf(y);
    float a = x - (float)left, b = y - (float)top;
    for (int k = 0; k < 4; k++) {
        int i = left + (k & 1), j = top + (k >> 1);
        float weight = (k & 1 ? a : 1.0f - a) * (k >> 1 ? b : 1.0f - b);
        if (weight == 0.0f) continue; // at the border's far side
        sum += weight * filled[((size_t)j * (size_t)atlas->width + (size_t)i) * (size_t)channels +
                               (size_t)channel];
    }
    return sum;
}
