// Tables of the objects of a state: creation, destruction and size by one list.
#include "gpu/vk.h"

void gpu_objects_clear(struct gpu_objects *table)
{
    table->count = table->left_out = 0;
}

void gpu_objects_add(struct gpu_objects *table, size_t base, const struct gpu_object *rows,
                     size_t count)
{
    for (size_t i = 0; i < count; i++) {
        if (table->count == GPU_MAX_OBJECTS) {
            table->left_out++;
            continue;
        }
        table->at[table->count] = rows[i];
        table->at[table->count++].member += base;
    }
}

static bool create_buffer(struct gpu *gpu, const struct gpu_object *o, gpu_buffer *out)
{
    const struct gpu_buffer_desc desc = { o->name, o->bytes, GPU_BUFFER_STORAGE | o->usage };
    return o->bytes == 0 || gpu_buffer_create(gpu, &desc, out);
}

static bool create_image(struct gpu *gpu, const struct gpu_object *o, gpu_image *out)
{
    struct gpu_image_desc desc = o->image;
    desc.name = o->name;
    return desc.width == 0 || gpu_image_create(gpu, &desc, out);
}

static bool get_sampler(struct gpu *gpu, const struct gpu_object *o, gpu_sampler *out)
{
    const struct gpu_sampler_desc desc = { .name = o->name,
                                           .filter = GPU_LINEAR,
                                           .wrap_u = GPU_CLAMP,
                                           .wrap_v = GPU_CLAMP,
                                           .wrap_w = GPU_CLAMP };
    return gpu_sampler_get(gpu, &desc, out);
}

static bool create_pipeline(struct gpu *gpu, const struct gpu_objects *table,
                            const struct gpu_object *o, gpu_pipeline *out)
{
    struct gpu_constant constants[GPU_MAX_CONSTANTS];
    int count = 0;
    for (int i = 0; i < GPU_MAX_CONSTANTS; i++)
        if (o->consts >> i & 1u) constants[count++] = table->constants[i];
    const struct gpu_graphics_desc desc = { .name = o->name,
                                            .vertex = o->vertex,
                                            .fragment = o->shader,
                                            .constants = constants,
                                            .constant_count = count };
    if (!o->shader) return true;
    return o->vertex ? gpu_graphics_pipeline_create(gpu, &desc, out)
                     : gpu_compute_pipeline_create(gpu, o->name, o->shader, constants, count, out);
}

static bool create(struct gpu *gpu, const struct gpu_objects *table, const struct gpu_object *o,
                   void *member)
{
    switch (o->kind) {
    case GPU_BUFFER:
        return create_buffer(gpu, o, member);
    case GPU_READBACK:
        return o->bytes == 0 || gpu_readback_create(gpu, o->name, o->bytes, member);
    case GPU_IMAGE:
        return create_image(gpu, o, member);
    case GPU_SAMPLER:
        return get_sampler(gpu, o, member);
    default:
        return create_pipeline(gpu, table, o, member);
    }
}

bool gpu_objects_create(struct gpu *gpu, const struct gpu_objects *table, int first, void *state)
{
    if (table->left_out > 0)
        return host_fail(gpu->host, FAIL_UNSUPPORTED, "gpu objects: %d, the limit is %d",
                         table->count + table->left_out, GPU_MAX_OBJECTS);
    for (int i = first; i < table->count; i++)
        if (!create(gpu, table, &table->at[i], (char *)state + table->at[i].member)) return false;
    return true;
}

bool gpu_objects_compile(struct gpu *compiler, const struct gpu_objects *table)
{
    gpu_pipeline unused;
    for (int i = 0; i < table->count; i++)
        if (table->at[i].kind == GPU_PIPELINE &&
            !create_pipeline(compiler, table, &table->at[i], &unused))
            return false;
    return true;
}

void gpu_objects_destroy(struct gpu *gpu, const struct gpu_objects *table, void *state)
{
    for (int i = 0; i < table->count; i++) {
        void *member = (char *)state + table->at[i].member;
        if (table->at[i].kind == GPU_BUFFER) gpu_buffer_destroy(gpu, member);
        if (table->at[i].kind == GPU_READBACK) gpu_readback_destroy(gpu, member);
        if (table->at[i].kind == GPU_IMAGE) gpu_image_destroy(gpu, member);
        if (table->at[i].kind == GPU_PIPELINE) gpu_pipeline_destroy(gpu, member);
    }
}

static uint64_t halved(uint32_t size, uint32_t mip)
{
    return size >> mip ? size >> mip : 1;
}

static uint64_t image_bytes(const struct gpu_image_desc *image)
{
    uint64_t texels = 0;
    for (uint32_t mip = 0; image->width > 0 && (mip == 0 || mip < image->mips); mip++)
        texels += halved(image->width, mip) * halved(image->height, mip) *
                  halved(image->depth, image->dimension == GPU_3D ? mip : 0);
    return texels * (uint64_t)gpu_format_bytes(image->format);
}

uint64_t gpu_objects_bytes(const struct gpu_objects *table)
{
    uint64_t bytes = 0;
    for (int i = 0; i < table->count; i++) {
        const struct gpu_object *o = &table->at[i];
        bytes += o->kind == GPU_IMAGE ? image_bytes(&o->image) : o->bytes;
    }
    return bytes;
}
