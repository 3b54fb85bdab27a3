// Clears, fills and copies within a frame.
#include "gpu/vk.h"

static bool ready(struct gpu_cmd *cmd, bool objects, const char *what)
{
    if (cmd->gpu->lost || cmd->broken) return false;
    if (!objects) {
        gpu_misuse(cmd->gpu, "%s: there is no such object", what);
        return false;
    }
    if (cmd->rendering.open) return gpu_misuse(cmd->gpu, "%s: not inside a rendering", what);
    hazard_next_op(cmd);
    return true;
}

static struct access transfer(const struct image *image, bool write)
{
    return (struct access){ VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, write,
                            image ? hazard_transfer_layout(image, write)
                                  : VK_IMAGE_LAYOUT_UNDEFINED };
}

void gpu_clear_image(struct gpu_cmd *cmd, gpu_image handle, const float value[4])
{
    struct image *image = image_get(cmd->gpu, handle);
    if (!ready(cmd, image != NULL, "clear")) return;
    struct access access = transfer(image, true);
    struct range range = image_whole(image);
    VkImageSubresourceRange all = { image->aspect, 0, image->desc.mips, 0, image->layers };
    hazard_overwrite_image(image);
    hazard_image(cmd, image, &range, &access);
    hazard_flush(cmd);
    if (image->desc.format == GPU_D32F) {
        cmd->gpu->vk.CmdClearDepthStencilImage(cmd->buffer, image->handle, access.layout,
                                               &(VkClearDepthStencilValue){ .depth = value[0] }, 1,
                                               &all);
        return;
    }
    VkClearColorValue clear = format_clear(image->desc.format, value);
    cmd->gpu->vk.CmdClearColorImage(cmd->buffer, image->handle, access.layout, &clear, 1, &all);
}

void gpu_fill_buffer(struct gpu_cmd *cmd, gpu_buffer handle, size_t offset, size_t bytes,
                     uint32_t word)
{
    struct buffer *buffer = buffer_get(cmd->gpu, handle);
    if (!bytes || !ready(cmd, buffer != NULL, "fill")) return;
    if (offset > buffer->bytes || bytes > buffer->bytes - offset || offset % 4 || bytes % 4) {
        gpu_misuse(cmd->gpu, "fill of %s: %zu bytes at %zu of %zu, in whole words", buffer->name,
                   bytes, offset, buffer->bytes);
        return;
    }
    struct access access = transfer(NULL, true);
    if (bytes == buffer->bytes) hazard_overwrite_buffer(buffer);
    hazard_buffer(cmd, buffer, &access);
    hazard_flush(cmd);
    cmd->gpu->vk.CmdFillBuffer(cmd->buffer, buffer->handle, offset, bytes, word);
}

static bool same_shape(const struct image *a, const struct image *b)
{
    const struct gpu_image_desc *x = &a->desc, *y = &b->desc;
    return x->format == y->format && x->width == y->width && x->height == y->height &&
           x->depth == y->depth && x->mips == y->mips &&
           (x->dimension == GPU_3D) == (y->dimension == GPU_3D);
}

void gpu_copy_image(struct gpu_cmd *cmd, gpu_image to_handle, gpu_image from_handle)
{
    struct image *to = image_get(cmd->gpu, to_handle), *from = image_get(cmd->gpu, from_handle);
    if (!ready(cmd, to && from && to != from, "copy of an image")) return;
    if (!same_shape(to, from)) {
        gpu_misuse(cmd->gpu, "copy of image %s: %s differs in format or size", from->name,
                   to->name);
        return;
    }
    struct access write = transfer(to, true), read = transfer(from, false);
    struct range range = image_whole(to);
    hazard_overwrite_image(to);
    hazard_image(cmd, to, &range, &write);
    hazard_image(cmd, from, &range, &read);
    hazard_flush(cmd);
    VkImageCopy regions[32];
    for (uint32_t mip = 0; mip < to->desc.mips; mip++) {
        VkImageSubresourceLayers layers = { to->aspect, mip, 0, to->layers };
        regions[mip] = (VkImageCopy){ .srcSubresource = layers,
                                      .dstSubresource = layers,
                                      .extent = image_extent(to, mip) };
    }
    cmd->gpu->vk.CmdCopyImage(cmd->buffer, from->handle, read.layout, to->handle, write.layout,
                              to->desc.mips, regions);
}

void gpu_copy_buffer(struct gpu_cmd *cmd, gpu_buffer to_handle, size_t to_offset,
                     gpu_buffer from_handle, size_t from_offset, size_t bytes)
{
    struct buffer *to = buffer_get(cmd->gpu, to_handle), *from = buffer_get(cmd->gpu, from_handle);
    if (!bytes || !ready(cmd, to && from && to != from, "copy of a buffer")) return;
    if (to_offset > to->bytes || bytes > to->bytes - to_offset || from_offset > from->bytes ||
        bytes > from->bytes - from_offset) {
        gpu_misuse(cmd->gpu, "copy of buffer %s to %s: %zu bytes from %zu to %zu do not fit",
                   from->name, to->name, bytes, from_offset, to_offset);
        return;
    }
    struct access write = transfer(NULL, true), read = transfer(NULL, false);
    if (bytes == to->bytes) hazard_overwrite_buffer(to);
    hazard_buffer(cmd, to, &write);
    hazard_buffer(cmd, from, &read);
    hazard_flush(cmd);
    cmd->gpu->vk.CmdCopyBuffer(cmd->buffer, from->handle, to->handle, 1,
                               &(VkBufferCopy){ from_offset, to_offset, bytes });
}

void gpu_copy_texel(struct gpu_cmd *cmd, gpu_buffer to_handle, size_t to_offset,
                    gpu_image from_handle, uint32_t x, uint32_t y)
{
    struct buffer *to = buffer_get(cmd->gpu, to_handle);
    struct image *from = image_get(cmd->gpu, from_handle);
    if (!ready(cmd, to && from, "copy of a texel")) return;
    const size_t bytes = (size_t)gpu_format_bytes(from->desc.format);
    if (to_offset > to->bytes || bytes > to->bytes - to_offset || to_offset % bytes ||
        x >= from->desc.width || y >= from->desc.height) {
        gpu_misuse(cmd->gpu, "copy of texel %u, %u of image %s: it does not fit", x, y, from->name);
        return;
    }
    const struct access write = transfer(NULL, true), read = transfer(from, false);
    const struct range range = image_whole(from);
    hazard_buffer(cmd, to, &write);
    hazard_image(cmd, from, &range, &read);
    hazard_flush(cmd);
    const VkBufferImageCopy region = { .bufferOffset = to_offset,
                                       .imageSubresource = { from->aspect, 0, 0, 1 },
                                       .imageOffset = { (int32_t)x, (int32_t)y, 0 },
                                       .imageExtent = { 1, 1, 1 } };
    cmd->gpu->vk.CmdCopyImageToBuffer(cmd->buffer, from->handle, read.layout, to->handle, 1,
                                      &region);
}
