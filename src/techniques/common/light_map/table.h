// Tables of the GPU in 2D images: entry i is the texel (i mod LIGHT_MAP_TABLE_WIDTH, i /
// LIGHT_MAP_TABLE_WIDTH). A driver on a processor loads the words of a storage buffer one after
// another, for each invocation, but a texel of 16 bytes at once.
#pragma once

#include "gpu/gpu.h"
#include "scene/charts/seams.h"

#include "techniques/common/light_map/map_shared.h"

// Entries that the image has, at least `count` and 1: whole rows of it.
size_t light_map_table_capacity(size_t count);
// The image, without a name.
struct gpu_image_desc light_map_table(enum gpu_format format, size_t count);
// A table with these entries, in memory for light_map_table_capacity(count), which is freed with
// host_free in any case. NULL: false, as beyond the limits of the device.
bool light_map_table_upload(struct host *host, struct gpu *gpu, const char *name,
                            enum gpu_format format, void *entries, size_t count, gpu_image *out);
// A storage buffer of these items, likewise.
bool light_map_buffer_upload(struct host *host, struct gpu *gpu, const char *name, void *items,
                             size_t bytes, gpu_buffer *out);

static inline uint64_t light_map_table_bytes(uint64_t entries, uint64_t bytes)
{
    return light_map_table_capacity((size_t)entries) * bytes;
}

// Sums of texels in a table, entries in pairs: [pair][row][LIGHT_MAP_PAIR].
static inline struct chart_share *light_map_share_at(struct chart_share *table, size_t rows,
                                                     size_t row, size_t entry)
{
    return &table[LIGHT_MAP_PAIR * (entry / LIGHT_MAP_PAIR * rows + row) + entry % LIGHT_MAP_PAIR];
}
