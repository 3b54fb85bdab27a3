// Buffers: device-local ones of the caller, and mapped ones of this layer.
#include "gpu/vk.h"

#include <stdio.h>

static VkBufferUsageFlags usage_flags(uint32_t usage)
{
    VkBufferUsageFlags flags = VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;
    if (usage & GPU_BUFFER_STORAGE) flags |= VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
    if (usage & GPU_BUFFER_UNIFORM) flags |= VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT;
    if (usage & GPU_BUFFER_INDEX) flags |= VK_BUFFER_USAGE_INDEX_BUFFER_BIT;
    if (usage & GPU_BUFFER_INDIRECT) flags |= VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT;
    return flags;
}

static bool create_handle(struct gpu *gpu, struct buffer *buffer, uint32_t usage,
                          enum memory_kind kind)
{
    if (!VK_CALL(gpu, CreateBuffer, gpu->device,
                 &(VkBufferCreateInfo){
                     .sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO,
                     .size = buffer->capacity,
                     .usage = usage_flags(usage),
                 },
                 gpu->allocator, &buffer->handle)) {
        buffer->handle = VK_NULL_HANDLE;
        return false;
    }
    VK_NAME(gpu, VK_OBJECT_TYPE_BUFFER, buffer->handle, buffer->name);
    VkMemoryRequirements needs;
    gpu->vk.GetBufferMemoryRequirements(gpu->device, buffer->handle, &needs);
    if (!memory_allocate(gpu, &needs, kind, true, buffer->name, &buffer->memory)) return false;
    if (buffer->memory.recycled) buffer->hazard = hazard_recycled();
    return VK_CALL(gpu, BindBufferMemory, gpu->device, buffer->handle, buffer->memory.memory,
                   buffer->memory.offset);
}

struct buffer *buffer_new(struct gpu *gpu, const char *name, size_t bytes, uint32_t usage,
                          enum memory_kind kind)
{
    struct buffer *buffer = host_alloc(gpu->host, 1, sizeof *buffer);
    if (!buffer) return NULL;
    snprintf(buffer->name, sizeof buffer->name, "%s", name);
    buffer->bytes = bytes;
    buffer->capacity = (bytes + 3) & ~(size_t)3;
    if (create_handle(gpu, buffer, usage, kind)) return buffer;
    buffer_free(gpu, buffer);
    return NULL;
}

void buffer_free(struct gpu *gpu, void *object)
{
    struct buffer *buffer = object;
    if (!buffer) return;
    gpu->vk.DestroyBuffer(gpu->device, buffer->handle, gpu->allocator);
    memory_free(gpu, &buffer->memory);
    host_free(gpu->host, buffer);
}

static bool check_desc(struct gpu *gpu, const struct gpu_buffer_desc *desc)
{
    const uint32_t usages =
        GPU_BUFFER_STORAGE | GPU_BUFFER_UNIFORM | GPU_BUFFER_INDEX | GPU_BUFFER_INDIRECT;
    if (!desc->name || !desc->name[0]) {
        return host_fail(gpu->host, FAIL_ARGUMENT, "gpu buffer: it has no name");
    }
    if (gpu->lost)
        return host_fail(gpu->host, FAIL_DEVICE, "gpu buffer %s: the device was lost", desc->name);
    if (desc->usage & ~usages) {
        return host_fail(gpu->host, FAIL_ARGUMENT, "gpu buffer %s: unknown usage", desc->name);
    }
    if (!desc->bytes)
        return host_fail(gpu->host, FAIL_ARGUMENT, "gpu buffer %s: 0 bytes", desc->name);
    // maxStorageBufferRange limits bindings, not buffers; allocation size is the only limit here.
    if (desc->bytes > gpu->memory.max_allocation) {
        return host_fail(gpu->host, FAIL_MEMORY,
                         "gpu buffer %s: %zu bytes, the device gives at most %llu", desc->name,
                         desc->bytes, (unsigned long long)gpu->memory.max_allocation);
    }
    return true;
}

bool gpu_buffer_create(struct gpu *gpu, const struct gpu_buffer_desc *desc, gpu_buffer *out)
{
    out->id = 0;
    deferred_delete_collect(gpu);
    char name[NAME_SIZE];
    struct gpu_buffer_desc d = *desc;
    d.name = owner_name(gpu, d.name, name);
    if (!check_desc(gpu, &d)) return false;
    struct buffer *buffer = buffer_new(gpu, d.name, d.bytes, d.usage, MEMORY_DEVICE);
    if (!buffer) return false;
    buffer->zero_pending = true;
    out->id = table_add(gpu->host, &gpu->buffers, buffer);
    gpu->counters.buffers += out->id != 0;
    if (out->id) return true;
    buffer_free(gpu, buffer);
    return false;
}

void gpu_buffer_destroy(struct gpu *gpu, gpu_buffer *handle)
{
    struct buffer *buffer = gpu && handle ? table_remove(&gpu->buffers, handle->id) : NULL;
    if (handle) handle->id = 0;
    if (buffer) deferred_delete_add(gpu, buffer_free, buffer);
}

size_t gpu_buffer_bytes(const struct gpu *gpu, gpu_buffer handle)
{
    struct buffer *buffer = buffer_get(gpu, handle);
    return buffer ? buffer->bytes : 0;
}
