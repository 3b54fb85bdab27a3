// Features that a device must be created with, in Vulkan's types. Only this file of api/ has them.
#include "api/objects.h"

#include "gpu/gpu.h"

#include <afterglow/vulkan.h>

static void fill(VkInstance instance, VkPhysicalDevice physical,
                 PFN_vkGetInstanceProcAddr get_instance_proc_addr,
                 struct ag_vulkan_requirements *out)
{
    out->extension_count = gpu_fill_requirements(
        (void *)instance, (void *)physical, (void (*)(void))get_instance_proc_addr, &out->features,
        &out->vulkan11, &out->vulkan12, &out->vulkan13, out->extensions);
}

void ag_vulkan_requirements_get(VkPhysicalDevice physical, struct ag_vulkan_requirements *out)
{
    if (!out) return;
    *out = (struct ag_vulkan_requirements){ .extension_count = 0 };
    if (physical) fill(VK_NULL_HANDLE, physical, NULL, out);
}

void ag_vulkan_requirements_get_with(VkInstance instance, VkPhysicalDevice physical,
                                     PFN_vkGetInstanceProcAddr get_instance_proc_addr,
                                     struct ag_vulkan_requirements *out)
{
    if (!out) return;
    *out = (struct ag_vulkan_requirements){ .extension_count = 0 };
    if (instance && physical) fill(instance, physical, get_instance_proc_addr, out);
}
