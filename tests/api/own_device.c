#include "api/own_device.h"

#include "framework/test.h"

#define CHECK_VK(call) assert_int_equal((call), VK_SUCCESS)

static void create_instance(struct own_device *own)
{
    const char *extensions[] = { "VK_EXT_debug_utils" };
    const VkApplicationInfo application = { .sType = VK_STRUCTURE_TYPE_APPLICATION_INFO,
                                            .apiVersion = VK_API_VERSION_1_3 };
    const VkInstanceCreateInfo info = { .sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO,
                                        .pApplicationInfo = &application,
                                        .enabledExtensionCount = 1,
                                        .ppEnabledExtensionNames = extensions };
    CHECK_VK(vkCreateInstance(&info, NULL, &own->instance));
}

// With what ag_device_required_features lists.
static void create_device(struct own_device *own)
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
    const float priority = 1;
    const VkDeviceQueueCreateInfo queue = { .sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO,
                                            .queueFamilyIndex = own->family,
                                            .queueCount = 1,
                                            .pQueuePriorities = &priority };
    const VkDeviceCreateInfo info = { .sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
                                      .pNext = &v11,
                                      .queueCreateInfoCount = 1,
                                      .pQueueCreateInfos = &queue,
                                      .enabledExtensionCount = 1,
                                      .ppEnabledExtensionNames = &extension,
                                      .pEnabledFeatures = &core };
    CHECK_VK(vkCreateDevice(own->physical, &info, NULL, &own->device));
}

void own_device_open(struct own_device *own)
{
    *own = (struct own_device){ 0 };
    create_instance(own);
    uint32_t count = 1;
    vkEnumeratePhysicalDevices(own->instance, &count, &own->physical);
    VkQueueFamilyProperties families[16];
    count = 16;
    vkGetPhysicalDeviceQueueFamilyProperties(own->physical, &count, families);
    while (own->family < count && !(families[own->family].queueFlags & VK_QUEUE_GRAPHICS_BIT))
        own->family++;
    create_device(own);
    vkGetDeviceQueue(own->device, own->family, 0, &own->queue);
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

static void lock_queue(void *user)
{
    struct own_device *own = user;
    own->locks++;
    assert_int_equal(++own->held, 1);
}

static void unlock_queue(void *user)
{
    ((struct own_device *)user)->held--;
}

struct ag_device_adopt own_device_lend(struct own_device *own)
{
    return (struct ag_device_adopt){ .instance = own->instance,
                                     .physical_device = own->physical,
                                     .device = own->device,
                                     .queue = own->queue,
                                     .queue_family = own->family,
                                     .lock_queue = lock_queue,
                                     .unlock_queue = unlock_queue,
                                     .user = own };
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

void own_device_run(struct own_device *own, VkCommandBuffer commands)
{
    CHECK_VK(vkEndCommandBuffer(commands));
    const VkSubmitInfo submit = { .sType = VK_STRUCTURE_TYPE_SUBMIT_INFO,
                                  .commandBufferCount = 1,
                                  .pCommandBuffers = &commands };
    CHECK_VK(vkQueueSubmit(own->queue, 1, &submit, VK_NULL_HANDLE));
    CHECK_VK(vkQueueWaitIdle(own->queue));
}
