// A program's own Vulkan device, made with plain vulkan.h and lent to the library.
#pragma once

#include <afterglow/device.h>

#include <vulkan/vulkan.h>

struct own_device {
    VkInstance instance;
    VkPhysicalDevice physical;
    VkDevice device;
    VkQueue queue;
    VkCommandPool pool;
    uint32_t family;
    int locks, held; // the queue's lock, counted
};

void own_device_open(struct own_device *own); // fails the test where it cannot
void own_device_close(struct own_device *own);
struct ag_device_adopt own_device_lend(struct own_device *own);
VkCommandBuffer own_device_begin(struct own_device *own);
// Ends, submits and waits.
void own_device_run(struct own_device *own, VkCommandBuffer commands);
