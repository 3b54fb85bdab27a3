#include "gpu.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { MAX_EXTENSIONS = 16, MAX_DEVICES = 16, MAX_FAMILIES = 16 };

static VKAPI_ATTR VkBool32 VKAPI_CALL count_message(
    VkDebugUtilsMessageSeverityFlagBitsEXT severity, VkDebugUtilsMessageTypeFlagsEXT types,
    const VkDebugUtilsMessengerCallbackDataEXT *data, void *user)
{
    struct gpu *gpu = user;
    (void)severity;
    if (!(types & VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT)) return VK_FALSE;
    if (gpu->messages++ == 0) snprintf(gpu->message, sizeof gpu->message, "%s", data->pMessage);
    return VK_FALSE;
}

// ---- instance

static bool create_instance(struct gpu *gpu, bool validate, char error[512])
{
    static const char *const layers[] = { "VK_LAYER_KHRONOS_validation" };
    const char *extensions[MAX_EXTENSIONS];
    uint32_t count = 0;
    const char **wanted = window_extensions(&count);
    if (!wanted || count > MAX_EXTENSIONS - 2) count = 0;
    for (uint32_t i = 0; i < count; i++) extensions[i] = wanted[i];
    const VkValidationFeatureEnableEXT enable =
        VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT;
    const VkDebugUtilsMessengerCreateInfoEXT messenger = {
        .sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT,
        .messageSeverity = VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT |
                           VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT,
        .messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT,
        .pfnUserCallback = count_message,
        .pUserData = gpu,
    };
    const VkValidationFeaturesEXT features = {
        .sType = VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT,
        .pNext = &messenger,
        .enabledValidationFeatureCount = 1,
        .pEnabledValidationFeatures = &enable,
    };
    if (validate) {
        extensions[count++] = VK_EXT_DEBUG_UTILS_EXTENSION_NAME;
        extensions[count++] = VK_EXT_VALIDATION_FEATURES_EXTENSION_NAME;
    }
    const VkInstanceCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO,
        .pNext = validate ? &features : NULL,
        .pApplicationInfo = &(VkApplicationInfo){ .sType = VK_STRUCTURE_TYPE_APPLICATION_INFO,
                                                  .pApplicationName = "afterglow view",
                                                  .apiVersion = VK_API_VERSION_1_3 },
        .enabledLayerCount = validate ? 1 : 0,
        .ppEnabledLayerNames = layers,
        .enabledExtensionCount = count,
        .ppEnabledExtensionNames = extensions,
    };
    const VkResult result = vkCreateInstance(&info, NULL, &gpu->instance);
    if (result != VK_SUCCESS) {
        snprintf(error, 512, "cannot open Vulkan: vkCreateInstance gives %d%s", (int)result,
                 validate && result == VK_ERROR_LAYER_NOT_PRESENT
                     ? "; install the validation layers or unset AFTERGLOW_VALIDATION"
                     : "; install a Vulkan 1.3 driver");
        gpu->instance = VK_NULL_HANDLE;
        return false;
    }
    const PFN_vkCreateDebugUtilsMessengerEXT create =
        (PFN_vkCreateDebugUtilsMessengerEXT)vkGetInstanceProcAddr(gpu->instance,
                                                                  "vkCreateDebugUtilsMessengerEXT");
    return !validate || !create ||
           create(gpu->instance, &messenger, NULL, &gpu->messenger) == VK_SUCCESS;
}

// ---- the physical device

static bool presents(const struct gpu *gpu, VkPhysicalDevice physical, uint32_t *family)
{
    const VkQueueFlags wanted = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT;
    VkQueueFamilyProperties families[MAX_FAMILIES];
    uint32_t count = MAX_FAMILIES;
    vkGetPhysicalDeviceQueueFamilyProperties(physical, &count, families);
    for (uint32_t i = 0; i < count; i++) {
        VkBool32 shows = VK_FALSE;
        if ((families[i].queueFlags & wanted) != wanted) continue;
        vkGetPhysicalDeviceSurfaceSupportKHR(physical, i, gpu->surface, &shows);
        *family = i;
        if (shows) return true;
    }
    return false;
}

// Whether the name contains the text, or the number is the index in vkEnumeratePhysicalDevices.
static bool is_wanted(const VkPhysicalDeviceProperties *p, uint32_t index, const char *wanted)
{
    char *end;
    if (!wanted) return true;
    const long number = strtol(wanted, &end, 10);
    if (*wanted && !*end) return number == (long)index;
    return strstr(p->deviceName, wanted) != NULL;
}

static bool choose(struct gpu *gpu, const char *wanted, char error[512])
{
    VkPhysicalDevice devices[MAX_DEVICES];
    uint32_t count = MAX_DEVICES;
    bool software = true, found = false;
    vkEnumeratePhysicalDevices(gpu->instance, &count, devices);
    for (uint32_t i = 0; i < count; i++) {
        VkPhysicalDeviceProperties p;
        uint32_t family;
        vkGetPhysicalDeviceProperties(devices[i], &p);
        const bool cpu = p.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU;
        if (p.apiVersion < VK_API_VERSION_1_3 || !is_wanted(&p, i, wanted) ||
            !presents(gpu, devices[i], &family) || (found && (cpu || !software)))
            continue;
        gpu->physical = devices[i];
        gpu->family = family;
        software = cpu;
        found = true;
    }
    if (found) return true;
    snprintf(error, 512,
             "cannot find a Vulkan 1.3 device%s%s that shows images in a window: see "
             "afterglow list",
             wanted ? " called " : "", wanted ? wanted : "");
    return false;
}

// ---- the device

