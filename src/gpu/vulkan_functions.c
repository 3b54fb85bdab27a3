// Loads the Vulkan functions that the layer calls.
#include "gpu/vulkan_functions.h"

#include <stddef.h>

// src/gpu is compiled without the prototypes of vulkan.h, so that no other function is called.
VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL vkGetInstanceProcAddr(VkInstance instance,
                                                               const char *name);

#define FROM_INSTANCE(name) vk->name = (PFN_vk##name)get(instance, "vk" #name);
#define FROM_DEVICE(name)   vk->name = (PFN_vk##name)vk->GetDeviceProcAddr(device, "vk" #name);
#define REQUIRE(name)                                                                              \
    if (!vk->name) return "vk" #name;

const char *vulkan_load_global(struct vulkan_functions *vk)
{
    const PFN_vkGetInstanceProcAddr get = vkGetInstanceProcAddr;
    const VkInstance instance = VK_NULL_HANDLE;
    VULKAN_GLOBAL_FUNCTIONS(FROM_INSTANCE)
    VULKAN_GLOBAL_FUNCTIONS(REQUIRE)
    return NULL;
}

const char *vulkan_load_instance(struct vulkan_functions *vk, VkInstance instance,
                                 PFN_vkGetInstanceProcAddr get)
{
    if (!get) get = vkGetInstanceProcAddr;
    VULKAN_INSTANCE_FUNCTIONS(FROM_INSTANCE)
    VULKAN_INSTANCE_EXTENSION_FUNCTIONS(FROM_INSTANCE)
    VULKAN_INSTANCE_FUNCTIONS(REQUIRE)
    return NULL;
}

const char *vulkan_load_device(struct vulkan_functions *vk, VkDevice device)
{
    VULKAN_DEVICE_FUNCTIONS(FROM_DEVICE)
    VULKAN_DEVICE_EXTENSION_FUNCTIONS(FROM_DEVICE)
    VULKAN_DEVICE_FUNCTIONS(REQUIRE)
    return NULL;
}
