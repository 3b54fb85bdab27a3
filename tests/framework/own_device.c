#include "framework/own_device.h"

#include "framework/test.h"

#include <string.h>

#define CHECK_VK(call) assert_int_equal((call), VK_SUCCESS)

static const char *const validation_layer = "VK_LAYER_KHRONOS_validation";

static void create_instance(struct own_device *own, bool validation)
{
    const char *layers[] = { validation_layer };
    const char *extensions[] = { "VK_EXT_debug_utils", "VK_EXT_validation_features" };
    const VkValidationFeatureEnableEXT enable =
        VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT;
    const VkValidationFeaturesEXT features = { .sType = VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT,
                                               .enabledValidationFeatureCount = 1,
                                               .pEnabledValidationFeatures = &enable };
    const VkApplicationInfo application = { .sType = VK_STRUCTURE_TYPE_APPLICATION_INFO,
                                            .apiVersion = VK_API_VERSION_1_3 };
    const VkInstanceCreateInfo info = { .sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO,
                                        .pNext = validation ? &features : NULL,
                                        .pApplicationInfo = &application,
                                        .enabledLayerCount = validation ? 1 : 0,
                                        .ppEnabledLayerNames = layers,
                                        .enabledExtensionCount = validation ? 2 : 1,
                                        .ppEnabledExtensionNames = extensions };
    CHECK_VK(vkCreateInstance(&info, NULL, &own->instance));
}

// Synchronization validation of layers before 1.4 does not know timeline semaphores, and reports
// hazards between queues that they order.
static bool layer_knows_timelines(void)
{
    VkLayerProperties layers[64];
    uint32_t count = 64;
    vkEnumerateInstanceLayerProperties(&count, layers);
    for (uint32_t i = 0; i < count; i++)
        if (strcmp(layers[i].layerName, validation_layer) == 0)
            return layers[i].specVersion >= VK_MAKE_API_VERSION(0, 1, 4, 0);
    return false;
}

// With the features that ag_device_required_features and gpu_required_features list.
static void create_device(struct own_device *own, uint32_t queue_count, bool push_descriptors)
{
    VkPhysicalDeviceVulkan13Features v13 = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES,
        .dynamicRendering = VK_TRUE,
        .synchronization2 = VK_TRUE,
        .maintenance4 = VK_TRUE,
        .shaderDemoteToHelperInvocation = VK_TRUE,
        .shaderTerminateInvocation = VK_TRUE
    };
    VkPhysicalDeviceVulkan12Features v12 = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES,
        .pNext = &v13,
        .scalarBlockLayout = VK_TRUE,
        .timelineSemaphore = VK_TRUE,
        .hostQueryReset = VK_TRUE
    };
    VkPhysicalDeviceVulkan11Features v11 = {
        .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_1_FEATURES,
        .pNext = &v12,
        .shaderDrawParameters = VK_TRUE
    };
    const VkPhysicalDeviceFeatures core = { .imageCubeArray = VK_TRUE,
                                            .independentBlend = VK_TRUE,
                                            .depthClamp = VK_TRUE,
                                            .fragmentStoresAndAtomics = VK_TRUE,
                                            .shaderStorageImageExtendedFormats = VK_TRUE,
                                            .shaderStorageImageWriteWithoutFormat = VK_TRUE };
    const char *extension = "VK_KHR_push_descriptor";
    const float priorities[2] = { 1, 1 };
    const VkDeviceQueueCreateInfo queue = { .sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO,
                                            .queueFamilyIndex = own->family,
                                            .queueCount = queue_count,
                                            .pQueuePriorities = priorities };
    const VkDeviceCreateInfo info = { .sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
                                      .pNext = &v11,
                                      .queueCreateInfoCount = 1,
                                      .pQueueCreateInfos = &queue,
                                      .enabledExtensionCount = push_descriptors,
                                      .ppEnabledExtensionNames = &extension,
                                      .pEnabledFeatures = &core };
    CHECK_VK(vkCreateDevice(own->physical, &info, NULL, &own->device));
}

void own_device_open(struct own_device *own, uint32_t flags)
{
    *own = (struct own_device){ .validation = flags & OWN_DEVICE_VALIDATION };
    create_instance(own, flags & OWN_DEVICE_VALIDATION);
    uint32_t count = 1;
    vkEnumeratePhysicalDevices(own->instance, &count, &own->physical);
    VkQueueFamilyProperties families[16];
    count = 16;
    vkGetPhysicalDeviceQueueFamilyProperties(own->physical, &count, families);
    while (own->family < count && !(families[own->family].queueFlags & VK_QUEUE_GRAPHICS_BIT))
        own->family++;
    const bool two = families[own->family].queueCount > 1 &&
                     (!(flags & OWN_DEVICE_VALIDATION) || layer_knows_timelines());
    const uint32_t queues = two ? 2 : 1;
    create_device(own, queues, !(flags & OWN_DEVICE_NO_PUSH_DESCRIPTORS));
    vkGetDeviceQueue(own->device, own->family, 0, &own->queue);
    vkGetDeviceQueue(own->device, own->family, queues - 1, &own->upload_queue);
    const VkCommandPoolCreateInfo pool = { .sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
                                           .queueFamilyIndex = own->family };
    CHECK_VK(vkCreateCommandPool(own->device, &pool, NULL, &own->pool));
}

void own_device_close(struct own_device *own)
{
    vkDestroyCommandPool(own->device, own->pool, NULL);
    vkDestroyDevice(own->device, NULL);
    vkDestroyInstance(own->instance, NULL);
}

void own_device_lock(void *user)
{
    struct own_device *own = user;
    own->locks++;
    assert_int_equal(++own->held, 1);
}

void own_device_unlock(void *user)
{
    ((struct own_device *)user)->held--;
}

VkCommandBuffer own_device_begin(struct own_device *own)
{
    VkCommandBuffer commands;
    const VkCommandBufferAllocateInfo allocate = {
        .sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
        .commandPool = own->pool,
        .commandBufferCount = 1
    };
    const VkCommandBufferBeginInfo begin = { .sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO };
    CHECK_VK(vkAllocateCommandBuffers(own->device, &allocate, &commands));
    CHECK_VK(vkBeginCommandBuffer(commands, &begin));
    return commands;
}

void own_device_submit(struct own_device *own, VkCommandBuffer commands)
{
    CHECK_VK(vkEndCommandBuffer(commands));
    const VkSubmitInfo submit = { .sType = VK_STRUCTURE_TYPE_SUBMIT_INFO,
                                  .commandBufferCount = 1,
                                  .pCommandBuffers = &commands };
    CHECK_VK(vkQueueSubmit(own->queue, 1, &submit, VK_NULL_HANDLE));
}

void own_device_run(struct own_device *own, VkCommandBuffer commands)
{
    own_device_submit(own, commands);
    CHECK_VK(vkQueueWaitIdle(own->queue));
}
