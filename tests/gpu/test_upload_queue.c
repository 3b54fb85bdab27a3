// The upload queue of an adopted device. On a device with one queue it is the same, and the
// timeline semaphore that a submission signals tells which of the two it was for.
#include "gpu/own_gpu.h"
#include "gpu/vk.h"
#include "gpu_test_shaders.h"

#include <stdlib.h>
#include <string.h>

enum { WORDS = 16, BYTES = 4 * WORDS };

// Submissions since watch_begin.
static struct watch {
    struct own_device *own;
    const struct gpu *gpu;
    struct {
        bool upload, empty;
        uint64_t waits_for; // value of the timeline of uploads; 0: none
    } list[32];
    int count;
    bool hold; // the main queue gets its submission from watch_release
    struct held {
        VkQueue queue;
        VkSemaphoreSubmitInfo signal;
        VkCommandBufferSubmitInfo commands;
    } held;
} watch;

static void keep(VkQueue queue, const VkSubmitInfo2 *info)
{
    assert_true(!watch.held.queue && info->waitSemaphoreInfoCount == 0);
    watch.held =
        (struct held){ queue, info->pSignalSemaphoreInfos[0], info->pCommandBufferInfos[0] };
}

static VKAPI_ATTR VkResult VKAPI_CALL submit(VkQueue queue, uint32_t count,
                                             const VkSubmitInfo2 *info, VkFence fence)
{
    const VkSemaphoreSubmitInfo *wait = info->pWaitSemaphoreInfos;
    const bool upload = info->pSignalSemaphoreInfos[0].semaphore != watch.gpu->queue.timeline;
    assert_true(count == 1 && watch.count < 32 && watch.own->held == 1);
    assert_true(queue == (upload ? watch.own->upload_queue : watch.own->queue));
    watch.list[watch.count].upload = upload;
    watch.list[watch.count].empty = info->commandBufferInfoCount == 0;
    watch.list[watch.count].waits_for = info->waitSemaphoreInfoCount ? wait->value : 0;
    watch.count++;
    if (info->waitSemaphoreInfoCount) {
        assert_true(info->waitSemaphoreInfoCount == 1 && !upload);
        assert_true(wait->semaphore == watch.gpu->upload_queue.timeline);
        assert_true(wait->stageMask == VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT);
    }
    if (upload || !watch.hold) return vkQueueSubmit2(queue, count, info, fence);
    keep(queue, info);
    return VK_SUCCESS;
}

static void watch_begin(struct gpu *gpu, struct own_device *own)
{
    watch = (struct watch){ .own = own, .gpu = gpu };
    gpu->vk.QueueSubmit2 = submit;
}

static void watch_release(void)
{
    const VkSubmitInfo2 info = { .sType = VK_STRUCTURE_TYPE_SUBMIT_INFO_2,
                                 .commandBufferInfoCount = 1,
                                 .pCommandBufferInfos = &watch.held.commands,
                                 .signalSemaphoreInfoCount = 1,
                                 .pSignalSemaphoreInfos = &watch.held.signal };
    watch.hold = false;
    assert_int_equal(vkQueueSubmit2(watch.held.queue, 1, &info, VK_NULL_HANDLE), VK_SUCCESS);
}

static struct gpu *open_queues(struct own_device *own)
{
    test_gpu_require();
    // Hazards between submissions, too.
    setenv("VK_LAYER_ENABLES", "VALIDATION_CHECK_ENABLE_SYNCHRONIZATION_VALIDATION_QUEUE_SUBMIT",
           0);
    own_device_open(own, OWN_DEVICE_VALIDATION);
    struct gpu *gpu = own_gpu_create(own, own->upload_queue, NULL);
    if (!gpu) fail_msg("%s", test_last_message());
    watch_begin(gpu, own);
    return gpu;
}

static void close_queues(struct gpu *gpu, struct own_device *own)
{
    test_gpu_finish(gpu);
    gpu_destroy(gpu);
    assert_int_equal(own->held, 0);
    own_device_close(own);
}

static void fill(uint32_t *words, uint32_t value)
{
    for (int i = 0; i < WORDS; i++) words[i] = value;
}

static void upload(struct gpu *gpu, gpu_buffer buffer, uint32_t value)
{
    uint32_t words[WORDS];
    fill(words, value);
    CHECK(gpu_buffer_upload(gpu, buffer, 0, words, sizeof words));
}

static gpu_buffer new_words(struct gpu *gpu, uint32_t value)
{
    gpu_buffer buffer = test_gpu_buffer(gpu, BYTES);
    upload(gpu, buffer, value);
    return buffer;
}

static uint32_t downloaded(struct gpu *gpu, gpu_buffer buffer, size_t word)
{
    uint32_t value = 0;
    CHECK(gpu_buffer_download(gpu, buffer, 4 * word, &value, 4));
    return value;
}

