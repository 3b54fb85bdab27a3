#include "techniques/mrt/gpu/upload.h"

#include <assert.h>
#include <string.h>

// The object of a member of the run time.
static bool add(struct mrt_runtime *runtime, struct gpu_object row, const void *member)
{
    struct gpu_objects *table = &runtime->objects;
    row.member = (size_t)((const char *)member - (const char *)runtime);
    assert(row.member < sizeof *runtime);
    gpu_objects_add(table, 0, &row, 1);
    return runtime->plan ? table->left_out == 0
                         : gpu_objects_create(runtime->gpu, table, table->count - 1, runtime);
}

static bool keep(struct mrt_plan *plan, int row, const void *data, size_t bytes)
{
    plan->data[row] = host_alloc(plan->host, bytes, 1);
    if (plan->data[row]) memcpy(plan->data[row], data, bytes);
    return plan->data[row];
}

bool mrt_buffer_of(struct mrt_runtime *runtime, const char *name, const void *data, size_t bytes)
{
    const struct gpu_object row = { GPU_BUFFER, name + strlen("mrt_"),
                                    .bytes = bytes ? bytes : 16 };
    const int index = runtime->buffer_count++;
    assert(index < MRT_MAX_BUFFERS);
    runtime->buffer_names[index] = name;
    if (!add(runtime, row, &runtime->buffers[index])) return false;
    if (!data || bytes == 0) return true;
    return runtime->plan ? keep(runtime->plan, runtime->objects.count - 1, data, bytes)
                         : gpu_buffer_upload(runtime->gpu, runtime->buffers[index], 0, data, bytes);
}

bool mrt_table_upload(struct mrt_runtime *runtime, const struct mrt_runtime_input *input,
                      const char *name, size_t count, size_t size,
                      void (*fill)(const struct mrt_runtime_input *input, void *items))
{
    void *items = host_alloc(runtime->host, count, size);
    if (!items) return false;
    if (fill) fill(input, items);
    const bool ok = mrt_buffer_of(runtime, name, items, count * size);
    host_free(runtime->host, items);
    return ok;
}

gpu_buffer mrt_buffer(const struct mrt_runtime *runtime, const char *name)
{
    for (int i = 0; i < runtime->buffer_count; i++)
        if (strcmp(runtime->buffer_names[i], name) == 0) return runtime->buffers[i];
    return (gpu_buffer){ 0 };
}

static bool has_name(const struct gpu_binding *bindings, int count, const char *name)
{
    for (int i = 0; i < count; i++)
        if (strcmp(bindings[i].name, name) == 0) return true;
    return false;
}

enum { MAX_BINDINGS = 32, MAX_ALL_BINDINGS = MAX_BINDINGS + 1 + MRT_MAX_BUFFERS };

// Adds the parameters and buffers of the level. Returns the number of all.
static int bind_level(const struct mrt_runtime *runtime, struct gpu_cmd *cmd,
                      const struct gpu_binding *bindings, int binding_count,
                      struct gpu_binding all[MAX_ALL_BINDINGS])
{
    int count = binding_count;
    assert(count <= MAX_BINDINGS);
    for (int i = 0; i < binding_count; i++) all[i] = bindings[i];
    if (!has_name(bindings, binding_count, "mrt_level"))
        all[count++] = gpu_transient(cmd, "mrt_level", &runtime->level, sizeof runtime->level);
    for (int i = 0; i < runtime->buffer_count; i++)
        if (!has_name(bindings, binding_count, runtime->buffer_names[i]))
            all[count++] = (struct gpu_binding){ .name = runtime->buffer_names[i],
                                                 .buffer = runtime->buffers[i] };
    return count;
}

void mrt_dispatch(const struct mrt_runtime *runtime, struct gpu_cmd *cmd, gpu_pipeline pipeline,
                  const struct gpu_binding *bindings, int binding_count, const void *push,
                  size_t push_bytes, uint32_t groups_x, uint32_t groups_y, uint32_t groups_z)
{
    struct gpu_binding all[MAX_ALL_BINDINGS];
    const int count = bind_level(runtime, cmd, bindings, binding_count, all);
    gpu_dispatch(cmd, pipeline, all, count, push, push_bytes, groups_x, groups_y, groups_z);
}

void mrt_dispatch_indirect(const struct mrt_runtime *runtime, struct gpu_cmd *cmd,
                           gpu_pipeline pipeline, const struct gpu_binding *bindings,
                           int binding_count, gpu_buffer arguments, size_t offset)
{
    struct gpu_binding all[MAX_ALL_BINDINGS];
    const int count = bind_level(runtime, cmd, bindings, binding_count, all);
    gpu_dispatch_indirect(cmd, pipeline, all, count, NULL, 0, arguments, offset);
}

bool mrt_image_of(struct mrt_runtime *runtime, const struct gpu_image_desc *desc, gpu_image *out)
{
    return add(runtime, (struct gpu_object){ GPU_IMAGE, desc->name, .image = *desc }, out);
}

bool mrt_sampler_of(struct mrt_runtime *runtime, const char *name, gpu_sampler *out)
{
    return add(runtime, (struct gpu_object){ .kind = GPU_SAMPLER, .name = name }, out);
}

bool mrt_pipeline_of(struct mrt_runtime *runtime, const char *name, const struct gpu_shader *shader,
                     uint32_t constants, gpu_pipeline *out)
{
    const struct gpu_object row = { GPU_PIPELINE, name, .shader = shader, .consts = constants };
    return add(runtime, row, out);
}

bool mrt_plan_record(struct mrt_plan *plan, const struct mrt_runtime *runtime, struct gpu_cmd *cmd,
                     size_t most)
{
    while (plan->item < runtime->objects.count) {
        const struct gpu_object *item = &runtime->objects.at[plan->item];
        const char *data = plan->data[plan->item];
        const size_t left = data ? item->bytes - plan->offset : 0;
        const size_t bytes = left < most ? left : most;
        if (bytes > 0) {
            const gpu_buffer *to =
                (const gpu_buffer *)(const void *)((const char *)runtime + item->member);
            const struct gpu_binding from =
                gpu_transient(cmd, item->name, data + plan->offset, bytes);
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
    for (int i = 0; plan->host && i < GPU_MAX_OBJECTS; i++) host_free(plan->host, plan->data[i]);
    *plan = (struct mrt_plan){ 0 };
}
