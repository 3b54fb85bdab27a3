// Tables of the GPU in images.
#include "techniques/common/light_map/table.h"

static size_t rows_of(size_t count)
{
    return count > 0 ? (count + LIGHT_MAP_TABLE_WIDTH - 1) / LIGHT_MAP_TABLE_WIDTH : 1;
}

size_t light_map_table_capacity(size_t count)
{
    return rows_of(count) * LIGHT_MAP_TABLE_WIDTH;
}

struct gpu_image_desc light_map_table(enum gpu_format format, size_t count)
{
    return (struct gpu_image_desc){ .format = format,
                                    .width = LIGHT_MAP_TABLE_WIDTH,
                                    .height = (uint32_t)rows_of(count),
                                    .usage = GPU_SAMPLED | GPU_STORAGE };
}

static bool create_table(struct host *host, struct gpu *gpu, const char *name,
                         enum gpu_format format, size_t count, gpu_image *out)
{
    const size_t rows = rows_of(count), most = gpu_limits(gpu)->max_image_2d;
    struct gpu_image_desc desc = light_map_table(format, count);
    if (rows > most)
        return host_fail(host, FAIL_UNSUPPORTED,
                         "light map: its table of %s has %zu entries, above the limit of %s, %zu; "
                         "give fewer texels",
                         name, count, gpu_info(gpu)->name, most * LIGHT_MAP_TABLE_WIDTH);
    desc.name = name;
    return gpu_image_create(gpu, &desc, out);
}

bool light_map_table_upload(struct host *host, struct gpu *gpu, const char *name,
                            enum gpu_format format, void *entries, size_t count, gpu_image *out)
{
    const size_t bytes = light_map_table_capacity(count) * (size_t)gpu_format_bytes(format);
    const bool ok = entries && create_table(host, gpu, name, format, count, out) &&
                    gpu_image_upload(gpu, *out, 0, 0, entries, bytes);
    host_free(host, entries);
    return ok;
}

bool light_map_buffer_upload(struct host *host, struct gpu *gpu, const char *name, void *items,
                             size_t bytes, gpu_buffer *out)
{
    const struct gpu_buffer_desc desc = { name, bytes, GPU_BUFFER_STORAGE };
    const bool ok = items && gpu_buffer_create(gpu, &desc, out) &&
                    gpu_buffer_upload(gpu, *out, 0, items, bytes);
    host_free(host, items);
    return ok;
}
