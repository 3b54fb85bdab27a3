#include "techniques/common/probes/volume.h"

#include <math.h>
#include <string.h>

enum { SIDE = PROBE_DEPTH_SIDE, TILE = PROBE_DEPTH_TILE };

struct gpu_image_desc probe_volume_desc(const char *name, struct frame_probes grid, int slabs)
{
    return (struct gpu_image_desc){ .name = name,
                                    .dimension = GPU_3D,
                                    .format = GPU_RGBA16F,
                                    .width = (uint32_t)grid.count_x,
                                    .height = (uint32_t)grid.count_y,
                                    .depth = (uint32_t)(slabs * grid.slab),
                                    .usage = GPU_SAMPLED | GPU_STORAGE };
}

// The square of an octahedral map in a texel of its tile: beyond an edge the map continues at the
// same edge, mirrored.
static int square_of(int x, int y)
{
    x -= 1;
    y -= 1;
    if (x < 0 || x >= SIDE) {
        x = x < 0 ? 0 : SIDE - 1;
        y = SIDE - 1 - y;
    }
    if (y < 0 || y >= SIDE) {
        y = y < 0 ? 0 : SIDE - 1;
        x = SIDE - 1 - x;
    }
    return y * SIDE + x;
}

static void fill_tile(const uint16_t *depth, uint32_t probe, uint32_t columns, uint16_t *texels)
{
    const size_t width = (size_t)columns * TILE;
    const uint16_t *from = depth + 2 * SIDE * SIDE * (size_t)probe;
    const size_t first = probe / columns * TILE * width + probe % columns * TILE;
    for (int y = 0; y < TILE; y++)
        for (int x = 0; x < TILE; x++)
            memcpy(texels + 2 * (first + (size_t)y * width + (size_t)x), from + 2 * square_of(x, y),
                   2 * sizeof *texels);
}

bool probe_depth_create(struct host *host, struct gpu *gpu, uint32_t probes, const uint16_t *depth,
                        gpu_image *out)
{
    const uint32_t columns = (uint32_t)ceil(sqrt((double)probes));
    const uint32_t rows = (probes + columns - 1) / columns;
    const struct gpu_image_desc desc = { .name = "probe_depth",
                                         .format = GPU_RG16F,
                                         .width = columns * TILE,
                                         .height = rows * TILE,
                                         .usage = GPU_SAMPLED };
    const size_t texels = (size_t)desc.width * desc.height;
    uint16_t *values = host_alloc(host, texels, 2 * sizeof *values);
    for (uint32_t i = 0; values && i < probes; i++) fill_tile(depth, i, columns, values);
    const bool ok = values && gpu_image_create(gpu, &desc, out) &&
                    gpu_image_upload(gpu, *out, 0, 0, values, texels * 4);
    host_free(host, values);
    return ok;
}
