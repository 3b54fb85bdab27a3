// Blocking transfers through one staging buffer per direction.
#include "gpu/vk.h"

#include <string.h>

enum { UPLOAD, DOWNLOAD };
static const size_t STAGING_KEEP_BYTES = 64u << 20; // larger staging buffers are freed after use

static struct buffer *staging(struct gpu *gpu, int direction, size_t bytes)
{
    struct buffer **slot = &gpu->staging[direction];
    if (*slot && (*slot)->bytes >= bytes) return *slot;
    buffer_free(gpu, *slot); // transfers block: nothing uses it
    size_t size = bytes < (1u << 20) ? 1u << 20 : bytes;
    *slot = buffer_new(gpu, "gpu.staging", size, 0,
                       direction == UPLOAD ? MEMORY_UPLOAD : MEMORY_DOWNLOAD);
    if (*slot) (*slot)->constant = direction == UPLOAD;
    return *slot;
}

static void staging_trim(struct gpu *gpu, int direction)
{
    struct buffer **slot = &gpu->staging[direction];
    if (!*slot || (*slot)->bytes <= STAGING_KEEP_BYTES) return;
    buffer_free(gpu, *slot);
    *slot = NULL;
}

static const struct access copy_write = { .stages = VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT,
                                          .write = true };
static const struct access copy_read = { .stages = VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT };

// Makes the staged bytes visible to the host once the submission is complete.
static bool finish_download(struct gpu *gpu, struct gpu_cmd *cmd, struct buffer *stage)
{
    hazard_next_op(cmd);
    hazard_buffer(cmd, stage, &(struct access){ .stages = VK_PIPELINE_STAGE_2_HOST_BIT });
    hazard_flush(cmd);
    return transfer_end(gpu, cmd);
}

static struct image *check_image(struct gpu *gpu, gpu_image handle, uint32_t mip, uint32_t layer)
{
    struct image *image = image_get(gpu, handle);
    if (!image) {
        host_fail(gpu->host, FAIL_ARGUMENT, "gpu transfer: there is no such image");
        return NULL;
    }
    return image_check_part(gpu, image, mip, layer) ? image : NULL;
}

static bool check_bytes(struct gpu *gpu, const struct image *image, uint32_t mip, size_t bytes)
{
    size_t needed = image_part_bytes(image, mip);
    if (bytes == needed) return true;
    return host_fail(gpu->host, FAIL_ARGUMENT,
                     "gpu transfer of image %s: %zu bytes given, mip %u has %zu", image->name,
                     bytes, mip, needed);
}

static VkBufferImageCopy copy_region(const struct image *image, uint32_t mip, uint32_t layer)
{
    return (VkBufferImageCopy){
        .imageSubresource = { image->aspect, mip, layer, 1 },
        .imageExtent = image_extent(image, mip),
    };
}

bool gpu_image_upload(struct gpu *gpu, gpu_image handle, uint32_t mip, uint32_t layer,
                      const void *texels, size_t bytes)
{
    struct image *image = check_image(gpu, handle, mip, layer);
    if (!image || !check_bytes(gpu, image, mip, bytes)) return false;
    struct buffer *stage = staging(gpu, UPLOAD, bytes);
    struct gpu_cmd *cmd = stage ? transfer_begin_image(gpu, image) : NULL;
    if (!cmd) return false;
    memcpy(stage->memory.mapped, texels, bytes);
    struct access access = copy_write;
    access.layout = hazard_transfer_layout(image, true);
    struct range range = { mip, 1, layer, 1 };
    if (image->desc.mips == 1 && image->layers == 1) hazard_overwrite_image(image);
    hazard_image(cmd, image, &range, &access);
    hazard_flush(cmd);
    VkBufferImageCopy region = copy_region(image, mip, layer);
    gpu->vk.CmdCopyBufferToImage(cmd->buffer, stage->handle, image->handle, access.layout, 1,
                                 &region);
    bool done = transfer_end(gpu, cmd);
    staging_trim(gpu, UPLOAD);
    return done;
}

