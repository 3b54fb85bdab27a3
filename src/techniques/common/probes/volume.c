#include "techniques/common/probes/volume.h"

#include <math.h>
#include <string.h>

enum { TILE = PROBE_DEPTH_TILE };

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

static void fill_tile(const uint16_t *depth, uint32_t probe, uint32_t columns, uint16_t *texels)
{
    const size_t width = (size_t)columns * TILE;
    const uint16_t *from = depth + 2 * TILE * TILE * (size_t)probe;
    const size_t first = probe / columns * TILE * width + probe % columns * TILE;
    for (size_t y = 0; y < TILE; y++)
        memcpy(texels + 2 * (first + y * width), from + 2 * TILE * y, 2 * TILE * sizeof *texels);
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
