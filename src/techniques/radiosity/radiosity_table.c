// Tables of the GPU in images.
#include "techniques/radiosity/radiosity_table.h"

#include "techniques/radiosity/radiosity_shared.h"

static size_t rows_of(size_t count)
{
    return count > 0 ? (count + RADIOSITY_TABLE_WIDTH - 1) / RADIOSITY_TABLE_WIDTH : 1;
}

size_t radiosity_table_room(size_t count)
{
    return rows_of(count) * RADIOSITY_TABLE_WIDTH;
}

static bool create_table(struct host *host, struct gpu *gpu, const char *name,
                         enum gpu_format format, size_t count, gpu_image *out)
{
    const size_t rows = rows_of(count), most = gpu_limits(gpu)->max_image_2d;
    const struct gpu_image_desc desc = { .name = name,
                                         .format = format,
                                         .width = RADIOSITY_TABLE_WIDTH,
                                         .height = (uint32_t)rows,
                                         .usage = GPU_SAMPLED | GPU_STORAGE };
    if (rows > most)
        return host_fail(host, FAIL_UNSUPPORTED,
                         "radiosity: its %s have %zu entries, above the limit of %s, %zu: give "
                         "fewer texels or sources",
                         name, count, gpu_info(gpu)->name, most * RADIOSITY_TABLE_WIDTH);
    return gpu_image_create(gpu, &desc, out);
}

bool radiosity_table_upload(struct host *host, struct gpu *gpu, const char *name,
                            enum gpu_format format, void *entries, size_t count, gpu_image *out)
{
    const size_t bytes = radiosity_table_room(count) * (size_t)gpu_format_bytes(format);
    const bool ok = entries && create_table(host, gpu, name, format, count, out) &&
                    gpu_image_upload(gpu, *out, 0, 0, entries, bytes);
    host_free(host, entries);
    return ok;
}
