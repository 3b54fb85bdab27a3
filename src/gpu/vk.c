// Results of Vulkan calls, API misuse, and debug names.
#include "gpu/vk.h"

#include <assert.h>
#include <stdio.h>

const char *vk_result_name(VkResult result)
{
    switch (result) {
    case VK_SUCCESS:
        return "success";
    case VK_NOT_READY:
        return "not ready";
    case VK_TIMEOUT:
        return "timeout";
    case VK_INCOMPLETE:
        return "incomplete";
    case VK_ERROR_OUT_OF_HOST_MEMORY:
        return "out of host memory";
    case VK_ERROR_OUT_OF_DEVICE_MEMORY:
        return "out of device memory";
    case VK_ERROR_INITIALIZATION_FAILED:
        return "initialization failed";
    case VK_ERROR_DEVICE_LOST:
        return "the device was lost";
    case VK_ERROR_MEMORY_MAP_FAILED:
        return "memory cannot be mapped";
    case VK_ERROR_LAYER_NOT_PRESENT:
        return "a layer is not present";
    case VK_ERROR_EXTENSION_NOT_PRESENT:
        return "an extension is not present";
    case VK_ERROR_FEATURE_NOT_PRESENT:
        return "a feature is not present";
    case VK_ERROR_INCOMPATIBLE_DRIVER:
        return "no compatible driver";
    case VK_ERROR_TOO_MANY_OBJECTS:
        return "too many objects";
    case VK_ERROR_FORMAT_NOT_SUPPORTED:
        return "the format is not supported";
    default:
        return "an unexpected result";
    }
}

static enum fail_kind kind_of(VkResult result)
{
    switch (result) {
    case VK_ERROR_OUT_OF_HOST_MEMORY:
    case VK_ERROR_OUT_OF_DEVICE_MEMORY:
        return FAIL_MEMORY;
    case VK_ERROR_LAYER_NOT_PRESENT:
    case VK_ERROR_EXTENSION_NOT_PRESENT:
    case VK_ERROR_FEATURE_NOT_PRESENT:
    case VK_ERROR_INCOMPATIBLE_DRIVER:
    case VK_ERROR_FORMAT_NOT_SUPPORTED:
        return FAIL_UNSUPPORTED;
    default:
        return FAIL_DEVICE;
    }
}

bool vk_check(struct gpu *gpu, VkResult result, const char *function)
{
    if (result == VK_SUCCESS) return true;
    if (result == VK_ERROR_DEVICE_LOST) gpu->lost = true;
    return host_fail(gpu->host, kind_of(result), "gpu %s: %s (%d)", function,
                     vk_result_name(result), (int)result);
}

bool vk_missing(struct host *host, const char *function)
{
    return host_fail(host, FAIL_UNSUPPORTED,
                     "gpu %s: the Vulkan loader (get_instance_proc_addr of an adopted device) does "
                     "not have it; create instance and device for Vulkan 1.3",
                     function);
}

bool gpu_misuse(struct gpu *gpu, const char *format, ...)
{
    char text[512];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    host_fail(gpu->host, FAIL_ARGUMENT, "gpu %s", text);
    if (gpu->recording) gpu->recording->broken = true;
    assert(!"misuse of the gpu module; the log says how");
    return false;
}

void vk_name(struct gpu *gpu, VkObjectType type, uint64_t handle, const char *name)
{
    if (!gpu->vk.SetDebugUtilsObjectNameEXT || !handle || !name) return;
    gpu->vk.SetDebugUtilsObjectNameEXT(
        gpu->device, &(VkDebugUtilsObjectNameInfoEXT){
                         .sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_OBJECT_NAME_INFO_EXT,
                         .objectType = type,
                         .objectHandle = handle,
                         .pObjectName = name,
                     });
}
