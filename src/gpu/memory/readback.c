// Readbacks that do not wait: a copy into mapped memory, polled in later frames.
#include "gpu/vk.h"

#include <string.h>

bool gpu_readback_create(struct gpu *gpu, const char *name, size_t bytes, struct gpu_readback *out)
{
    *out = (struct gpu_readback){ 0 };
    struct buffer *buffer = buffer_new(gpu, name, bytes, 0, MEMORY_DOWNLOAD);
    if (!buffer) return false;
    out->buffer.id = table_add(gpu->host, &gpu->buffers, buffer);
    if (out->buffer.id) return true;
    buffer_free(gpu, buffer);
    return false;
}

void gpu_readback_destroy(struct gpu *gpu, struct gpu_readback *readback)
{
    gpu_buffer_destroy(gpu, &readback->buffer);
    readback->serial = 0;
}

// The host reads what was copied, once the frame is completed.
static void show_host(struct gpu_cmd *cmd, struct buffer *buffer)
{
    hazard_next_op(cmd);
    hazard_buffer(cmd, buffer, &(struct access){ .stages = VK_PIPELINE_STAGE_2_HOST_BIT });
    hazard_flush(cmd);
}

void gpu_readback_copy(struct gpu_cmd *cmd, struct gpu_readback *to, size_t to_offset,
                       gpu_buffer from, size_t from_offset, size_t bytes)
{
    struct buffer *buffer = buffer_get(cmd->gpu, to->buffer);
    if (!buffer) return;
    gpu_copy_buffer(cmd, to->buffer, to_offset, from, from_offset, bytes);
    show_host(cmd, buffer);
    to->serial = cmd->serial;
}

void gpu_readback_copy_texel(struct gpu_cmd *cmd, struct gpu_readback *to, size_t to_offset,
                             gpu_image from, uint32_t x, uint32_t y)
{
    struct buffer *buffer = buffer_get(cmd->gpu, to->buffer);
    if (!buffer) return;
    gpu_copy_texel(cmd, to->buffer, to_offset, from, x, y);
    show_host(cmd, buffer);
    to->serial = cmd->serial;
}

bool gpu_readback_poll(struct gpu *gpu, struct gpu_readback *readback, void *out, size_t bytes)
{
    struct buffer *buffer = buffer_get(gpu, readback->buffer);
    if (!buffer || readback->serial == 0 || readback->serial > timeline_completed_serial(gpu))
        return false;
    memcpy(out, buffer->memory.mapped, bytes < buffer->bytes ? bytes : buffer->bytes);
    readback->serial = 0;
    return true;
}
