// An image from the host's memory that the window shows, as the reference.
#pragma once

#include "swapchain.h"

#include <afterglow/afterglow.h>

struct host_image {
    const struct gpu *gpu;
    VkImage image;
    VkDeviceMemory memory;
    struct gpu_mapped staging;
    int width, height;
    bool changed; // staging is newer than the image
};

// Takes over a linear display image, 0…1, sRGB-encoded; false: the device has no memory for it.
bool host_image_set(struct host_image *image, const struct gpu *gpu, const struct ag_image *pixels);
void host_image_close(struct host_image *image); // accepts zero
// Draws the part from `left` to `right`, as rendering_draw does.
void host_image_draw(struct host_image *image, struct swapchain *swapchain,
                     const float rectangle[4], float left, float right);
