#include "techniques/mrt/runtime/objects.h"

#include <assert.h>
#include <string.h>

// ---- planning

static struct mrt_plan_item *new_item(struct mrt_runtime *runtime, const void *handle)
{
    struct mrt_plan *plan = runtime->plan;
    if (plan->count == plan->capacity) {
        const size_t capacity = plan->capacity ? 2 * plan->capacity : 64;
        struct mrt_plan_item *items =
            host_realloc(plan->host, plan->items, capacity, sizeof *items);
        if (!items) return NULL;
        plan->items = items;
        plan->capacity = capacity;
    }
    struct mrt_plan_item *item = &plan->items[plan->count++];
    *item = (struct mrt_plan_item){ 0 };
    item->handle = (size_t)((const char *)handle - (const char *)runtime);
    assert(item->handle < sizeof *runtime);
    return item;
}

static bool plan_buffer(struct mrt_runtime *runtime, const char *name, const void *data,
                        size_t bytes, gpu_buffer *out)
{
    struct mrt_plan_item *item = new_item(runtime, out);
    if (!item) return false;
    item->kind = MRT_PLAN_BUFFER;
    item->name = name;
    item->bytes = bytes;
    if (!data || bytes == 0) return true;
    item->data = host_alloc(runtime->plan->host, bytes, 1);
    if (item->data) memcpy(item->data, data, bytes);
    return item->data;
}

static bool create_buffer(struct gpu *gpu, const char *name, size_t bytes, gpu_buffer *out)
{
    const struct gpu_buffer_desc desc = { name, bytes ? bytes : 16, GPU_BUFFER_STORAGE };
    return gpu_buffer_create(gpu, &desc, out);
}

bool mrt_buffer_of(struct mrt_runtime *runtime, const char *name, const void *data, size_t bytes,
                   gpu_buffer *out)
{
    if (runtime->plan) return plan_buffer(runtime, name, data, bytes, out);
    return create_buffer(runtime->gpu, name, bytes, out) &&
           (!data || bytes == 0 || gpu_buffer_upload(runtime->gpu, *out, 0, data, bytes));
}

bool mrt_table_upload(struct mrt_runtime *runtime, const struct mrt_runtime_input *input,
                      const char *name, size_t count, size_t size,
                      void (*fill)(const struct mrt_runtime_input *input, void *items),
                      gpu_buffer *out)
{
    void *items = host_alloc(runtime->host, count, size);
    if (!items) return false;
    if (fill) fill(input, items);
    const bool ok = mrt_buffer_of(runtime, name, items, count * size, out);
    host_free(runtime->host, items);
    return ok;
}

bool mrt_image_of(struct mrt_runtime *runtime, const struct gpu_image_desc *desc, gpu_image *out)
{
    if (!runtime->plan) return gpu_image_create(runtime->gpu, desc, out);
    struct mrt_plan_item *item = new_item(runtime, out);
    if (!item) return false;
    item->kind = MRT_PLAN_IMAGE;
    item->image = *desc;
    return true;
}

bool mrt_pipeline_of(struct mrt_runtime *runtime, const char *name, const struct gpu_shader *shader,
                     const struct gpu_constant *constants, int count, gpu_pipeline *out)
{
    if (!runtime->plan)
        return gpu_compute_pipeline_create(runtime->gpu, name, shader, constants, count, out);
    struct mrt_plan_item *item = new_item(runtime, out);
    if (!item) return false;
    assert(count <= MRT_PLAN_CONSTANTS);
    item->kind = MRT_PLAN_PIPELINE;
    item->name = name;
    item->shader = shader;
    item->constant_count = count;
    if (count > 0) memcpy(item->constants, constants, (size_t)count * sizeof *constants);
    return true;
}

// ---- creation

static bool create(const struct mrt_plan_item *item, struct mrt_runtime *runtime)
{
    void *handle = (char *)runtime + item->handle;
    if (item->kind == MRT_PLAN_BUFFER)
        return create_buffer(runtime->gpu, item->name, item->bytes, handle);
    if (item->kind == MRT_PLAN_IMAGE) return gpu_image_create(runtime->gpu, &item->image, handle);
    return gpu_compute_pipeline_create(runtime->gpu, item->name, item->shader, item->constants,
                                       item->constant_count, handle);
}

bool mrt_plan_create(const struct mrt_plan *plan, struct mrt_runtime *runtime)
{
    for (size_t i = 0; i < plan->count; i++)
        if (!create(&plan->items[i], runtime)) return false;
    return true;
}

bool mrt_plan_record(struct mrt_plan *plan, const struct mrt_runtime *runtime, struct gpu_cmd *cmd,
                     size_t most)
{
    while (plan->item < plan->count) {
        const struct mrt_plan_item *item = &plan->items[plan->item];
        const size_t left = item->data ? item->bytes - plan->offset : 0;
        const size_t bytes = left < most ? left : most;
        if (bytes > 0) {
            const gpu_buffer *to =
                (const gpu_buffer *)(const void *)((const char *)runtime + item->handle);
            const struct gpu_binding from =
                gpu_transient(cmd, item->name, (const char *)item->data + plan->offset, bytes);
            gpu_copy_buffer(cmd, *to, plan->offset, from.buffer, from.offset, bytes);
        }
        plan->offset += bytes;
        most -= bytes;
        if (bytes < left) return false;
        plan->item++;
        plan->offset = 0;
    }
    return true;
}

void mrt_plan_finish(struct mrt_plan *plan)
{
    for (size_t i = 0; i < plan->count; i++) host_free(plan->host, plan->items[i].data);
    if (plan->host) host_free(plan->host, plan->items);
    *plan = (struct mrt_plan){ 0 };
}
