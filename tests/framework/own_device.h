// A program's own Vulkan device, made with plain vulkan.h and lent to the library.
#pragma once

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

enum own_device_flags {
    OWN_DEVICE_VALIDATION = 1,         // validation and synchronization validation
    OWN_DEVICE_NO_PUSH_DESCRIPTORS = 2 // without the extension that the library needs
};

// With the features that the library asks for. Fails the test where it cannot.
void own_device_open(struct own_device *own, uint32_t flags);
void own_device_close(struct own_device *own);

// The queue's lock, to be lent with `own` as the user: counts, and fails the test when it is taken
// twice.
void own_device_lock(void *own);
void own_device_unlock(void *own);

// A command buffer, begun.
VkCommandBuffer own_device_begin(struct own_device *own);
// Ends and submits it.
void own_device_submit(struct own_device *own, VkCommandBuffer commands);
// Ends and submits it, and waits.
void own_device_run(struct own_device *own, VkCommandBuffer commands);