// Copies into the staging buffer; its mapped bytes, or NULL.
static const void *download(struct gpu *gpu, struct image *image, uint32_t mip, uint32_t layer)
{
    struct buffer *stage = staging(gpu, DOWNLOAD, image_part_bytes(image, mip));
    struct gpu_cmd *cmd = stage ? transfer_begin(gpu) : NULL;
    if (!cmd) return NULL;
    struct access access = copy_read;
    access.layout = hazard_transfer_layout(image, false);
    struct range range = { mip, 1, layer, 1 };
    hazard_image(cmd, image, &range, &access);
    hazard_buffer(cmd, stage, &copy_write);
    hazard_flush(cmd);
    VkBufferImageCopy region = copy_region(image, mip, layer);
    gpu->vk.CmdCopyImageToBuffer(cmd->buffer, image->handle, access.layout, stage->handle, 1,
                                 &region);
    return finish_download(gpu, cmd, stage) ? stage->memory.mapped : NULL;
}

bool gpu_image_download(struct gpu *gpu, gpu_image handle, uint32_t mip, uint32_t layer,
                        void *texels, size_t bytes)
{
    struct image *image = check_image(gpu, handle, mip, layer);
    if (!image || !check_bytes(gpu, image, mip, bytes)) return false;
    const void *data = download(gpu, image, mip, layer);
    if (data) memcpy(texels, data, bytes);
    staging_trim(gpu, DOWNLOAD);
    return data != NULL;
}

bool gpu_image_download_float(struct gpu *gpu, gpu_image handle, uint32_t mip, uint32_t layer,
                              float *texels, int channels, size_t float_count)
{
    struct image *image = check_image(gpu, handle, mip, layer);
    if (!image) return false;
    size_t texel_bytes = format_of(image->desc.format)->bytes;
    size_t count = image_part_bytes(image, mip) / texel_bytes;
    if (channels < 1 || channels > 4 || float_count != count * (size_t)channels) {
        return host_fail(gpu->host, FAIL_ARGUMENT,
                         "gpu transfer of image %s: %zu floats given, mip %u has %zu texels of %d",
                         image->name, float_count, mip, count, channels);
    }
    const char *data = download(gpu, image, mip, layer);
    for (size_t i = 0; data && i < count; i++) {
        float texel[4];
        format_to_float(image->desc.format, data + i * texel_bytes, texel);
        memcpy(texels + i * (size_t)channels, texel, (size_t)channels * sizeof *texel);
    }
    staging_trim(gpu, DOWNLOAD);
    return data != NULL;
}

static struct buffer *check_buffer(struct gpu *gpu, gpu_buffer handle, size_t offset, size_t bytes)
{
    struct buffer *buffer = buffer_get(gpu, handle);
    if (!buffer) {
        host_fail(gpu->host, FAIL_ARGUMENT, "gpu transfer: there is no such buffer");
    } else if (offset > buffer->bytes || bytes > buffer->bytes - offset) {
        host_fail(gpu->host, FAIL_ARGUMENT,
                  "gpu transfer of buffer %s: %zu bytes at %zu, it has %zu", buffer->name, bytes,
                  offset, buffer->bytes);
        buffer = NULL;
    }
    return buffer;
}

bool gpu_buffer_upload(struct gpu *gpu, gpu_buffer handle, size_t offset, const void *data,
                       size_t bytes)
{
    struct buffer *buffer = check_buffer(gpu, handle, offset, bytes);
    if (!buffer || !bytes) return buffer != NULL;
    struct buffer *stage = staging(gpu, UPLOAD, bytes);
    struct gpu_cmd *cmd = stage ? transfer_begin_buffer(gpu, buffer) : NULL;
    if (!cmd) return false;
    memcpy(stage->memory.mapped, data, bytes);
    if (bytes == buffer->bytes) hazard_overwrite_buffer(buffer);
    hazard_buffer(cmd, buffer, &copy_write);
    hazard_flush(cmd);
    gpu->vk.CmdCopyBuffer(cmd->buffer, stage->handle, buffer->handle, 1,
                          &(VkBufferCopy){ 0, offset, bytes });
    bool done = transfer_end(gpu, cmd);
    staging_trim(gpu, UPLOAD);
    return done;
}

