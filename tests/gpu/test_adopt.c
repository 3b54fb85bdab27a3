// An adopted device: created with plain Vulkan, used by the layer and by the host.
#include "gpu/own_gpu.h"
#include "gpu_test_shaders.h"

#include <string.h>

static void open_own(struct own_device *own, uint32_t flags)
{
    test_gpu_require();
    own_device_open(own, flags | OWN_DEVICE_VALIDATION);
}

// One frame and one transfer.
static void add_ten_times_seven(struct gpu *gpu)
{
    gpu_buffer words = test_gpu_buffer(gpu, 40), total = test_gpu_buffer(gpu, 4);
    gpu_pipeline sum = test_gpu_compute(gpu, &shader_test_sum_comp);
    struct gpu_cmd *cmd = gpu_frame_begin(gpu);
    gpu_fill_buffer(cmd, words, 0, 40, 7);
    gpu_dispatch(cmd, sum, GPU_BIND({ "Words", .buffer = words }, { "Total", .buffer = total }),
                 NULL, 0, 1, 1, 1);
    CHECK(gpu_frame_end(gpu, cmd));
    uint32_t got;
    CHECK(gpu_buffer_download(gpu, total, 0, &got, 4));
    assert_int_equal(got, 70);
    gpu_buffer_destroy(gpu, &words);
    gpu_buffer_destroy(gpu, &total);
    gpu_pipeline_destroy(gpu, &sum);
}

TEST(an_adopted_device_runs_frames_and_transfers)
{
    struct own_device own;
    open_own(&own, 0);
    struct gpu *gpu = own_gpu_create(&own, NULL, NULL);
    CHECK(gpu != NULL);
    add_ten_times_seven(gpu);
    assert_int_equal(own.locks, 2);
    assert_int_equal(own.held, 0);
    test_gpu_finish(gpu);
    gpu_destroy(gpu);
    own_device_close(&own);
}

static bool owns(struct gpu *gpu, const char *owner)
{
    struct gpu_memory list[16];
    int count = gpu_memory_by_owner(gpu, list, 16);
    for (int i = 0; i < count; i++) {
        if (strcmp(list[i].owner, owner) == 0) return true;
    }
    return false;
}

TEST(commands_are_recorded_into_the_hosts_command_buffer)
{
    enum { FRAMES = 3 };
    struct own_device own;
    open_own(&own, 0);
    struct gpu *gpu = own_gpu_create(&own, NULL, NULL);
    CHECK(gpu != NULL);
    gpu_buffer total = test_gpu_buffer(gpu, 4), words;
    gpu_pipeline sum = test_gpu_compute(gpu, &shader_test_sum_comp);
    struct gpu_cmd *cmds[FRAMES];
    for (uint32_t i = 0; i < FRAMES; i++) { // all in flight at once
        const uint32_t data[2] = { i, 10 };
        VkCommandBuffer commands = own_device_begin(&own);
        CHECK(gpu_buffer_create(
            gpu, &(struct gpu_buffer_desc){ "temporary.words", 400, GPU_BUFFER_STORAGE }, &words));
        cmds[i] = gpu_frame_begin_adopted(gpu, commands);
        CHECK(cmds[i] != NULL);
        gpu_scope_begin(cmds[i], "test.sum");
        gpu_fill_buffer(cmds[i], words, 0, 400, 1);
        gpu_dispatch(cmds[i], sum,
                     GPU_BIND({ "Words", .buffer = words }, { "Total", .buffer = total }), NULL, 0,
                     1, 1, 1);
        gpu_dispatch(cmds[i], sum,
                     GPU_BIND(gpu_transient(cmds[i], "Words", data, sizeof data),
                              { "Total", .buffer = total }),
                     NULL, 0, 1, 1, 1);
        gpu_scope_end(cmds[i]);
        gpu_buffer_destroy(gpu, &words);
        CHECK(gpu_frame_end(gpu, cmds[i]));
        own_device_submit(&own, commands);
    }
    assert_int_equal(own.locks, 0); // the host submitted
    vkQueueWaitIdle(own.queue);
    CHECK(gpu_wait(gpu));
    assert_true(owns(gpu, "temporary")); // completion is not reported yet
    for (int i = 0; i < FRAMES; i++) gpu_frame_adopted_done(gpu, cmds[i]);
    assert_false(owns(gpu, "temporary"));
    uint32_t got;
    CHECK(gpu_buffer_download(gpu, total, 0, &got, 4));
    assert_int_equal(got, 3 * 100 + 3 * 10 + 0 + 1 + 2);
    struct gpu_timing timings[4];
    if (gpu_limits(gpu)->timestamps) {
        assert_int_equal(gpu_frame_timings(gpu, timings, 4), 2);
        CHECK_STRING(timings[1].name, "test.sum");
    }
    gpu_buffer_destroy(gpu, &total);
    gpu_pipeline_destroy(gpu, &sum);
    test_gpu_finish(gpu);
    gpu_destroy(gpu);
    own_device_close(&own);
}

