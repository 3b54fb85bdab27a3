// A Vulkan device as a program has it, created with what the library requires.
#ifndef HOST_DEVICE_H
#define HOST_DEVICE_H

#include <afterglow/vulkan.h>

struct host_device {
    VkInstance instance;
    VkDebugUtilsMessengerEXT messenger;
    VkPhysicalDevice physical;
    VkDevice device;
    VkQueue queue;
    uint32_t family;
    struct ag_vulkan_requirements requirements;
    int messages; // of the validation layer
};

// Ends the program with a sentence unless the result is VK_SUCCESS.
void host_check(VkResult result, const char *what);
// `validate`: with the validation layer and its synchronization validation. Stays at its address.
void host_device_create(struct host_device *host, bool validate);
// When all that uses the device has been destroyed, the library's objects too.
void host_device_destroy(struct host_device *host);
// The device as the library's.
enum ag_result host_device_lend(const struct host_device *host, struct ag_context *context,
                                struct ag_device **out);

void host_allocate(const struct host_device *host, const VkMemoryRequirements *needs,
                   VkMemoryPropertyFlags wanted, VkDeviceMemory *out);
struct mapped_buffer {
    VkBuffer buffer;
    VkDeviceMemory memory;
    void *bytes;
};
void mapped_buffer_create(const struct host_device *host, VkDeviceSize bytes,
                          VkBufferUsageFlags usage, struct mapped_buffer *out);
void mapped_buffer_destroy(const struct host_device *host, const struct mapped_buffer *buffer);

// Orders everything before it ahead of everything after it, and the host's reads.
void host_barrier(VkCommandBuffer commands, VkImage image, VkImageAspectFlags aspect,
                  VkImageLayout from, VkImageLayout to);

#endif
