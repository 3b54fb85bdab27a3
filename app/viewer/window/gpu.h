// The viewer's Vulkan device, which it lends to the library, and its messages.
#pragma once

#include "window.h"

#include <afterglow/afterglow.h>
#include <afterglow/vulkan.h>

struct gpu {
    VkInstance instance;
    VkSurfaceKHR surface;
    VkPhysicalDevice physical;
    VkDevice device;
    VkQueue queue;
    uint32_t family;
    VkDebugUtilsMessengerEXT messenger; // with validation
    int messages;                       // of validation
    char message[512];                  // the first one
    struct ag_vulkan_requirements requirements;
};

// Creates instance, surface and device: that with `wanted` in its name or as its number, else the
// first that is not software, else the first. validate: with the validation layers. On failure
// `error` has a sentence; gpu_close accepts what is there.
bool gpu_open(struct gpu *gpu, struct window *window, const char *wanted, bool validate,
              char error[512]);
void gpu_close(struct gpu *gpu);
enum ag_result gpu_lend(const struct gpu *gpu, struct ag_context *context, struct ag_device **out);

// Memory type with these properties; -1: none.
int gpu_memory_type(const struct gpu *gpu, uint32_t allowed, VkMemoryPropertyFlags properties);

// A buffer that the host writes or reads, mapped while it lives.
struct gpu_mapped {
    VkBuffer buffer;
    VkDeviceMemory memory;
    void *bytes;
    VkDeviceSize size;
};
bool gpu_mapped_open(const struct gpu *gpu, VkDeviceSize size, struct gpu_mapped *out);
void gpu_mapped_close(const struct gpu *gpu, struct gpu_mapped *mapped);

// Changes the layout of a color image, between all earlier and all later commands.
void gpu_transition(VkCommandBuffer commands, VkImage image, VkImageLayout from, VkImageLayout to);