static VkImage create_image(struct own_device *own, VkDeviceMemory *memory)
{
    VkImage image;
    vkCreateImage(own->device,
                  &(VkImageCreateInfo){ .sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO,
                                        .imageType = VK_IMAGE_TYPE_2D,
                                        .format = VK_FORMAT_R32G32B32A32_SFLOAT,
                                        .extent = { 8, 8, 1 },
                                        .mipLevels = 1,
                                        .arrayLayers = 1,
                                        .samples = VK_SAMPLE_COUNT_1_BIT,
                                        .usage = VK_IMAGE_USAGE_SAMPLED_BIT |
                                                 VK_IMAGE_USAGE_TRANSFER_DST_BIT |
                                                 VK_IMAGE_USAGE_TRANSFER_SRC_BIT },
                  NULL, &image);
    VkMemoryRequirements needs;
    vkGetImageMemoryRequirements(own->device, image, &needs);
    uint32_t type = 0;
    while (!(needs.memoryTypeBits & 1u << type)) type++;
    vkAllocateMemory(own->device,
                     &(VkMemoryAllocateInfo){ .sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO,
                                              .allocationSize = needs.size,
                                              .memoryTypeIndex = type },
                     NULL, memory);
    vkBindImageMemory(own->device, image, *memory, 0);
    return image;
}

static void host_clears(VkCommandBuffer commands, VkImage image, VkImageLayout from, float value)
{
    const VkImageSubresourceRange all = { VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1 };
    vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT,
                         VK_PIPELINE_STAGE_TRANSFER_BIT, 0, 0, NULL, 0, NULL, 1,
                         &(VkImageMemoryBarrier){ .sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER,
                                                  .dstAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT,
                                                  .oldLayout = from,
                                                  .newLayout = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                                                  .image = image,
                                                  .subresourceRange = all });
    vkCmdClearColorImage(commands, image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                         &(VkClearColorValue){ .float32 = { value, value, value, value } }, 1,
                         &all);
}

static void host_returns(VkCommandBuffer commands, VkImage image, VkImageLayout to)
{
    vkCmdPipelineBarrier(
        commands, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, 0, 0, NULL, 0,
        NULL, 1,
        &(VkImageMemoryBarrier){ .sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER,
                                 .srcAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT,
                                 .oldLayout = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                                 .newLayout = to,
                                 .image = image,
                                 .subresourceRange = { VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1 } });
}

// Copies the image to `texels` in the host's command buffer, after the host's clear.
static void fetch(struct own_device *own, struct gpu *gpu, VkCommandBuffer commands,
                  gpu_image image, gpu_buffer texels)
{
    gpu_pipeline pipeline = test_gpu_compute(gpu, &shader_test_fetch_comp);
    struct gpu_cmd *cmd = gpu_frame_begin_adopted(gpu, commands);
    gpu_dispatch(cmd, pipeline,
                 GPU_BIND({ "image", .image = image }, { "Texels", .buffer = texels }), NULL, 0, 1,
                 1, 1);
    CHECK(gpu_frame_end(gpu, cmd));
    own_device_run(own, commands);
    gpu_frame_adopted_done(gpu, cmd);
    gpu_pipeline_destroy(gpu, &pipeline);
}

