// Images of the window, the render pass of the interface, and two frames in flight.
#pragma once

#include "gpu.h"

enum { SWAPCHAIN_IMAGES = 8, SWAPCHAIN_FRAMES = 2 };

struct swapchain {
    const struct gpu *gpu;
    VkSwapchainKHR handle; // NULL while the window has no pixels
    VkSurfaceFormatKHR format;
    VkRenderPass pass;
    bool loses_device; // for a test: the next frame is one of a device that is lost
    uint32_t width, height, count, least; // least: of the surface
    VkImage images[SWAPCHAIN_IMAGES];
    VkImageView views[SWAPCHAIN_IMAGES];
    VkFramebuffer framebuffers[SWAPCHAIN_IMAGES];
    VkSemaphore rendered[SWAPCHAIN_IMAGES];
    struct swapchain_frame {
        VkCommandPool pool;
        VkCommandBuffer commands;
        VkSemaphore acquired;
        VkFence done;
    } frames[SWAPCHAIN_FRAMES];
    uint32_t frame, image; // being recorded
    bool stale;            // of another size than the window
};

// All functions but close return false after an error of the device, as when it is lost.
bool swapchain_open(struct swapchain *s, const struct gpu *gpu, int width, int height);
void swapchain_close(struct swapchain *s);
bool swapchain_resize(struct swapchain *s, int width, int height);
// Begins the commands of a frame. *commands is NULL if there is no image to draw to: resize.
bool swapchain_begin(struct swapchain *s, VkCommandBuffer *commands);
// Clears the window's image, in which copies may follow.
void swapchain_clear(struct swapchain *s);
// Begins and ends the render pass on top of it.
void swapchain_pass_begin(struct swapchain *s);
void swapchain_pass_end(struct swapchain *s);
// Copies the window's image to a mapped buffer of width × height × 4 bytes, after the pass.
void swapchain_copy(struct swapchain *s, VkBuffer to);
// Submits and presents.
bool swapchain_end(struct swapchain *s);
