// VkDeviceMemory: allocated and mapped here, or by callbacks of the program that lent the device.
#include "gpu/vk.h"

static bool allocate(struct gpu *gpu, struct device_memory *memory)
{
    const VkMemoryAllocateInfo info = {
        .sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO,
        .allocationSize = memory->request.bytes,
        .memoryTypeIndex = memory->request.memory_type,
    };
    VkDeviceMemory handle;
    if (gpu->vk.AllocateMemory(gpu->device, &info, gpu->allocator, &handle) != VK_SUCCESS)
        return false;
    memory->block.memory = (void *)handle;
    return !memory->request.mapped || gpu->vk.MapMemory(gpu->device, handle, 0, VK_WHOLE_SIZE, 0,
                                                        &memory->block.mapped) == VK_SUCCESS;
}

// Linear and optimal resources of the library and of others must not share a page of
// bufferImageGranularity.
static uint64_t page_of(const struct gpu *gpu)
{
    const uint64_t page = gpu->vk_limits.bufferImageGranularity;
    return page ? page : 1;
}

static bool ask(struct gpu *gpu, struct device_memory *memory)
{
    const struct gpu_memory_callbacks *callbacks = &gpu->adopt.memory;
    struct gpu_memory_request *request = &memory->request;
    const uint64_t page = page_of(gpu);
    if (request->bytes > UINT64_MAX - page) return false;
    request->bytes = (request->bytes + page - 1) / page * page;
    if (request->alignment < page) request->alignment = page;
    if (!callbacks->allocate(callbacks->user, request, &memory->block)) {
        memory->block = (struct gpu_memory_block){ 0 };
        return false;
    }
    const struct gpu_memory_block *block = &memory->block;
    if (block->memory && block->offset % request->alignment == 0 &&
        (block->mapped || !request->mapped))
        return true;
    host_log(gpu->host, LOG_ERROR,
             "gpu memory from the program's callback: %s; the allocation counts as failed",
             !block->memory                            ? "no VkDeviceMemory"
             : block->offset % request->alignment != 0 ? "the offset is not aligned"
                                                       : "it is not mapped");
    return false;
}

bool device_memory_allocate(struct gpu *gpu, const struct gpu_memory_request *request,
                            const char *name, struct device_memory *out)
{
    *out = (struct device_memory){ .request = *request };
    const bool lent = gpu->adopt.memory.allocate != NULL;
    const bool ok = lent ? ask(gpu, out) : allocate(gpu, out);
    if (ok && !lent) VK_NAME(gpu, VK_OBJECT_TYPE_DEVICE_MEMORY, out->block.memory, name);
    if (ok) return true;
    device_memory_free(gpu, out);
    *out = (struct device_memory){ 0 };
    return false;
}

void device_memory_free(struct gpu *gpu, const struct device_memory *memory)
{
    const struct gpu_memory_callbacks *callbacks = &gpu->adopt.memory;
    if (!memory->block.memory) return;
    if (callbacks->free)
        callbacks->free(callbacks->user, &memory->request, &memory->block);
    else
        gpu->vk.FreeMemory(gpu->device, (VkDeviceMemory)memory->block.memory,
                           gpu->allocator); // unmaps
}
