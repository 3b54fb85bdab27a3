#include "techniques/common/probes/copy.h"

#include "techniques/common/probes/grid.h"

enum { COEFFICIENTS = 27, TILE = PROBE_DEPTH_TILE, TILE_VALUES = 2 * TILE * TILE };

// The texels of an image.
struct texels {
    float *values;
    size_t width, height;
    size_t channels;
};

static bool download(struct host *host, struct gpu *gpu, gpu_image image, int channels,
                     struct texels *out)
{
    const struct gpu_image_desc *size = gpu_image_info(gpu, image);
    const size_t depth = size->depth > 0 ? size->depth : 1;
    *out = (struct texels){ NULL, size->width, size->height, (size_t)channels };
    const size_t count = out->width * out->height * depth * out->channels;
    out->values = host_alloc(host, count, sizeof *out->values);
    return out->values && gpu_image_download_float(gpu, image, 0, 0, out->values, channels, count);
}

// The texel of a probe in a slab of the volume.
static const float *slab_of(const struct texels *volume, struct frame_probes grid, uint32_t probe,
                            int slab)
{
    const size_t columns = (size_t)grid.count_x, rows = (size_t)grid.count_y;
    const size_t z = probe / (columns * rows) + (size_t)slab * (size_t)grid.slab;
    const size_t row = z * volume->height + probe / columns % rows;
    return volume->values + 4 * (row * volume->width + probe % columns);
}

static void unpack_coefficients(const struct texels *volume, float scale, struct probe_copy *out)
{
    float *to = out->coefficients;
    for (uint32_t i = 0; i < probe_grid_count(out->grid); i++)
        for (int k = 0; k < COEFFICIENTS; k++)
            *to++ = slab_of(volume, out->grid, i, k / 4)[k % 4] / scale;
}

static void unpack_offsets(const struct texels *volume, struct probe_copy *out)
{
    for (uint32_t i = 0; out->offsets && i < probe_grid_count(out->grid); i++)
        for (int k = 0; k < 4; k++)
            out->offsets[4 * i + (uint32_t)k] = slab_of(volume, out->grid, i, FRAME_PROBE_SLABS)[k];
}

static void unpack_walls(const struct texels *volume, struct probe_copy *out)
{
    for (uint32_t i = 0; out->walls && i < probe_grid_count(out->grid); i++)
        for (uint32_t k = 0; k < 6; k++)
            out->walls[6 * i + k] =
                slab_of(volume, out->grid, i, FRAME_PROBE_SLABS + (int)(k % 2))[k / 2];
}

// From an atlas of tiles to one tile behind the other.
static void unpack_depths(const struct texels *atlas, struct probe_copy *out)
{
    const size_t columns = atlas->width / TILE;
    float *to = out->depths;
    for (size_t i = 0; i < probe_grid_count(out->grid); i++)
        for (size_t k = 0; k < TILE_VALUES; k++) {
            const size_t y = i / columns * TILE + k / (2 * TILE);
            *to++ = atlas->values[2 * (y * atlas->width + i % columns * TILE) + k % (2 * TILE)];
        }
}

static float *values_of(struct host *host, const struct probe_copy *copy, size_t each)
{
    return host_alloc(host, probe_grid_count(copy->grid), each * sizeof(float));
}

static bool allocate(struct host *host, struct probe_copy *out)
{
    const bool depths = out->visibility == PROBE_VISIBILITY_DEPTHS,
               walls = out->visibility == PROBE_VISIBILITY_WALLS;
    return (out->coefficients = values_of(host, out, COEFFICIENTS)) &&
           (!depths || (out->offsets = values_of(host, out, 4))) &&
           (!depths || (out->depths = values_of(host, out, TILE_VALUES))) &&
           (!walls || (out->walls = values_of(host, out, 6)));
}

bool probe_copy_create(struct host *host, struct gpu *gpu, const struct probe_volume *volume,
                       float scale, struct probe_copy *out)
{
    struct texels light = { 0 }, atlas = { 0 };
    *out =
        (struct probe_copy){ .grid = volume->grid, .visibility = probe_volume_visibility(volume) };
    const bool ok = allocate(host, out) && download(host, gpu, volume->image, 4, &light) &&
                    (!out->depths || download(host, gpu, volume->depth, 2, &atlas));
    if (ok) {
        unpack_coefficients(&light, scale, out);
        unpack_offsets(&light, out);
        unpack_walls(&light, out);
        if (out->depths) unpack_depths(&atlas, out);
    }
    host_free(host, light.values);
    host_free(host, atlas.values);
    if (!ok) probe_copy_finish(host, out);
    return ok;
}

void probe_copy_finish(struct host *host, struct probe_copy *copy)
{
    host_free(host, copy->coefficients);
    host_free(host, copy->offsets);
    host_free(host, copy->depths);
    host_free(host, copy->walls);
    *copy = (struct probe_copy){ 0 };
}
