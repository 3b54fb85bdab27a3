#include "host_image.h"

#include "blit.h"
#include "shell/srgb.h"

static bool open(struct host_image *image, const struct gpu *gpu, int width, int height)
{
    const VkImageCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO,
        .imageType = VK_IMAGE_TYPE_2D,
        .format = VK_FORMAT_R8G8B8A8_UNORM,
        .extent = { (uint32_t)width, (uint32_t)height, 1 },
        .mipLevels = 1,
        .arrayLayers = 1,
        .samples = VK_SAMPLE_COUNT_1_BIT,
        .tiling = VK_IMAGE_TILING_OPTIMAL,
        .usage = VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT,
    };
    VkMemoryRequirements needs;
    *image = (struct host_image){ .gpu = gpu, .width = width, .height = height };
    if (vkCreateImage(gpu->device, &info, NULL, &image->image) != VK_SUCCESS) return false;
    vkGetImageMemoryRequirements(gpu->device, image->image, &needs);
    const int type =
        gpu_memory_type(gpu, needs.memoryTypeBits, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT);
    const VkMemoryAllocateInfo allocate = { .sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO,
                                            .allocationSize = needs.size,
                                            .memoryTypeIndex = (uint32_t)type };
    return type >= 0 &&
           vkAllocateMemory(gpu->device, &allocate, NULL, &image->memory) == VK_SUCCESS &&
           vkBindImageMemory(gpu->device, image->image, image->memory, 0) == VK_SUCCESS &&
           gpu_mapped_open(gpu, (VkDeviceSize)width * (VkDeviceSize)height * 4, &image->staging);
}

void host_image_close(struct host_image *image)
{
    if (!image->gpu) return;
    vkQueueWaitIdle(image->gpu->queue);
    gpu_mapped_close(image->gpu, &image->staging);
    vkDestroyImage(image->gpu->device, image->image, NULL);
    vkFreeMemory(image->gpu->device, image->memory, NULL);
    *image = (struct host_image){ 0 };
}

bool host_image_set(struct host_image *image, const struct gpu *gpu, const struct ag_image *pixels)
{
    if (image->width != pixels->width || image->height != pixels->height) {
        host_image_close(image);
        if (!open(image, gpu, pixels->width, pixels->height)) {
            host_image_close(image);
            return false;
        }
    }
    vkQueueWaitIdle(gpu->queue); // an earlier copy may still read
    unsigned char *bytes = image->staging.bytes;
    const size_t count = (size_t)pixels->width * (size_t)pixels->height;
    for (size_t i = 0; i < count; i++)
        for (size_t c = 0; c < 4; c++)
            bytes[4 * i + c] =
                c < 3 ? srgb_byte(pixels->pixels[i * (size_t)pixels->channels + c]) : 255;
    image->changed = true;
    return true;
}

void host_image_draw(struct host_image *image, struct swapchain *swapchain,
                     const float rectangle[4], float left, float right)
{
    const VkCommandBuffer commands = swapchain->frames[swapchain->frame].commands;
    if (!image->image) return;
    if (image->changed) {
        const VkBufferImageCopy region = {
            .imageSubresource = { VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1 },
            .imageExtent = { (uint32_t)image->width, (uint32_t)image->height, 1 },
        };
        gpu_transition(commands, image->image, VK_IMAGE_LAYOUT_UNDEFINED,
                       VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
        vkCmdCopyBufferToImage(commands, image->staging.buffer, image->image,
                               VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region);
        gpu_transition(commands, image->image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                       VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
        image->changed = false;
    }
    blit_part(swapchain, image->image, image->width, image->height, rectangle, left, right);
}
