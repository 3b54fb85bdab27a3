// Features that a device must be created with, in Vulkan's types. Only this file of api/ has them.
#include "api/objects.h"

#include "gpu/gpu.h"

#include <afterglow/vulkan.h>

void ag_vulkan_requirements_get(VkPhysicalDevice physical, struct ag_vulkan_requirements *out)
{
    if (!out) return;
    *out = (struct ag_vulkan_requirements){ .extension_count = 0 };
    if (!physical) return;
    out->extension_count = gpu_fill_requirements((void *)physical, &out->features, &out->vulkan11,
                                                 &out->vulkan12, &out->vulkan13, out->extensions);
}
