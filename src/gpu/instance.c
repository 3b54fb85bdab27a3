// The Vulkan instance, and the messenger that counts validation messages.
#include "gpu/vk.h"

#include <string.h>

static const char validation_layer[] = "VK_LAYER_KHRONOS_validation";

static bool has_layer(const struct vulkan_functions *vk, const char *name)
{
    VkLayerProperties layers[64];
    uint32_t count = sizeof layers / sizeof *layers;
    VkResult result = vk->EnumerateInstanceLayerProperties(&count, layers);
    if (result != VK_SUCCESS && result != VK_INCOMPLETE) return false;
    for (uint32_t i = 0; i < count; i++) {
        if (strcmp(layers[i].layerName, name) == 0) return true;
    }
    return false;
}

static bool has_extension(const struct vulkan_functions *vk, const char *layer, const char *name)
{
    VkExtensionProperties extensions[128];
    uint32_t count = sizeof extensions / sizeof *extensions;
    VkResult result = vk->EnumerateInstanceExtensionProperties(layer, &count, extensions);
    if (result != VK_SUCCESS && result != VK_INCOMPLETE) return false;
    for (uint32_t i = 0; i < count; i++) {
        if (strcmp(extensions[i].extensionName, name) == 0) return true;
    }
    return false;
}

static bool check_validation(struct host *host, const struct vulkan_functions *vk)
{
    if (!has_layer(vk, validation_layer)) {
        return host_fail(host, FAIL_UNSUPPORTED,
                         "gpu validation: %s is not installed (Debian: vulkan-validationlayers); "
                         "install it or ask for no validation",
                         validation_layer);
    }
    if (!has_extension(vk, validation_layer, VK_EXT_VALIDATION_FEATURES_EXTENSION_NAME)) {
        return host_fail(host, FAIL_UNSUPPORTED,
                         "gpu validation: %s is too old for synchronization validation",
                         validation_layer);
    }
    return true;
}

static bool check_version(struct host *host, const struct vulkan_functions *vk)
{
    uint32_t version = 0;
    if (vk->EnumerateInstanceVersion(&version) != VK_SUCCESS || version < VK_API_VERSION_1_3) {
        return host_fail(host, FAIL_UNSUPPORTED,
                         "gpu instance: the Vulkan loader knows version %u.%u, 1.3 is needed",
                         VK_API_VERSION_MAJOR(version), VK_API_VERSION_MINOR(version));
    }
    return true;
}

static bool load_functions(struct host *host, struct vulkan_functions *vk, VkInstance *instance)
{
    const char *missing = vulkan_load_instance(vk, *instance, NULL);
    if (!missing) return true;
    if (vk->DestroyInstance) vk->DestroyInstance(*instance, NULL);
    *instance = VK_NULL_HANDLE;
    return vk_missing(host, missing);
}

bool instance_create(struct host *host, bool validation, struct vulkan_functions *vk,
                     VkInstance *out)
{
    *out = VK_NULL_HANDLE;
    const char *missing = vulkan_load_global(vk);
    if (missing) return vk_missing(host, missing);
    if (!check_version(host, vk) || (validation && !check_validation(host, vk))) return false;

    const char *extensions[3];
    uint32_t count = 0;
    VkInstanceCreateFlags flags = 0;
    if (has_extension(vk, NULL, VK_EXT_DEBUG_UTILS_EXTENSION_NAME)) {
        extensions[count++] = VK_EXT_DEBUG_UTILS_EXTENSION_NAME;
    }
    if (has_extension(vk, NULL, VK_KHR_PORTABILITY_ENUMERATION_EXTENSION_NAME)) {
        extensions[count++] = VK_KHR_PORTABILITY_ENUMERATION_EXTENSION_NAME;
        flags |= VK_INSTANCE_CREATE_ENUMERATE_PORTABILITY_BIT_KHR;
    }
    if (validation) extensions[count++] = VK_EXT_VALIDATION_FEATURES_EXTENSION_NAME;

    VkValidationFeaturesEXT features = {
        .sType = VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT,
        .enabledValidationFeatureCount = 1,
        .pEnabledValidationFeatures =
            (VkValidationFeatureEnableEXT[]){
                VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT },
    };
    VkResult result = vk->CreateInstance(
        &(VkInstanceCreateInfo){
            .sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO,
            .pNext = validation ? &features : NULL,
            .flags = flags,
            .pApplicationInfo = &(VkApplicationInfo){ .sType = VK_STRUCTURE_TYPE_APPLICATION_INFO,
                                                      .pApplicationName = "afterglow",
                                                      .pEngineName = "afterglow",
                                                      .apiVersion = VK_API_VERSION_1_3 },
            .enabledLayerCount = validation ? 1 : 0,
            .ppEnabledLayerNames = (const char *[]){ validation_layer },
            .enabledExtensionCount = count,
            .ppEnabledExtensionNames = extensions,
        },
        NULL, out);
    if (result == VK_SUCCESS) return load_functions(host, vk, out);
    *out = VK_NULL_HANDLE;
    return host_fail(host, FAIL_UNSUPPORTED, "gpu instance: no Vulkan driver can be used (%s); %s",
                     vk_result_name(result), GPU_DRIVER_HINT);
}

// About installed drivers and layers, or functions that the loader itself asks for: some loaders
// ask each device for an instance's function of video encoding. Not about our calls.
static bool is_of_the_loader(const VkDebugUtilsMessengerCallbackDataEXT *data)
{
    if (!data->pMessageIdName) return false;
    return strcmp(data->pMessageIdName, "Loader Message") == 0 ||
           (strstr(data->pMessageIdName, "vkGetDeviceProcAddr") &&
            strstr(data->pMessage, "VideoEncode"));
}

static VKAPI_ATTR VkBool32 VKAPI_CALL on_message(VkDebugUtilsMessageSeverityFlagBitsEXT severity,
                                                 VkDebugUtilsMessageTypeFlagsEXT type,
                                                 const VkDebugUtilsMessengerCallbackDataEXT *data,
                                                 void *user)
{
    struct gpu *gpu = user;
    (void)type;
    if (is_of_the_loader(data)) {
        host_log(gpu->host, LOG_DEBUG, "gpu loader: %s", data->pMessage);
        return VK_FALSE;
    }
    gpu->validation_messages++;
    // Logged as a warning, since the call itself may still succeed.
    host_log(gpu->host, LOG_WARNING, "gpu validation %s: %s",
             severity >= VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT ? "error" : "warning",
             data->pMessage);
    return VK_FALSE;
}

bool instance_watch(struct gpu *gpu)
{
    if (!gpu->vk.CreateDebugUtilsMessengerEXT || !gpu->vk.DestroyDebugUtilsMessengerEXT) {
        return host_fail(gpu->host, FAIL_UNSUPPORTED,
                         "gpu validation: the instance lacks %s (an adopted one must enable it, "
                         "and %s, itself)",
                         VK_EXT_DEBUG_UTILS_EXTENSION_NAME, validation_layer);
    }
    // Not PERFORMANCE: its advice is vendor-specific, and storage images are in the general layout.
    return VK_CALL(gpu, CreateDebugUtilsMessengerEXT, gpu->instance,
                   &(VkDebugUtilsMessengerCreateInfoEXT){
                       .sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT,
                       .messageSeverity = VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT |
                                          VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT,
                       .messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_GENERAL_BIT_EXT |
                                      VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT,
                       .pfnUserCallback = on_message,
                       .pUserData = gpu,
                   },
                   NULL, &gpu->messenger);
}