static bool create_device(struct gpu *gpu, char error[512])
{
    const float priority = 1;
    const char *extensions[MAX_EXTENSIONS] = { VK_KHR_SWAPCHAIN_EXTENSION_NAME };
    uint32_t count = 1;
    ag_vulkan_requirements_get(gpu->physical, &gpu->requirements);
    for (uint32_t i = 0; i < gpu->requirements.extension_count; i++)
        extensions[count++] = gpu->requirements.extensions[i];
    const VkDeviceQueueCreateInfo queue = {
        .sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO,
        .queueFamilyIndex = gpu->family,
        .queueCount = 1,
        .pQueuePriorities = &priority,
    };
    const VkDeviceCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
        .pNext = &gpu->requirements.features,
        .queueCreateInfoCount = 1,
        .pQueueCreateInfos = &queue,
        .enabledExtensionCount = count,
        .ppEnabledExtensionNames = extensions,
    };
    const VkResult result = vkCreateDevice(gpu->physical, &info, NULL, &gpu->device);
    if (result != VK_SUCCESS) {
        snprintf(error, 512,
                 "cannot open the Vulkan device: vkCreateDevice gives %d; 'afterglow list' shows "
                 "which devices are supported",
                 (int)result);
        gpu->device = VK_NULL_HANDLE;
        return false;
    }
    vkGetDeviceQueue(gpu->device, gpu->family, 0, &gpu->queue);
    return true;
}

bool gpu_open(struct gpu *gpu, struct window *window, const char *wanted, bool validate,
              char error[512])
{
    if (!create_instance(gpu, validate, error)) return false;
    if (!window_surface(window, gpu->instance, &gpu->surface)) {
        gpu->surface = VK_NULL_HANDLE;
        snprintf(error, 512, "cannot show Vulkan images in the window; use afterglow render");
        return false;
    }
    return choose(gpu, wanted, error) && create_device(gpu, error);
}

void gpu_close(struct gpu *gpu)
{
    if (!gpu->instance) return;
    const PFN_vkDestroyDebugUtilsMessengerEXT destroy =
        (PFN_vkDestroyDebugUtilsMessengerEXT)vkGetInstanceProcAddr(
            gpu->instance, "vkDestroyDebugUtilsMessengerEXT");
    if (gpu->device) vkDestroyDevice(gpu->device, NULL);
    vkDestroySurfaceKHR(gpu->instance, gpu->surface, NULL);
    if (gpu->messenger && destroy) destroy(gpu->instance, gpu->messenger, NULL);
    vkDestroyInstance(gpu->instance, NULL);
    gpu->instance = VK_NULL_HANDLE;
}

enum ag_result gpu_lend(const struct gpu *gpu, struct ag_context *context, struct ag_device **out)
{
    const struct ag_device_adopt adopt = ag_vulkan_adopt(
        gpu->instance, gpu->physical, gpu->device, gpu->queue, gpu->family, &gpu->requirements);
    struct ag_device_desc desc;
    ag_device_desc_default(&desc);
    desc.adopt = &adopt;
    return ag_device_create(context, &desc, out);
}

// ---- memory

int gpu_memory_type(const struct gpu *gpu, uint32_t allowed, VkMemoryPropertyFlags properties)
{
    VkPhysicalDeviceMemoryProperties p;
    vkGetPhysicalDeviceMemoryProperties(gpu->physical, &p);
    for (uint32_t i = 0; i < p.memoryTypeCount; i++)
        if ((allowed >> i & 1u) && (p.memoryTypes[i].propertyFlags & properties) == properties)
            return (int)i;
    return -1;
}

bool gpu_mapped_open(const struct gpu *gpu, VkDeviceSize size, struct gpu_mapped *out)
{
    const VkBufferCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO,
        .size = size,
        .usage = VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT,
    };
    VkMemoryRequirements needs;
    *out = (struct gpu_mapped){ .size = size };
    if (vkCreateBuffer(gpu->device, &info, NULL, &out->buffer) != VK_SUCCESS) return false;
    vkGetBufferMemoryRequirements(gpu->device, out->buffer, &needs);
    const int type =
        gpu_memory_type(gpu, needs.memoryTypeBits,
                        VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT);
    const VkMemoryAllocateInfo allocate = { .sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO,
                                            .allocationSize = needs.size,
                                            .memoryTypeIndex = (uint32_t)type };
    if (type >= 0 && vkAllocateMemory(gpu->device, &allocate, NULL, &out->memory) == VK_SUCCESS &&
        vkBindBufferMemory(gpu->device, out->buffer, out->memory, 0) == VK_SUCCESS &&
        vkMapMemory(gpu->device, out->memory, 0, VK_WHOLE_SIZE, 0, &out->bytes) == VK_SUCCESS)
        return true;
    gpu_mapped_close(gpu, out);
    return false;
}

void gpu_mapped_close(const struct gpu *gpu, struct gpu_mapped *mapped)
{
    vkDestroyBuffer(gpu->device, mapped->buffer, NULL);
    vkFreeMemory(gpu->device, mapped->memory, NULL);
    *mapped = (struct gpu_mapped){ 0 };
}

// ---- commands

void gpu_transition(VkCommandBuffer commands, VkImage image, VkImageLayout from, VkImageLayout to)
{
    const VkImageMemoryBarrier2 barrier = {
        .sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2,
        .srcStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
        .srcAccessMask = VK_ACCESS_2_MEMORY_WRITE_BIT,
        .dstStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
        .dstAccessMask = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT,
        .oldLayout = from,
        .newLayout = to,
        .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
        .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
        .image = image,
        .subresourceRange = { VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1 },
    };
    const VkDependencyInfo info = { .sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO,
                                    .imageMemoryBarrierCount = 1,
                                    .pImageMemoryBarriers = &barrier };
    vkCmdPipelineBarrier2(commands, &info);
}
