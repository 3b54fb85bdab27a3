#include "framework/own_image.h"

#include "framework/test.h"

#include <string.h>

#define CHECK_VK(call) assert_int_equal((call), VK_SUCCESS)

static const VkImageUsageFlags USAGE = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;

bool own_image_supported(const struct own_device *own, VkFormat format)
{
    VkImageFormatProperties properties;
    return vkGetPhysicalDeviceImageFormatProperties(own->physical, format, VK_IMAGE_TYPE_2D,
                                                    VK_IMAGE_TILING_OPTIMAL, USAGE, 0,
                                                    &properties) == VK_SUCCESS;
}

static VkDeviceMemory allocate(struct own_device *own, const VkMemoryRequirements *needs,
                               VkMemoryPropertyFlags wanted)
{
    VkPhysicalDeviceMemoryProperties types;
    VkDeviceMemory memory = VK_NULL_HANDLE;
    vkGetPhysicalDeviceMemoryProperties(own->physical, &types);
    for (uint32_t i = 0; i < types.memoryTypeCount && !memory; i++) {
        const bool fits = needs->memoryTypeBits >> i & 1u &&
                          (types.memoryTypes[i].propertyFlags & wanted) == wanted;
        const VkMemoryAllocateInfo info = { .sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO,
                                            .allocationSize = needs->size,
                                            .memoryTypeIndex = i };
        if (fits) CHECK_VK(vkAllocateMemory(own->device, &info, NULL, &memory));
    }
    assert_true(memory != VK_NULL_HANDLE);
    return memory;
}

static VkImageAspectFlags aspects_of(VkFormat format)
{
    switch (format) {
    case VK_FORMAT_D24_UNORM_S8_UINT:
    case VK_FORMAT_D32_SFLOAT_S8_UINT:
        return VK_IMAGE_ASPECT_DEPTH_BIT | VK_IMAGE_ASPECT_STENCIL_BIT;
    case VK_FORMAT_D16_UNORM:
    case VK_FORMAT_D32_SFLOAT:
    case VK_FORMAT_X8_D24_UNORM_PACK32:
        return VK_IMAGE_ASPECT_DEPTH_BIT;
    default:
        return VK_IMAGE_ASPECT_COLOR_BIT;
    }
}

static void change_layout(VkCommandBuffer commands, const struct own_image *image,
                          VkImageLayout from, VkImageLayout to)
{
    const VkImageMemoryBarrier barrier = {
        .sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER,
        .srcAccessMask = VK_ACCESS_MEMORY_WRITE_BIT,
        .dstAccessMask = VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT,
        .oldLayout = from,
        .newLayout = to,
        .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
        .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
        .image = image->image,
        .subresourceRange = { aspects_of(image->format), 0, 1, 0, 1 },
    };
    const VkPipelineStageFlags all = VK_PIPELINE_STAGE_ALL_COMMANDS_BIT;
    vkCmdPipelineBarrier(commands, all, all, 0, 0, NULL, 0, NULL, 1, &barrier);
}

struct staging {
    VkBuffer buffer;
    VkDeviceMemory memory;
};

static struct staging stage(struct own_device *own, const void *texels, size_t bytes)
{
    struct staging s;
    void *mapped;
    VkMemoryRequirements needs;
    const VkBufferCreateInfo info = { .sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO,
                                      .size = bytes,
                                      .usage = VK_BUFFER_USAGE_TRANSFER_SRC_BIT };
    CHECK_VK(vkCreateBuffer(own->device, &info, NULL, &s.buffer));
    vkGetBufferMemoryRequirements(own->device, s.buffer, &needs);
    s.memory = allocate(own, &needs,
                        VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT);
    CHECK_VK(vkBindBufferMemory(own->device, s.buffer, s.memory, 0));
    CHECK_VK(vkMapMemory(own->device, s.memory, 0, VK_WHOLE_SIZE, 0, &mapped));
    memcpy(mapped, texels, bytes);
    vkUnmapMemory(own->device, s.memory);
    return s;
}

static void copy(struct own_device *own, const struct own_image *image, VkBuffer from)
{
    const VkImageAspectFlags aspects = aspects_of(image->format);
    const VkBufferImageCopy region = {
        .imageSubresource = { aspects & ~(VkImageAspectFlags)VK_IMAGE_ASPECT_STENCIL_BIT, 0, 0, 1 },
        .imageExtent = { (uint32_t)image->width, (uint32_t)image->height, 1 },
    };
    VkCommandBuffer commands = own_device_begin(own);
    change_layout(commands, image, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
    vkCmdCopyBufferToImage(commands, from, image->image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1,
                           &region);
    change_layout(commands, image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                  VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
    own_device_run(own, commands);
}

struct own_image own_image_create(struct own_device *own, VkFormat format, int width, int height,
                                  const void *texels, size_t bytes)
{
    struct own_image image = { .format = format, .width = width, .height = height };
    VkMemoryRequirements needs;
    const VkImageCreateInfo info = { .sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO,
                                     .imageType = VK_IMAGE_TYPE_2D,
                                     .format = format,
                                     .extent = { (uint32_t)width, (uint32_t)height, 1 },
                                     .mipLevels = 1,
                                     .arrayLayers = 1,
                                     .samples = VK_SAMPLE_COUNT_1_BIT,
                                     .usage = USAGE };
    CHECK_VK(vkCreateImage(own->device, &info, NULL, &image.image));
    vkGetImageMemoryRequirements(own->device, image.image, &needs);
    image.memory = allocate(own, &needs, 0);
    CHECK_VK(vkBindImageMemory(own->device, image.image, image.memory, 0));
    struct staging staging = stage(own, texels, bytes);
    copy(own, &image, staging.buffer);
    vkDestroyBuffer(own->device, staging.buffer, NULL);
    vkFreeMemory(own->device, staging.memory, NULL);
    return image;
}

void own_image_destroy(struct own_device *own, struct own_image *image)
{
    vkDestroyImage(own->device, image->image, NULL);
    vkFreeMemory(own->device, image->memory, NULL);
    *image = (struct own_image){ 0 };
}
