// A Vulkan device as a program has it, and the few helpers of its frames.
#include "host_device.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void host_check(VkResult result, const char *what)
{
    if (result == VK_SUCCESS) return;
    fprintf(stderr, "%s: VkResult %d\n", what, (int)result);
    exit(1);
}

// ---- the device

static VKAPI_ATTR VkBool32 VKAPI_CALL count_message(
    VkDebugUtilsMessageSeverityFlagBitsEXT severity, VkDebugUtilsMessageTypeFlagsEXT types,
    const VkDebugUtilsMessengerCallbackDataEXT *data, void *user)
{
    struct host_device *host = (struct host_device *)user;
    (void)severity;
    if (!(types & VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT)) return VK_FALSE;
    fprintf(stderr, "validation: %s\n", data->pMessage);
    host->messages++;
    return VK_FALSE;
}

static void create_instance(struct host_device *host, bool validate)
{
    const char *layers[] = { "VK_LAYER_KHRONOS_validation" };
    const char *extensions[] = { "VK_EXT_debug_utils", "VK_EXT_validation_features" };
    const VkValidationFeatureEnableEXT enable =
        VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT;
    VkDebugUtilsMessengerCreateInfoEXT messenger;
    memset(&messenger, 0, sizeof messenger);
    messenger.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT;
    messenger.messageSeverity = VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT |
                                VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
    messenger.messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT;
    messenger.pfnUserCallback = count_message;
    messenger.pUserData = host;
    VkValidationFeaturesEXT features;
    memset(&features, 0, sizeof features);
    features.sType = VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT;
    features.pNext = &messenger; // messages of vkCreateInstance and vkDestroyInstance
    features.enabledValidationFeatureCount = 1;
    features.pEnabledValidationFeatures = &enable;
    VkApplicationInfo application;
    memset(&application, 0, sizeof application);
    application.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO;
    application.apiVersion = VK_API_VERSION_1_3;
    VkInstanceCreateInfo info;
    memset(&info, 0, sizeof info);
    info.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO;
    info.pApplicationInfo = &application;
    if (validate) {
        info.pNext = &features;
        info.enabledLayerCount = 1;
        info.ppEnabledLayerNames = layers;
        info.enabledExtensionCount = 2;
        info.ppEnabledExtensionNames = extensions;
    }
    host_check(vkCreateInstance(&info, NULL, &host->instance), "vkCreateInstance");
    if (!validate) return;
    const PFN_vkCreateDebugUtilsMessengerEXT create =
        (PFN_vkCreateDebugUtilsMessengerEXT)vkGetInstanceProcAddr(host->instance,
                                                                  "vkCreateDebugUtilsMessengerEXT");
    host_check(create(host->instance, &messenger, NULL, &host->messenger), "messenger");
}

static void destroy_messenger(struct host_device *host)
{
    if (!host->messenger) return;
    const PFN_vkDestroyDebugUtilsMessengerEXT destroy =
        (PFN_vkDestroyDebugUtilsMessengerEXT)vkGetInstanceProcAddr(
            host->instance, "vkDestroyDebugUtilsMessengerEXT");
    destroy(host->instance, host->messenger, NULL);
}

// The first device, with a queue family that draws and computes. The library's requirements are
// the start of the host's own.
static void create_device(struct host_device *host)
{
    uint32_t count = 1;
    vkEnumeratePhysicalDevices(host->instance, &count, &host->physical);
    host_check(count == 1 ? VK_SUCCESS : VK_ERROR_INITIALIZATION_FAILED, "no Vulkan device");
    VkQueueFamilyProperties families[16];
    const VkQueueFlags wanted = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT;
    count = 16;
    vkGetPhysicalDeviceQueueFamilyProperties(host->physical, &count, families);
    while (host->family < count && (families[host->family].queueFlags & wanted) != wanted)
        host->family++;
    ag_vulkan_requirements_get(host->physical, &host->requirements);

    const float priority = 1;
    VkDeviceQueueCreateInfo queue;
    memset(&queue, 0, sizeof queue);
    queue.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO;
    queue.queueFamilyIndex = host->family;
    queue.queueCount = 1;
    queue.pQueuePriorities = &priority;
    VkDeviceCreateInfo info;
    memset(&info, 0, sizeof info);
    info.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO;
    info.pNext = &host->requirements.features;
    info.queueCreateInfoCount = 1;
    info.pQueueCreateInfos = &queue;
    info.enabledExtensionCount = host->requirements.extension_count;
    info.ppEnabledExtensionNames = host->requirements.extensions;
    host_check(vkCreateDevice(host->physical, &info, NULL, &host->device), "vkCreateDevice");
    vkGetDeviceQueue(host->device, host->family, 0, &host->queue);
}

