#include "host_gbuffer.h"

#include <string.h>

static const VkImageUsageFlags usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
static const VkImageLayout shown = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;

static VkDeviceSize image_bytes(const struct host_gbuffer *gbuffer, int which)
{
    const VkFormat format = gbuffer->formats[which];
    const VkDeviceSize texel = format == VK_FORMAT_UNDEFINED       ? 0
                               : format == VK_FORMAT_R32G32_SFLOAT ? 8
                                                                   : 4;
    return texel * (VkDeviceSize)gbuffer->width * (VkDeviceSize)gbuffer->height;
}

static VkDeviceSize offset_of(const struct host_gbuffer *gbuffer, int which)
{
    VkDeviceSize offset = 0;
    for (int k = 0; k < which; k++) offset += image_bytes(gbuffer, k);
    return offset;
}

static void create_image(const struct host_device *host, struct host_gbuffer *gbuffer, int which)
{
    VkImageCreateInfo info;
    memset(&info, 0, sizeof info);
    info.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO;
    info.imageType = VK_IMAGE_TYPE_2D;
    info.format = gbuffer->formats[which];
    info.extent.width = (uint32_t)gbuffer->width;
    info.extent.height = (uint32_t)gbuffer->height;
    info.extent.depth = info.mipLevels = info.arrayLayers = 1;
    info.samples = VK_SAMPLE_COUNT_1_BIT;
    info.usage = usage;
    VkImage *image = &gbuffer->images[which];
    host_check(vkCreateImage(host->device, &info, NULL, image), "vkCreateImage");
    VkMemoryRequirements needs;
    vkGetImageMemoryRequirements(host->device, *image, &needs);
    host_allocate(host, &needs, 0, &gbuffer->memory[which]);
    host_check(vkBindImageMemory(host->device, *image, gbuffer->memory[which], 0),
               "vkBindImageMemory");
}

void host_gbuffer_create(const struct host_device *host, int width, int height,
                         const VkFormat formats[SURFACE_IMAGES], struct host_gbuffer *out)
{
    memset(out, 0, sizeof *out);
    out->width = width;
    out->height = height;
    memcpy(out->formats, formats, sizeof out->formats);
    for (int k = 0; k < SURFACE_IMAGES; k++)
        if (formats[k]) create_image(host, out, k);
    mapped_buffer_create(host, offset_of(out, SURFACE_IMAGES), VK_BUFFER_USAGE_TRANSFER_SRC_BIT,
                         &out->texels);
}

void host_gbuffer_destroy(const struct host_device *host, const struct host_gbuffer *gbuffer)
{
    mapped_buffer_destroy(host, &gbuffer->texels);
    for (int k = 0; k < SURFACE_IMAGES; k++) {
        vkDestroyImage(host->device, gbuffer->images[k], NULL);
        vkFreeMemory(host->device, gbuffer->memory[k], NULL);
    }
}

void *host_gbuffer_texels(const struct host_gbuffer *gbuffer, enum surface_image which)
{
    return (char *)gbuffer->texels.bytes + offset_of(gbuffer, which);
}

VkBufferImageCopy host_whole_image(int width, int height, VkImageAspectFlags aspect,
                                   VkDeviceSize offset)
{
    VkBufferImageCopy region;
    memset(&region, 0, sizeof region);
    region.bufferOffset = offset;
    region.imageSubresource.aspectMask = aspect;
    region.imageSubresource.layerCount = 1;
    region.imageExtent.width = (uint32_t)width;
    region.imageExtent.height = (uint32_t)height;
    region.imageExtent.depth = 1;
    return region;
}

// The images of two frames alternate; their content is discarded.
static void upload_image(const struct host_gbuffer *gbuffer, VkCommandBuffer commands, int which)
{
    const VkImageAspectFlags aspect =
        which == SURFACE_DEPTH ? VK_IMAGE_ASPECT_DEPTH_BIT : VK_IMAGE_ASPECT_COLOR_BIT;
    const VkImageLayout target = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL;
    const VkImage image = gbuffer->images[which];
    const VkBufferImageCopy region =
        host_whole_image(gbuffer->width, gbuffer->height, aspect, offset_of(gbuffer, which));
    host_barrier(commands, image, aspect, VK_IMAGE_LAYOUT_UNDEFINED, target);
    vkCmdCopyBufferToImage(commands, gbuffer->texels.buffer, image, target, 1, &region);
    host_barrier(commands, image, aspect, target, shown);
}

static void describe(const struct host_gbuffer *gbuffer, int which, struct ag_layer_handle *out)
{
    out->vk_image = (void *)gbuffer->images[which];
    out->vk_format = (uint32_t)gbuffer->formats[which];
    out->vk_usage = usage;
    out->vk_layout = (uint32_t)shown;
    out->width = gbuffer->width;
    out->height = gbuffer->height;
    out->scale = 1;
}

void host_gbuffer_upload(const struct host_gbuffer *gbuffer, VkCommandBuffer commands,
                         struct ag_gbuffer *out)
{
    memset(out, 0, sizeof *out);
    struct ag_layer_handle *const handles[SURFACE_IMAGES] = { &out->depth, &out->normal,
                                                              &out->albedo, &out->motion };
    for (int k = 0; k < SURFACE_IMAGES; k++) {
        if (!gbuffer->formats[k]) continue;
        upload_image(gbuffer, commands, k);
        describe(gbuffer, k, handles[k]);
    }
}
