#include "framework/gpu_test.h"

#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

static struct gpu *device;

// Whatever ended a test, its messages and objects are seen here at the latest.
static void at_exit(void)
{
    if (!device) return;
    gpu_wait(device);
    int messages = gpu_validation_messages(device), objects = gpu_live_objects(device);
    gpu_destroy(device);
    device = NULL;
    if (!messages && !objects) return;
    fprintf(stderr, "the GPU tests leave %d validation messages and %d live objects\n", messages,
            objects);
    fflush(NULL);
    _exit(1);
}

void test_gpu_require(void)
{
    int count;
    if (gpu_list_devices(test_host(), NULL, 0, &count) && count > 0) return;
    print_message("skipped: there is no Vulkan device\n");
    skip();
}

struct gpu *test_gpu(void)
{
    static bool registered;
    // A test that failed half-way leaves objects behind; the next one is not to answer for them.
    if (device && (gpu_live_objects(device) || gpu_validation_messages(device))) {
        gpu_destroy(device);
        device = NULL;
    }
    if (device) return device;
    test_gpu_require();
    // Hazards between submissions, which this layer leaves out unless told otherwise.
    setenv("VK_LAYER_ENABLES", "VALIDATION_CHECK_ENABLE_SYNCHRONIZATION_VALIDATION_QUEUE_SUBMIT",
           0);
    device = gpu_create(test_host(), &(struct gpu_desc){ .device = getenv("AFTERGLOW_TEST_DEVICE"),
                                                         .validation = true });
    if (!device) fail_msg("no device: %s", test_last_message());
    if (!registered) atexit(at_exit);
    registered = true;
    return device;
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
    body(gpu);
    test_gpu_finish(gpu);
}
