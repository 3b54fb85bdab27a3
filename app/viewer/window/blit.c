#include "blit.h"

void blit_part(struct swapchain *swapchain, VkImage image, int width, int height,
               const float rectangle[4], float left, float right)
{
    const float window_width = rectangle[2] - rectangle[0];
    const int x0 = (int)(left * (float)width + 0.5f), x1 = (int)(right * (float)width + 0.5f);
    if (x0 >= x1) return;
    // The edges of the part in the window are those of whole texels.
    const float u0 = (float)x0 / (float)width, u1 = (float)x1 / (float)width;
    const VkImageBlit region = {
        .srcSubresource = { VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1 },
        .srcOffsets = { { x0, 0, 0 }, { x1, height, 1 } },
        .dstSubresource = { VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1 },
        .dstOffsets = { { (int)(rectangle[0] + u0 * window_width), (int)rectangle[1], 0 },
                        { (int)(rectangle[0] + u1 * window_width), (int)rectangle[3], 1 } },
    };
    vkCmdBlitImage(swapchain->frames[swapchain->frame].commands, image,
                   VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, swapchain->images[swapchain->image],
                   VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region, VK_FILTER_LINEAR);
}
