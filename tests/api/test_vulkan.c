// A host's device, created with what afterglow/vulkan.h fills in.
#include "api/renderer_fixture.h"

#include <afterglow/vulkan.h>

#include <string.h>

static VkDevice create(const struct own_device *own, const struct ag_vulkan_requirements *needs)
{
    VkDevice device;
    const float priority = 1;
    const VkDeviceQueueCreateInfo queue = { .sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO,
                                            .queueFamilyIndex = own->family,
                                            .queueCount = 1,
                                            .pQueuePriorities = &priority };
    const VkDeviceCreateInfo info = { .sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
                                      .pNext = &needs->features,
                                      .queueCreateInfoCount = 1,
                                      .pQueueCreateInfos = &queue,
                                      .enabledExtensionCount = needs->extension_count,
                                      .ppEnabledExtensionNames = needs->extensions };
    assert_int_equal(vkCreateDevice(own->physical, &info, NULL, &device), VK_SUCCESS);
    return device;
}

static bool refused(const struct ag_device_adopt *adopt, enum ag_result with, const char *why)
{
    struct ag_context *context = fixture_context();
    struct ag_device *device = NULL;
    struct ag_device_desc desc;
    ag_device_desc_default(&desc);
    desc.adopt = adopt;
    const enum ag_result result = ag_device_create(context, &desc, &device);
    const bool named = strstr(ag_context_last_error(context), why) != NULL;
    ag_context_destroy(context);
    return result == with && !device && named;
}

static VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL no_function(VkInstance instance, const char *name)
{
    (void)instance;
    (void)name;
    return NULL;
}

TEST(a_device_created_with_the_requirements_is_adopted)
{
    struct own_device own;
    test_gpu_require();
    own_device_open(&own, OWN_DEVICE_VALIDATION);
    struct ag_vulkan_requirements needs;
    ag_vulkan_requirements_get(own.physical, &needs);
    struct ag_vulkan_requirements same;
    ag_vulkan_requirements_get_with(own.instance, own.physical, vkGetInstanceProcAddr, &same);
    assert_int_equal(same.extension_count, needs.extension_count);
    CHECK(same.vulkan13.dynamicRendering && same.features.pNext == &same.vulkan11);
    CHECK(needs.extension_count >= 1 && strcmp(needs.extensions[0], "VK_KHR_push_descriptor") == 0);
    needs.features.features.samplerAnisotropy = VK_TRUE; // the program's own
    VkDevice device = create(&own, &needs);
    VkQueue queue;
    vkGetDeviceQueue(device, own.family, 0, &queue);
    struct ag_device_adopt adopt =
        ag_vulkan_adopt(own.instance, own.physical, device, queue, own.family, &needs);
    adopt.user = &own;
    adopt.get_instance_proc_addr = (void (*)(void))vkGetInstanceProcAddr;
    struct renderer_fixture s = fixture_open("lpv", &adopt);
    assert_int_equal(ag_renderer_render(s.renderer, &s.frame), AG_OK);
    struct ag_layer_handle layer;
    assert_int_equal(ag_renderer_layer_handle(s.renderer, "irradiance", &layer), AG_OK);
    CHECK(ag_vulkan_image(&layer) != VK_NULL_HANDLE);
    CHECK(ag_vulkan_image_view(&layer) != VK_NULL_HANDLE);
    CHECK(ag_vulkan_format(&layer) == VK_FORMAT_R16G16B16A16_SFLOAT);
    CHECK(ag_vulkan_layout(&layer) == VK_IMAGE_LAYOUT_GENERAL);
    fixture_close(&s);

    // Omissions of a program, as far as the library can tell.
    adopt.queue_family = 1000;
    CHECK(refused(&adopt, AG_ERROR_ARGUMENT, "queue family 1000"));
    adopt.queue_family = own.family;
    needs.vulkan12.timelineSemaphore = VK_FALSE;
    CHECK(refused(&adopt, AG_ERROR_ARGUMENT, "timelineSemaphore"));
    needs.vulkan12.timelineSemaphore = VK_TRUE;
    needs.features.features.imageCubeArray = VK_FALSE;
    CHECK(refused(&adopt, AG_ERROR_ARGUMENT, "imageCubeArray"));
    adopt.get_instance_proc_addr = (void (*)(void))no_function;
    CHECK(refused(&adopt, AG_ERROR_UNSUPPORTED, "vkCreateDevice"));
    ag_vulkan_requirements_get_with(own.instance, own.physical, no_function, &needs);
    assert_int_equal(needs.extension_count, 0);
    vkDestroyDevice(device, NULL);
    own_device_close(&own);
    ag_vulkan_requirements_get(VK_NULL_HANDLE, &needs);
    assert_int_equal(needs.extension_count, 0);
    ag_vulkan_requirements_get(VK_NULL_HANDLE, NULL);
    ag_vulkan_requirements_get_with(VK_NULL_HANDLE, VK_NULL_HANDLE, NULL, &needs);
    assert_int_equal(needs.extension_count, 0);
    ag_vulkan_requirements_get_with(VK_NULL_HANDLE, VK_NULL_HANDLE, NULL, NULL);
}