// Adds the words to `total`.
static void record_sum(struct gpu_cmd *cmd, gpu_pipeline sum, gpu_buffer words, gpu_buffer total)
{
    gpu_dispatch(cmd, sum, GPU_BIND({ "Words", .buffer = words }, { "Total", .buffer = total }),
                 NULL, 0, 1, 1, 1);
}

static void submit_sum(struct gpu *gpu, gpu_pipeline sum, gpu_buffer words, gpu_buffer total)
{
    struct gpu_cmd *cmd = gpu_frame_begin(gpu);
    CHECK(cmd != NULL);
    record_sum(cmd, sum, words, total);
    CHECK(gpu_frame_end(gpu, cmd));
}

static uint64_t on_upload_queue(const struct gpu *gpu)
{
    return gpu_counters(gpu)->upload_queue_transfers;
}

TEST(a_buffer_is_uploaded_on_the_upload_queue_until_the_main_queue_uses_it)
{
    struct own_device own;
    struct gpu *gpu = open_queues(&own);
    gpu_buffer words = test_gpu_buffer(gpu, BYTES), total = test_gpu_buffer(gpu, 4);
    gpu_pipeline sum = test_gpu_compute(gpu, &shader_test_sum_comp);
    const uint32_t three = 3, five = 5;
    CHECK(gpu_buffer_upload(gpu, words, 8, &three, 4)); // the rest is zeroed
    CHECK(gpu_buffer_upload(gpu, words, 16, &five, 4));
    assert_int_equal(on_upload_queue(gpu), 2);
    submit_sum(gpu, sum, words, total);
    upload(gpu, words, 1); // the frame may still read it
    assert_int_equal(on_upload_queue(gpu), 2);
    submit_sum(gpu, sum, words, total);
    assert_int_equal(downloaded(gpu, total, 0), 3 + 5 + WORDS);
    CHECK(gpu_buffer_upload(gpu, total, 0, &three, 4));
    assert_int_equal(on_upload_queue(gpu), 2);
    assert_int_equal(gpu_counters(gpu)->transfers, 5);
    gpu_buffer_destroy(gpu, &words);
    gpu_buffer_destroy(gpu, &total);
    gpu_pipeline_destroy(gpu, &sum);
    close_queues(gpu, &own);
}

TEST(an_image_and_its_mips_are_uploaded_on_the_upload_queue)
{
    struct own_device own;
    struct gpu *gpu = open_queues(&own);
    float texels[16][4], got[4];
    gpu_image image = test_gpu_image(gpu, GPU_2D_ARRAY, GPU_RGBA32F, 4, 4, 2, 3, GPU_SAMPLED);
    for (int i = 0; i < 16; i++)
        for (int c = 0; c < 4; c++) texels[i][c] = (float)i;
    CHECK(gpu_image_upload(gpu, image, 0, 1, texels, sizeof texels)); // layer 0 is zeroed
    CHECK(gpu_image_generate_mips(gpu, image));
    assert_int_equal(on_upload_queue(gpu), 2);
    for (uint32_t layer = 0; layer < 2; layer++) {
        CHECK(gpu_image_download_float(gpu, image, 2, layer, got, 4, 4));
        for (int c = 0; c < 4; c++) CHECK_NEAR(got[c], layer ? 7.5 : 0, 1e-6);
    }
    CHECK(gpu_image_upload(gpu, image, 0, 1, texels, sizeof texels));
    assert_int_equal(on_upload_queue(gpu), 2);
    gpu_image_destroy(gpu, &image);
    close_queues(gpu, &own);
}

TEST(images_that_others_may_be_using_are_uploaded_on_the_main_queue)
{
    struct own_device own;
    struct gpu *gpu = open_queues(&own);
    const float texel[4] = { 1, 2, 3, 4 };
    const struct gpu_image_desc desc = { .name = "test.alias",
                                         .format = GPU_RGBA32F,
                                         .width = 1,
                                         .height = 1,
                                         .usage = GPU_SAMPLED,
                                         .alias = "test" };
    gpu_image shared = test_gpu_image(gpu, GPU_2D, GPU_RGBA32F, 1, 1, 1, 1, GPU_SAMPLED), alias;
    uint32_t client = gpu_client_add(gpu), layout;
    gpu_client_set(gpu, client);
    CHECK(gpu_image_create(gpu, &desc, &alias));
    CHECK(gpu_image_handle(gpu, shared, &layout));
    CHECK(gpu_image_upload(gpu, shared, 0, 0, texel, sizeof texel));
    CHECK(gpu_image_upload(gpu, alias, 0, 0, texel, sizeof texel));
    assert_int_equal(on_upload_queue(gpu), 0);
    assert_int_equal(gpu_counters(gpu)->transfers, 2);
    gpu_image_destroy(gpu, &shared);
    gpu_image_destroy(gpu, &alias);
    gpu_client_remove(gpu, client);
    close_queues(gpu, &own);
}

