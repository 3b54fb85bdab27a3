/// Vulkan types, for programs that share a device with the library: what a device needs, and typed
/// handles. Optional: afterglow.h does not include it.
#ifndef AFTERGLOW_VULKAN_H
#define AFTERGLOW_VULKAN_H

#include <afterglow/renderer.h>

#include <vulkan/vulkan.h>

#include <string.h>

AG_BEGIN

/// Features that a device must be created with: `features` is the pNext of VkDeviceCreateInfo
/// (without pEnabledFeatures). The structs are chained in this order; set further features in them,
/// append further structs to vulkan13.pNext. Do not copy or move the struct.
struct ag_vulkan_requirements {
    VkPhysicalDeviceFeatures2 features;
    VkPhysicalDeviceVulkan11Features vulkan11;
    VkPhysicalDeviceVulkan12Features vulkan12;
    VkPhysicalDeviceVulkan13Features vulkan13;
    const char *extensions[2]; ///< static strings
    uint32_t extension_count;
};
/// For a device of a Vulkan 1.3 instance. `usable` of ag_device_info tells which devices have all.
/// Thread: any.
AG_API void ag_vulkan_requirements_get(VkPhysicalDevice physical_device,
                                       struct ag_vulkan_requirements *out);
/// The same with the functions of ag_device_adopt.get_instance_proc_addr. extension_count is 0 if
/// it lacks one. Thread: any.
AG_API void ag_vulkan_requirements_get_with(VkInstance instance, VkPhysicalDevice physical_device,
                                            PFN_vkGetInstanceProcAddr get_instance_proc_addr,
                                            struct ag_vulkan_requirements *out);

/// ag_device_adopt with the linked loader, without a queue lock and an upload queue. requirements:
/// those that the device was created with.
static inline struct ag_device_adopt
ag_vulkan_adopt(VkInstance instance, VkPhysicalDevice physical_device, VkDevice device,
                VkQueue queue, uint32_t queue_family,
                const struct ag_vulkan_requirements *requirements)
{
    struct ag_device_adopt adopt;
    memset(&adopt, 0, sizeof adopt);
    adopt.instance = (void *)instance;
    adopt.physical_device = (void *)physical_device;
    adopt.device = (void *)device;
    adopt.queue = (void *)queue;
    adopt.queue_family = queue_family;
    adopt.vk_enabled_features = requirements ? &requirements->features : NULL;
    return adopt;
}

static inline VkImage ag_vulkan_image(const struct ag_layer_handle *layer)
{
    return (VkImage)layer->vk_image;
}

static inline VkImageView ag_vulkan_image_view(const struct ag_layer_handle *layer)
{
    return (VkImageView)layer->vk_image_view;
}

static inline VkFormat ag_vulkan_format(const struct ag_layer_handle *layer)
{
    return (VkFormat)layer->vk_format;
}

static inline VkImageLayout ag_vulkan_layout(const struct ag_layer_handle *layer)
{
    return (VkImageLayout)layer->vk_layout;
}

AG_END

#endif
