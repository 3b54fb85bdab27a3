// Images of a host program's Vulkan device, filled from memory.
#pragma once

#include "framework/own_device.h"

#include <stddef.h>

struct own_image {
    VkImage image;
    VkDeviceMemory memory;
    VkFormat format;
    int width, height;
};

// A sampled image with these texels, rows from the top, in the layout SHADER_READ_ONLY_OPTIMAL.
// Formats with depth and stencil take texels of the depth alone, as vkCmdCopyBufferToImage does.
struct own_image own_image_create(struct own_device *own, VkFormat format, int width, int height,
                                  const void *texels, size_t bytes);
void own_image_destroy(struct own_device *own, struct own_image *image);
// Whether the device has sampled images of this format.
bool own_image_supported(const struct own_device *own, VkFormat format);