static void check_submission(int index, bool upload, bool empty, uint64_t waits_for)
{
    assert_true(index < watch.count);
    assert_int_equal(watch.list[index].upload, upload);
    assert_int_equal(watch.list[index].empty, empty);
    assert_int_equal(watch.list[index].waits_for, waits_for);
}

TEST(the_next_submission_to_the_main_queue_waits_once_for_all_uploads)
{
    struct own_device own;
    struct gpu *gpu = open_queues(&own);
    gpu_buffer total = test_gpu_buffer(gpu, 4);
    gpu_pipeline sum = test_gpu_compute(gpu, &shader_test_sum_comp);
    gpu_buffer a = new_words(gpu, 1), b = new_words(gpu, 2);
    for (int i = 0; i < 2; i++) submit_sum(gpu, sum, a, total);
    assert_int_equal(watch.count, 4);
    check_submission(0, true, false, 0);
    check_submission(1, true, false, 0);
    check_submission(2, false, false, 2);
    check_submission(3, false, false, 0);
    gpu_buffer c = new_words(gpu, 3);
    assert_int_equal(downloaded(gpu, c, 1), 3); // a transfer waits, too
    submit_sum(gpu, sum, b, total);
    assert_int_equal(watch.count, 7);
    check_submission(4, true, false, 0);
    check_submission(5, false, false, 3);
    check_submission(6, false, false, 0);
    assert_int_equal(downloaded(gpu, total, 0), WORDS * (1 + 1 + 2));
    gpu_buffer_destroy(gpu, &a);
    gpu_buffer_destroy(gpu, &b);
    gpu_buffer_destroy(gpu, &c);
    gpu_buffer_destroy(gpu, &total);
    gpu_pipeline_destroy(gpu, &sum);
    close_queues(gpu, &own);
}

static void record_and_run(struct gpu *gpu, struct own_device *own, gpu_pipeline sum,
                           gpu_buffer words, gpu_buffer total)
{
    VkCommandBuffer commands = own_device_begin(own);
    struct gpu_cmd *cmd = gpu_frame_begin_adopted(gpu, commands);
    CHECK(cmd != NULL);
    record_sum(cmd, sum, words, total);
    CHECK(gpu_frame_end(gpu, cmd));
    own_device_run(own, commands);
    gpu_frame_adopted_done(gpu, cmd);
}

TEST(before_a_frame_of_the_hosts_command_buffer_an_empty_submission_waits)
{
    struct own_device own;
    struct gpu *gpu = open_queues(&own);
    gpu_buffer total = test_gpu_buffer(gpu, 4), words = new_words(gpu, 2);
    gpu_pipeline sum = test_gpu_compute(gpu, &shader_test_sum_comp);
    for (int i = 0; i < 2; i++) record_and_run(gpu, &own, sum, words, total);
    assert_int_equal(watch.count, 2);
    check_submission(1, false, true, 1);

    // The host may use a shared image without a frame.
    const float texel[4] = { 1, 2, 3, 4 };
    struct gpu_image_handles handles;
    gpu_image image = test_gpu_image(gpu, GPU_2D, GPU_RGBA32F, 1, 1, 1, 1, GPU_STORAGE);
    CHECK(gpu_image_upload(gpu, image, 0, 0, texel, sizeof texel));
    CHECK(gpu_image_share(gpu, image, &handles));
    assert_int_equal(watch.count, 4);
    check_submission(2, true, false, 0);
    check_submission(3, false, true, 2);
    record_and_run(gpu, &own, sum, words, total);
    assert_int_equal(watch.count, 4);
    assert_int_equal(downloaded(gpu, total, 0), 3 * 2 * WORDS);
    gpu_image_destroy(gpu, &image);
    gpu_buffer_destroy(gpu, &words);
    gpu_buffer_destroy(gpu, &total);
    gpu_pipeline_destroy(gpu, &sum);
    close_queues(gpu, &own);
}

static struct allocation memory_of(const struct gpu *gpu, gpu_buffer buffer)
{
    return buffer_get(gpu, buffer)->memory;
}

static bool same_memory(const struct allocation *a, const struct allocation *b)
{
    return a->memory == b->memory && a->offset == b->offset;
}

