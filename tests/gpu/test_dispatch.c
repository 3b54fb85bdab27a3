#include "framework/gpu_test.h"
#include "gpu_test_shaders.h"

struct affine {
    uint32_t scale, offset, count;
};

static gpu_buffer words(struct gpu *gpu, uint32_t count)
{
    gpu_buffer buffer;
    CHECK(gpu_buffer_create(
        gpu, &(struct gpu_buffer_desc){ "test.words", 4 * count, GPU_BUFFER_STORAGE }, &buffer));
    return buffer;
}

static gpu_pipeline affine(struct gpu *gpu, uint32_t step)
{
    gpu_pipeline pipeline;
    struct gpu_constant constant = { 0, step };
    CHECK(gpu_compute_pipeline_create(gpu, "test.affine", &shader_test_affine_comp, &constant, 1,
                                      &pipeline));
    return pipeline;
}

TEST_GPU(dispatches_on_one_buffer_run_in_order)
{
    enum { COUNT = 1000 };
    gpu_buffer buffer = words(gpu, COUNT);
    gpu_pipeline pipeline = affine(gpu, 1);
    struct gpu_cmd *cmd = gpu_frame_begin(gpu);
    uint32_t expected = 0, got[COUNT];
    for (uint32_t i = 0; i < 20; i++) {
        struct affine push = { 3, i, COUNT };
        gpu_dispatch(cmd, pipeline, GPU_BIND({ "Values", .buffer = buffer }), &push, sizeof push,
                     gpu_groups(COUNT, 64), 1, 1);
        expected = expected * 3 + i;
    }
    CHECK(gpu_frame_end(gpu, cmd));
    CHECK(gpu_buffer_download(gpu, buffer, 0, got, sizeof got));
    for (int i = 0; i < COUNT; i++) assert_int_equal(got[i], expected);
    gpu_buffer_destroy(gpu, &buffer);
    gpu_pipeline_destroy(gpu, &pipeline);
}
