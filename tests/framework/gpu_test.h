// Tests on the GPU: one device for the test program, with validation and synchronization
// validation.
//
//     TEST_GPU(dispatch_doubles_each_word) { ... gpu ... }
//
// Each test fails on a validation message, a live object or a lost device. Without a Vulkan device
// it is reported as skipped. Link ag_test_gpu.
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

// The test program's device, for tests that cannot be a TEST_GPU; such a test calls test_gpu_finish
// itself.
struct gpu *test_gpu(void);
// Waits, then fails on validation messages and live objects since test_gpu.
void test_gpu_finish(struct gpu *gpu);
// Reports the running test as skipped where there is no Vulkan device.
void test_gpu_require(void);
// Whether the device runs on the CPU. Its time is proportional to the work, and its images have no
// padding but of rows; a small frame on hardware takes the time between passes, and images are
// padded to tiles.
bool test_gpu_is_software(const struct gpu *gpu);

// Create objects, or fail the test. mips and depth as in gpu_image_desc.
gpu_image test_gpu_image(struct gpu *gpu, enum gpu_dimension dimension, enum gpu_format format,
                         uint32_t width, uint32_t height, uint32_t depth, uint32_t mips,
                         uint32_t usage);
gpu_buffer test_gpu_buffer(struct gpu *gpu, size_t bytes); // storage, uniform, index, indirect
gpu_pipeline test_gpu_compute(struct gpu *gpu, const struct gpu_shader *shader);