bool gpu_buffer_download(struct gpu *gpu, gpu_buffer handle, size_t offset, void *data,
                         size_t bytes)
{
    struct buffer *buffer = check_buffer(gpu, handle, offset, bytes);
    if (!buffer || !bytes) return buffer != NULL;
    struct buffer *stage = staging(gpu, DOWNLOAD, bytes);
    struct gpu_cmd *cmd = stage ? transfer_begin(gpu) : NULL;
    if (!cmd) return false;
    hazard_buffer(cmd, buffer, &copy_read);
    hazard_buffer(cmd, stage, &copy_write);
    hazard_flush(cmd);
    gpu->vk.CmdCopyBuffer(cmd->buffer, buffer->handle, stage->handle, 1,
                          &(VkBufferCopy){ offset, 0, bytes });
    bool done = finish_download(gpu, cmd, stage);
    if (done) memcpy(data, stage->memory.mapped, bytes);
    staging_trim(gpu, DOWNLOAD);
    return done;
}

static bool check_blit(struct gpu *gpu, const struct image *image)
{
    const VkFormatFeatureFlags needed = VK_FORMAT_FEATURE_BLIT_SRC_BIT |
                                        VK_FORMAT_FEATURE_BLIT_DST_BIT |
                                        VK_FORMAT_FEATURE_SAMPLED_IMAGE_FILTER_LINEAR_BIT;
    const struct format *format = format_of(image->desc.format);
    VkFormatProperties p;
    gpu->vk.GetPhysicalDeviceFormatProperties(gpu->physical, format->vk, &p);
    if ((p.optimalTilingFeatures & needed) == needed) return true;
    return host_fail(gpu->host, FAIL_UNSUPPORTED,
                     "gpu mips of image %s: the device cannot blit %s with a linear filter",
                     image->name, format->name);
}

static void blit_mip(struct gpu_cmd *cmd, struct image *image, uint32_t mip)
{
    struct access write = copy_write, read = copy_read;
    write.layout = hazard_transfer_layout(image, true);
    read.layout = hazard_transfer_layout(image, false);
    hazard_next_op(cmd);
    hazard_image(cmd, image, &(struct range){ mip, 1, 0, image->layers }, &write);
    hazard_image(cmd, image, &(struct range){ mip - 1, 1, 0, image->layers }, &read);
    hazard_flush(cmd);
    VkExtent3D from = image_extent(image, mip - 1), to = image_extent(image, mip);
    VkImageBlit blit = {
        .srcSubresource = { image->aspect, mip - 1, 0, image->layers },
        .srcOffsets = { { 0 }, { (int32_t)from.width, (int32_t)from.height, (int32_t)from.depth } },
        .dstSubresource = { image->aspect, mip, 0, image->layers },
        .dstOffsets = { { 0 }, { (int32_t)to.width, (int32_t)to.height, (int32_t)to.depth } },
    };
    cmd->gpu->vk.CmdBlitImage(cmd->buffer, image->handle, read.layout, image->handle, write.layout,
                              1, &blit, VK_FILTER_LINEAR);
}

bool gpu_image_generate_mips(struct gpu *gpu, gpu_image handle)
{
    struct image *image = check_image(gpu, handle, 0, 0);
    if (!image || !check_blit(gpu, image)) return false;
    struct gpu_cmd *cmd = transfer_begin_image(gpu, image);
    if (!cmd) return false;
    for (uint32_t mip = 1; mip < image->desc.mips; mip++) blit_mip(cmd, image, mip);
    return transfer_end(gpu, cmd);
}