// The main queue has not begun the frame when the upload returns. Its memory is reused afterwards.
TEST(an_upload_does_not_wait_for_a_frame_in_flight)
{
    struct own_device own;
    struct gpu *gpu = open_queues(&own);
    gpu_buffer total = test_gpu_buffer(gpu, 4), first = new_words(gpu, 1);
    gpu_pipeline sum = test_gpu_compute(gpu, &shader_test_sum_comp);
    submit_sum(gpu, sum, first, total);
    const struct allocation in_flight = memory_of(gpu, first);
    watch.hold = true;
    submit_sum(gpu, sum, first, total);
    gpu_buffer_destroy(gpu, &first);
    gpu_buffer second = new_words(gpu, 10);
    struct allocation memory = memory_of(gpu, second);
    assert_false(same_memory(&memory, &in_flight));
    watch_release();
    CHECK(gpu_wait(gpu));
    gpu_buffer third = new_words(gpu, 100);
    memory = memory_of(gpu, third);
    CHECK(memory.recycled && same_memory(&memory, &in_flight));
    assert_int_equal(on_upload_queue(gpu), 3);
    submit_sum(gpu, sum, second, total);
    submit_sum(gpu, sum, third, total);
    assert_int_equal(downloaded(gpu, total, 0), WORDS * (1 + 1 + 10 + 100));
    gpu_buffer_destroy(gpu, &second);
    gpu_buffer_destroy(gpu, &third);
    gpu_buffer_destroy(gpu, &total);
    gpu_pipeline_destroy(gpu, &sum);
    close_queues(gpu, &own);
}

// ---- Creation that fails

static struct {
    int calls, fails_at, live;
} creation;

static bool may_create(void)
{
    if (++creation.calls == creation.fails_at) return false;
    creation.live++;
    return true;
}

static VKAPI_ATTR VkResult VKAPI_CALL create_semaphore(VkDevice device,
                                                       const VkSemaphoreCreateInfo *info,
                                                       const VkAllocationCallbacks *allocator,
                                                       VkSemaphore *out)
{
    return may_create() ? vkCreateSemaphore(device, info, allocator, out)
                        : VK_ERROR_OUT_OF_HOST_MEMORY;
}

static VKAPI_ATTR void VKAPI_CALL destroy_semaphore(VkDevice device, VkSemaphore semaphore,
                                                    const VkAllocationCallbacks *allocator)
{
    creation.live -= semaphore != VK_NULL_HANDLE;
    vkDestroySemaphore(device, semaphore, allocator);
}

static VKAPI_ATTR VkResult VKAPI_CALL create_pool(VkDevice device,
                                                  const VkCommandPoolCreateInfo *info,
                                                  const VkAllocationCallbacks *allocator,
                                                  VkCommandPool *out)
{
    return may_create() ? vkCreateCommandPool(device, info, allocator, out)
                        : VK_ERROR_OUT_OF_HOST_MEMORY;
}

static VKAPI_ATTR void VKAPI_CALL destroy_pool(VkDevice device, VkCommandPool pool,
                                               const VkAllocationCallbacks *allocator)
{
    creation.live -= pool != VK_NULL_HANDLE;
    vkDestroyCommandPool(device, pool, allocator);
}

static VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL device_function(VkDevice device, const char *name)
{
    static const struct {
        const char *name;
        PFN_vkVoidFunction function;
    } own[] = {
        { "vkCreateSemaphore", (PFN_vkVoidFunction)create_semaphore },
        { "vkDestroySemaphore", (PFN_vkVoidFunction)destroy_semaphore },
        { "vkCreateCommandPool", (PFN_vkVoidFunction)create_pool },
        { "vkDestroyCommandPool", (PFN_vkVoidFunction)destroy_pool },
    };
    for (size_t i = 0; i < sizeof own / sizeof *own; i++)
        if (strcmp(name, own[i].name) == 0) return own[i].function;
    return vkGetDeviceProcAddr(device, name);
}

static VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL instance_function(VkInstance instance,
                                                                  const char *name)
{
    if (strcmp(name, "vkGetDeviceProcAddr") == 0) return (PFN_vkVoidFunction)device_function;
    return vkGetInstanceProcAddr(instance, name);
}

TEST(a_creation_that_fails_leaves_nothing)
{
    enum { CREATED = 2 + GPU_FRAMES_IN_FLIGHT + 2 }; // semaphores and command pools
    struct own_device own;
    struct gpu *gpu = NULL;
    test_gpu_require();
    own_device_open(&own, OWN_DEVICE_VALIDATION);
    for (int i = 1; !gpu; i++) {
        memset(&creation, 0, sizeof creation);
        creation.fails_at = i;
        gpu = own_gpu_create(&own, own.upload_queue, instance_function);
        assert_true((gpu != NULL) == (i > CREATED));
        assert_int_equal(creation.live, gpu ? CREATED : 0);
    }
    watch_begin(gpu, &own);
    gpu_buffer words = new_words(gpu, 7);
    assert_int_equal(on_upload_queue(gpu), 1);
    gpu_buffer_destroy(gpu, &words);
    test_gpu_finish(gpu);
    gpu_destroy(gpu);
    assert_int_equal(creation.live, 0);
    own_device_close(&own);
}
