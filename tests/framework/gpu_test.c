#include "framework/gpu_test.h"

#include "framework/drivers.h"

#include <stdlib.h>

static struct gpu *device;
static bool unfinished; // a test began and has not finished

// Catches validation messages and live objects that test_gpu_finish did not check.
static bool check_end(void)
{
    if (!device) return true;
    gpu_wait(device);
    int messages = gpu_validation_messages(device), objects = gpu_live_objects(device);
    gpu_destroy(device);
    device = NULL;
    if (!messages && !objects) return true;
    print_error("the GPU tests leave %d validation messages and %d live objects\n", messages,
                objects);
    return false;
}

static void pin_drivers(void)
{
    static bool done;
    if (done || !drivers_are_checked()) return;
    done = true;
    drivers_load_begin();
    struct gpu *gpu = gpu_create(test_host(), &(struct gpu_desc){ .validation = true });
    drivers_load_end();
    gpu_destroy(gpu);
}

void test_gpu_require(void)
{
    int count;
    pin_drivers();
    if (gpu_list_devices(test_host(), NULL, 0, &count) && count > 0) return;
    test_skip("no Vulkan device");
}

struct gpu *test_gpu(void)
{
    static bool registered;
    // A failed test leaves live objects and an open frame; the next test gets a new device.
    if (device && (unfinished || gpu_live_objects(device) || gpu_validation_messages(device))) {
        gpu_destroy(device);
        device = NULL;
    }
    unfinished = false;
    if (device) return device;
    test_gpu_require();
    // Checks hazards between submissions too, which is off by default.
    setenv("VK_LAYER_ENABLES", "VALIDATION_CHECK_ENABLE_SYNCHRONIZATION_VALIDATION_QUEUE_SUBMIT",
           0);
    device = gpu_create(test_host(), &(struct gpu_desc){ .device = getenv("AFTERGLOW_TEST_DEVICE"),
                                                         .validation = true });
    if (!device) fail_msg("no device: %s", test_last_message());
    if (!registered) test_register_end(check_end);
    registered = true;
    return device;
}

bool test_gpu_is_software(const struct gpu *gpu)
{
    return gpu_info(gpu)->type == GPU_CPU;
}

void test_gpu_finish(struct gpu *gpu)
{
    CHECK(gpu_wait(gpu));
    if (gpu_validation_messages(gpu)) {
        fail_msg("%d validation messages, the last: %s", gpu_validation_messages(gpu),
                 test_last_message());
    }
    assert_int_equal(gpu_live_objects(gpu), 0);
}

void test_gpu_run(void (*body)(struct gpu *gpu))
{
    struct gpu *gpu = test_gpu();
    test_forget_messages();
    unfinished = true;
    body(gpu);
    test_gpu_finish(gpu);
    unfinished = false;
}

gpu_image test_gpu_image(struct gpu *gpu, enum gpu_dimension dimension, enum gpu_format format,
                         uint32_t width, uint32_t height, uint32_t depth, uint32_t mips,
                         uint32_t usage)
{
    gpu_image image;
    struct gpu_image_desc desc = { "test.image", dimension, format, width, height,
                                   depth,        mips,      usage,  NULL };
    if (!gpu_image_create(gpu, &desc, &image)) fail_msg("no image: %s", test_last_message());
    return image;
}

gpu_buffer test_gpu_buffer(struct gpu *gpu, size_t bytes)
{
    gpu_buffer buffer;
    struct gpu_buffer_desc desc = { "test.buffer", bytes,
                                    GPU_BUFFER_STORAGE | GPU_BUFFER_UNIFORM | GPU_BUFFER_INDEX |
                                        GPU_BUFFER_INDIRECT };
    if (!gpu_buffer_create(gpu, &desc, &buffer)) fail_msg("no buffer: %s", test_last_message());
    return buffer;
}

gpu_pipeline test_gpu_compute(struct gpu *gpu, const struct gpu_shader *shader)
{
    gpu_pipeline pipeline;
    if (!gpu_compute_pipeline_create(gpu, "test.pipeline", shader, NULL, 0, &pipeline)) {
        fail_msg("no pipeline: %s", test_last_message());
    }
    return pipeline;
}
