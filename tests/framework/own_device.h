// A host program's Vulkan device, created with plain vulkan.h, for tests of external devices.
#pragma once

#include <stdbool.h>

#include <vulkan/vulkan.h>

struct own_device {
    VkInstance instance;
    VkPhysicalDevice physical;
    VkDevice device;
    VkQueue queue;
    // The second queue of the family. `queue` if there is none, or if validation cannot follow two.
    VkQueue upload_queue;
    VkCommandPool pool;
    uint32_t family;
    bool validation;
    int locks, held; // queue lock: times taken, times held now
};

enum own_device_flags {
    OWN_DEVICE_VALIDATION = 1,         // validation and synchronization validation
    OWN_DEVICE_NO_PUSH_DESCRIPTORS = 2 // without the extension that the library needs
};

// With the features that the library requires. Fails the test on an error.
void own_device_open(struct own_device *own, uint32_t flags);
void own_device_close(struct own_device *own);

// Queue lock callbacks, with `own` as the user pointer. A recursive lock fails the test.
void own_device_lock(void *own);
void own_device_unlock(void *own);

// A command buffer in the recording state.
VkCommandBuffer own_device_begin(struct own_device *own);
// Ends and submits it.
void own_device_submit(struct own_device *own, VkCommandBuffer commands);
// Ends and submits it, and waits.
void own_device_run(struct own_device *own, VkCommandBuffer commands);
