// Tests on the GPU: one device for the test program, with validation and synchronization
// validation.
//
//     TEST_GPU(dispatch_doubles_each_word) { ... gpu ... }
//
// After each, whether it asks or not: no validation message, no live object, the device not lost.
// Where there is no Vulkan device at all the test is skipped, visibly. Link ag_test_gpu.
#pragma once

#include "framework/test.h"
#include "gpu/gpu.h"

#define TEST_GPU(name)                                                                             \
    static void gpu_test_##name(struct gpu *gpu);                                                  \
    TEST(name)                                                                                     \
    {                                                                                              \
        test_gpu_run(gpu_test_##name);                                                             \
    }                                                                                              \
    static void gpu_test_##name(struct gpu *gpu)

void test_gpu_run(void (*body)(struct gpu *gpu));

// The program's device, for tests that cannot be a TEST_GPU; they call test_gpu_finish themselves,
// and the program's end checks once more.
struct gpu *test_gpu(void);
// Waits, then fails on validation messages and live objects since test_gpu.
void test_gpu_finish(struct gpu *gpu);
// Skips the running test, visibly, where there is no Vulkan device.
void test_gpu_require(void);

// Objects that must be creatable, or the test fails. mips and depth as in gpu_image_desc.
gpu_image test_gpu_image(struct gpu *gpu, enum gpu_dimension dimension, enum gpu_format format,
                         uint32_t width, uint32_t height, uint32_t depth, uint32_t mips,
                         uint32_t usage);
gpu_buffer test_gpu_buffer(struct gpu *gpu, size_t bytes); // for storage and all else
gpu_pipeline test_gpu_compute(struct gpu *gpu, const struct gpu_shader *shader);