void host_device_create(struct host_device *host, bool validate)
{
    memset(host, 0, sizeof *host);
    create_instance(host, validate);
    create_device(host);
}

void host_device_destroy(struct host_device *host)
{
    vkDestroyDevice(host->device, NULL);
    destroy_messenger(host);
    vkDestroyInstance(host->instance, NULL);
}

enum ag_result host_device_lend(const struct host_device *host, struct ag_context *context,
                                struct ag_device **out)
{
    const struct ag_device_adopt adopt =
        ag_vulkan_adopt(host->instance, host->physical, host->device, host->queue, host->family,
                        &host->requirements);
    struct ag_device_desc desc;
    ag_device_desc_default(&desc);
    desc.adopt = &adopt;
    return ag_device_create(context, &desc, out);
}

// ---- memory

void host_allocate(const struct host_device *host, const VkMemoryRequirements *needs,
                   VkMemoryPropertyFlags wanted, VkDeviceMemory *out)
{
    VkPhysicalDeviceMemoryProperties p;
    vkGetPhysicalDeviceMemoryProperties(host->physical, &p);
    uint32_t i = 0;
    while (
        !((needs->memoryTypeBits >> i & 1u) && (p.memoryTypes[i].propertyFlags & wanted) == wanted))
        i++; // Vulkan guarantees that there is one
    VkMemoryAllocateInfo info;
    memset(&info, 0, sizeof info);
    info.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO;
    info.allocationSize = needs->size;
    info.memoryTypeIndex = i;
    host_check(vkAllocateMemory(host->device, &info, NULL, out), "vkAllocateMemory");
}

void mapped_buffer_create(const struct host_device *host, VkDeviceSize bytes,
                          VkBufferUsageFlags usage, struct mapped_buffer *out)
{
    VkBufferCreateInfo info;
    memset(&info, 0, sizeof info);
    info.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO;
    info.size = bytes;
    info.usage = usage;
    host_check(vkCreateBuffer(host->device, &info, NULL, &out->buffer), "vkCreateBuffer");
    VkMemoryRequirements needs;
    vkGetBufferMemoryRequirements(host->device, out->buffer, &needs);
    host_allocate(host, &needs,
                  VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT,
                  &out->memory);
    host_check(vkBindBufferMemory(host->device, out->buffer, out->memory, 0), "vkBindBufferMemory");
    host_check(vkMapMemory(host->device, out->memory, 0, VK_WHOLE_SIZE, 0, &out->bytes),
               "vkMapMemory");
}

void mapped_buffer_destroy(const struct host_device *host, const struct mapped_buffer *buffer)
{
    vkDestroyBuffer(host->device, buffer->buffer, NULL);
    vkFreeMemory(host->device, buffer->memory, NULL);
}

// ---- commands

void host_barrier(VkCommandBuffer commands, VkImage image, VkImageAspectFlags aspect,
                  VkImageLayout from, VkImageLayout to)
{
    VkMemoryBarrier2 memory;
    memset(&memory, 0, sizeof memory);
    memory.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER_2;
    memory.srcStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
    memory.srcAccessMask = VK_ACCESS_2_MEMORY_WRITE_BIT;
    memory.dstStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT | VK_PIPELINE_STAGE_2_HOST_BIT;
    memory.dstAccessMask = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_HOST_READ_BIT;
    VkImageMemoryBarrier2 layout;
    memset(&layout, 0, sizeof layout);
    layout.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2;
    layout.srcStageMask = layout.dstStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
    layout.srcAccessMask = VK_ACCESS_2_MEMORY_WRITE_BIT;
    layout.dstAccessMask = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT;
    layout.oldLayout = from;
    layout.newLayout = to;
    layout.srcQueueFamilyIndex = layout.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    layout.image = image;
    layout.subresourceRange.aspectMask = aspect;
    layout.subresourceRange.levelCount = layout.subresourceRange.layerCount = 1;
    VkDependencyInfo info;
    memset(&info, 0, sizeof info);
    info.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO;
    info.memoryBarrierCount = 1;
    info.pMemoryBarriers = &memory;
    info.imageMemoryBarrierCount = 1;
    info.pImageMemoryBarriers = &layout;
    vkCmdPipelineBarrier2(commands, &info);
}
