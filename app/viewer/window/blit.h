// Images in the window: drawn by copies, before the interface.
#pragma once

#include "swapchain.h"

// Draws the part from `left` to `right`, 0…1 of the width, of an image in the layout
// TRANSFER_SRC_OPTIMAL to the same part of a rectangle of the window, in pixels: x0, y0, x1, y1.
void blit_part(struct swapchain *swapchain, VkImage image, int width, int height,
               const float rectangle[4], float left, float right);
