// Small data for one frame: a mapped buffer per frame in flight, reset when the GPU has completed
// the frame. Host writes are made visible by the submission.
#include "gpu/vk.h"

#include <string.h>

static const size_t RING_BYTES = 64u << 10;

void ring_start(struct gpu_cmd *cmd)
{
    cmd->ring.used = 0;
}

void ring_stop(struct gpu_cmd *cmd)
{
    struct ring *ring = &cmd->ring;
    for (int i = 0; i < ring->replaced_count; i++) {
        gpu_buffer_destroy(cmd->gpu, &ring->replaced[i]);
        cmd->gpu->internal_buffers--;
    }
    ring->replaced_count = 0;
}

static void ring_free(struct gpu *gpu, gpu_buffer buffer)
{
    if (!buffer.id) return;
    buffer_free(gpu, table_remove(&gpu->buffers, buffer.id));
    gpu->internal_buffers--;
}

void ring_finish(struct gpu_cmd *cmd)
{
    struct ring *ring = &cmd->ring;
    for (int i = 0; i < ring->replaced_count; i++) ring_free(cmd->gpu, ring->replaced[i]);
    ring_free(cmd->gpu, ring->buffer);
    *ring = (struct ring){ 0 };
}

static bool ring_grow(struct gpu_cmd *cmd, size_t bytes)
{
    struct gpu *gpu = cmd->gpu;
    size_t size = gpu_buffer_bytes(gpu, cmd->ring.buffer);
    size = size ? 2 * size : RING_BYTES;
    while (size < bytes && size < SIZE_MAX / 2) size *= 2;
    const uint32_t usage =
        GPU_BUFFER_STORAGE | GPU_BUFFER_UNIFORM | GPU_BUFFER_INDEX | GPU_BUFFER_INDIRECT;
    if (cmd->ring.replaced_count == MAX_REPLACED_RINGS) return false;
    struct buffer *buffer = buffer_new(gpu, "gpu.transient", size, usage, MEMORY_RING);
    if (!buffer) return false;
    buffer->constant = true;
    uint32_t id = table_add(gpu->host, &gpu->buffers, buffer);
    if (!id) {
        buffer_free(gpu, buffer);
        return false;
    }
    if (cmd->ring.buffer.id) cmd->ring.replaced[cmd->ring.replaced_count++] = cmd->ring.buffer;
    gpu->internal_buffers++;
    cmd->ring.buffer = (gpu_buffer){ id };
    cmd->ring.used = 0;
    return true;
}

struct gpu_binding gpu_transient(struct gpu_cmd *cmd, const char *name, const void *data,
                                 size_t bytes)
{
    static const char nothing[16];
    const VkPhysicalDeviceLimits *l = &cmd->gpu->vk_limits;
    struct gpu_binding binding = { .name = name };
    if (!bytes) data = nothing, bytes = sizeof nothing; // a block is never empty
    size_t alignment = l->minUniformBufferOffsetAlignment;
    if (alignment < l->minStorageBufferOffsetAlignment)
        alignment = l->minStorageBufferOffsetAlignment;
    if (alignment < 16) alignment = 16;
    size_t start = (cmd->ring.used + alignment - 1) / alignment * alignment;
    size_t end, capacity = gpu_buffer_bytes(cmd->gpu, cmd->ring.buffer);
    if (!size_add(start, bytes, &end) || end > capacity) {
        if (!ring_grow(cmd, bytes)) {
            cmd->broken = true;
            return binding;
        }
        start = 0;
        end = bytes;
    }
    struct buffer *buffer = buffer_get(cmd->gpu, cmd->ring.buffer);
    memcpy((char *)buffer->memory.mapped + start, data, bytes);
    cmd->ring.used = end;
    binding.buffer = cmd->ring.buffer;
    binding.offset = start;
    binding.bytes = bytes;
    return binding;
}