TEST(a_wrapped_image_is_shared_with_the_host)
{
    struct own_device own;
    open_own(&own, 0);
    struct gpu *gpu = own_gpu_create(&own, NULL, NULL);
    CHECK(gpu != NULL);
    VkDeviceMemory memory;
    VkImage vk_image = create_image(&own, &memory);
    gpu_image image;
    gpu_buffer texels = test_gpu_buffer(gpu, 64 * 16);
    const struct gpu_image_desc desc = {
        .name = "host.image", .format = GPU_RGBA32F, .width = 8, .height = 8, .usage = GPU_SAMPLED
    };
    VkCommandBuffer commands = own_device_begin(&own);
    host_clears(commands, vk_image, VK_IMAGE_LAYOUT_UNDEFINED, 3);
    CHECK(
        gpu_image_wrap(gpu, &desc, (void *)vk_image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, &image));
    fetch(&own, gpu, commands, image, texels);
    float got[64];
    CHECK(gpu_buffer_download(gpu, texels, 0, got, sizeof got));
    for (int i = 0; i < 64; i++) CHECK_NEAR(got[i], 3, 0);

    uint32_t layout = 0; // the host uses the image and restores this layout
    assert_ptr_equal(gpu_image_handle(gpu, image, &layout), (void *)vk_image);
    assert_int_equal(layout, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
    commands = own_device_begin(&own);
    host_clears(commands, vk_image, (VkImageLayout)layout, 5);
    host_returns(commands, vk_image, (VkImageLayout)layout);
    fetch(&own, gpu, commands, image, texels);
    CHECK(gpu_buffer_download(gpu, texels, 0, got, sizeof got));
    for (int i = 0; i < 64; i++) CHECK_NEAR(got[i], 5, 0);

    gpu_image_destroy(gpu, &image);
    gpu_buffer_destroy(gpu, &texels);
    test_gpu_finish(gpu);
    gpu_destroy(gpu);
    vkDestroyImage(own.device, vk_image, NULL);
    vkFreeMemory(own.device, memory, NULL);
    own_device_close(&own);
}

TEST(more_pending_adopted_frames_than_the_limit_are_refused)
{
    struct own_device own;
    open_own(&own, 0);
    struct gpu *gpu = own_gpu_create(&own, NULL, NULL);
    CHECK(gpu != NULL);
    struct gpu_cmd *cmds[GPU_ADOPTED_FRAMES];
    for (int i = 0; i < GPU_ADOPTED_FRAMES; i++) {
        VkCommandBuffer commands = own_device_begin(&own);
        cmds[i] = gpu_frame_begin_adopted(gpu, commands);
        CHECK(cmds[i] != NULL);
        assert_null(gpu_frame_begin(gpu)); // one at a time
        CHECK(gpu_frame_end(gpu, cmds[i]));
        own_device_submit(&own, commands);
    }
    VkCommandBuffer commands = own_device_begin(&own);
    assert_null(gpu_frame_begin_adopted(gpu, commands));
    assert_non_null(strstr(test_last_message(), "8 are unfinished"));
    vkQueueWaitIdle(own.queue);
    gpu_frame_adopted_done(gpu, cmds[1]);
    cmds[1] = gpu_frame_begin_adopted(gpu, commands);
    CHECK(cmds[1] != NULL && gpu_frame_end(gpu, cmds[1]));
    own_device_run(&own, commands);
    for (int i = 0; i < GPU_ADOPTED_FRAMES; i++) gpu_frame_adopted_done(gpu, cmds[i]);
    test_gpu_finish(gpu);
    gpu_destroy(gpu);
    own_device_close(&own);
}

TEST(an_unsuitable_adopted_device_is_refused_with_the_reason)
{
    struct own_device own;
    open_own(&own, OWN_DEVICE_NO_PUSH_DESCRIPTORS);
    assert_null(own_gpu_create(&own, NULL, NULL));
    assert_non_null(strstr(test_last_message(), "created without VK_KHR_push_descriptor"));
    VkQueue queue = own.queue;
    own.queue = NULL;
    assert_null(own_gpu_create(&own, NULL, NULL));
    assert_non_null(strstr(test_last_message(), "must be there"));
    own.queue = queue;
    own_device_close(&own);
}

// ---- A Vulkan loader of the host's own

static struct {
    const char *lacks; // name of a function; NULL: none
    int dispatches, submissions, buffers;
} loader;

static VKAPI_ATTR void VKAPI_CALL count_dispatch(VkCommandBuffer commands, uint32_t x, uint32_t y,
                                                 uint32_t z)
{
    loader.dispatches++;
    vkCmdDispatch(commands, x, y, z);
}

static VKAPI_ATTR VkResult VKAPI_CALL count_submission(VkQueue queue, uint32_t count,
                                                       const VkSubmitInfo2 *infos, VkFence fence)
{
    loader.submissions++;
    return vkQueueSubmit2(queue, count, infos, fence);
}

static VKAPI_ATTR VkResult VKAPI_CALL count_buffer(VkDevice device, const VkBufferCreateInfo *info,
                                                   const VkAllocationCallbacks *allocator,
                                                   VkBuffer *out)
{
    loader.buffers++;
    return vkCreateBuffer(device, info, allocator, out);
}

static VKAPI_ATTR void VKAPI_CALL destroy_buffer(VkDevice device, VkBuffer buffer,
                                                 const VkAllocationCallbacks *allocator)
{
    if (buffer) loader.buffers--;
    vkDestroyBuffer(device, buffer, allocator);
}

static bool lacks(const char *name)
{
    return loader.lacks && strcmp(name, loader.lacks) == 0;
}

static VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL device_function(VkDevice device, const char *name)
{
    static const struct {
        const char *name;
        PFN_vkVoidFunction function;
    } own[] = {
        { "vkCmdDispatch", (PFN_vkVoidFunction)count_dispatch },
        { "vkQueueSubmit2", (PFN_vkVoidFunction)count_submission },
        { "vkCreateBuffer", (PFN_vkVoidFunction)count_buffer },
        { "vkDestroyBuffer", (PFN_vkVoidFunction)destroy_buffer },
    };
    if (lacks(name)) return NULL;
    for (size_t i = 0; i < sizeof own / sizeof *own; i++)
        if (strcmp(name, own[i].name) == 0) return own[i].function;
    return vkGetDeviceProcAddr(device, name);
}

static VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL instance_function(VkInstance instance,
                                                                  const char *name)
{
    if (lacks(name)) return NULL;
    if (strcmp(name, "vkGetDeviceProcAddr") == 0) return (PFN_vkVoidFunction)device_function;
    return vkGetInstanceProcAddr(instance, name);
}

TEST(functions_come_from_the_loader_of_the_host)
{
    struct own_device own;
    open_own(&own, 0);
    memset(&loader, 0, sizeof loader);
    struct gpu *gpu = own_gpu_create(&own, NULL, instance_function);
    CHECK(gpu != NULL);
    add_ten_times_seven(gpu);
    assert_int_equal(loader.dispatches, 1);
    assert_int_equal(loader.submissions, 2);
    CHECK(loader.buffers >= 2);
    test_gpu_finish(gpu);
    gpu_destroy(gpu);
    assert_int_equal(loader.buffers, 0);
    own_device_close(&own);
}

TEST(a_function_that_the_loader_lacks_is_named)
{
    static const char *const needed[] = { "vkGetDeviceProcAddr", "vkGetPhysicalDeviceFeatures2",
                                          "vkCmdDispatch", "vkDestroySemaphore" };
    struct own_device own;
    open_own(&own, 0);
    memset(&loader, 0, sizeof loader);
    for (size_t i = 0; i < sizeof needed / sizeof *needed; i++) {
        loader.lacks = needed[i];
        assert_null(own_gpu_create(&own, NULL, instance_function));
        assert_non_null(strstr(test_last_message(), needed[i]));
    }
    loader.lacks = "vkCmdBeginDebugUtilsLabelEXT"; // of an extension that nothing depends on
    struct gpu *gpu = own_gpu_create(&own, NULL, instance_function);
    CHECK(gpu != NULL);
    add_ten_times_seven(gpu);
    test_gpu_finish(gpu);
    gpu_destroy(gpu);
    own_device_close(&own);
}
