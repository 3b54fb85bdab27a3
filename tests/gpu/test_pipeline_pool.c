// Pipelines that are destroyed and created again.
#include "framework/gpu_test.h"
#include "gpu/vk.h"
#include "gpu_test_shaders.h"

static gpu_pipeline affine(struct gpu *gpu, const char *name, uint32_t step)
{
    gpu_pipeline pipeline;
    struct gpu_constant constant = { 0, step };
    CHECK(
        gpu_compute_pipeline_create(gpu, name, &shader_test_affine_comp, &constant, 1, &pipeline));
    return pipeline;
}

static VkPipeline handle_of(const struct gpu *gpu, gpu_pipeline pipeline)
{
    return pipeline_get(gpu, pipeline)->handle;
}

static void add_one(struct gpu_cmd *cmd, gpu_pipeline pipeline, gpu_buffer values, uint32_t count)
{
    const struct {
        uint32_t scale, offset, count;
    } push = { 1, 1, count };
    gpu_dispatch(cmd, pipeline, GPU_BIND({ "Values", .buffer = values }), &push, sizeof push,
                 gpu_groups(count, 64), 1, 1);
}

TEST_GPU(an_equal_pipeline_is_taken_back_while_a_frame_still_uses_it)
{
    gpu_buffer values = test_gpu_buffer(gpu, 8 * 4);
    gpu_pipeline pipeline = affine(gpu, "test.pool", 1);
    const VkPipeline first = handle_of(gpu, pipeline);
    enum { FRAMES = 3 };
    for (int i = 0; i < FRAMES; i++) {
        struct gpu_cmd *cmd = gpu_frame_begin(gpu);
        add_one(cmd, pipeline, values, 8);
        gpu_pipeline_destroy(gpu, &pipeline);
        pipeline = affine(gpu, "test.pool", 1);
        CHECK(handle_of(gpu, pipeline) == first);
        add_one(cmd, pipeline, values, 8);
        CHECK(gpu_frame_end(gpu, cmd));
    }
    uint32_t got[8];
    CHECK(gpu_buffer_download(gpu, values, 0, got, sizeof got));
    for (int i = 0; i < 8; i++) assert_int_equal(got[i], 2 * FRAMES);
    gpu_pipeline_destroy(gpu, &pipeline);
    gpu_buffer_destroy(gpu, &values);
}

TEST_GPU(equal_pipelines_are_compiled_once_others_are_not_shared)
{
    const uint64_t before = gpu_counters(gpu)->compiled;
    gpu_pipeline pipeline = affine(gpu, "test.pool", 31);
    const VkPipeline first = handle_of(gpu, pipeline);
    gpu_pipeline second = affine(gpu, "test.pool", 31);
    CHECK(handle_of(gpu, second) == first && second.id != pipeline.id);
    assert_int_equal(gpu_counters(gpu)->compiled - before, 1);
    const int pooled = gpu->pipeline_pool.count;
    gpu_pipeline_destroy(gpu, &pipeline);
    assert_int_equal(gpu->pipeline_pool.count, pooled); // the second one is in use
    CHECK(handle_of(gpu, second) == first);
    gpu_pipeline constant = affine(gpu, "test.pool", 2), name = affine(gpu, "test.other", 1);
    CHECK(handle_of(gpu, constant) != first && handle_of(gpu, name) != first);
    gpu_pipeline_destroy(gpu, &second);
    pipeline = affine(gpu, "test.pool", 31);
    CHECK(handle_of(gpu, pipeline) == first);
    gpu_pipeline_destroy(gpu, &pipeline);
    gpu_pipeline_destroy(gpu, &constant);
    gpu_pipeline_destroy(gpu, &name);
}

static gpu_pipeline depth_only(struct gpu *gpu, float bias)
{
    gpu_pipeline pipeline;
    CHECK(gpu_graphics_pipeline_create(
        gpu,
        &(struct gpu_graphics_desc){ .name = "test.depth",
                                     .vertex = &shader_test_triangle_vert,
                                     .depth_format = GPU_D32F,
                                     .depth_compare = GPU_GREATER,
                                     .depth_write = true,
                                     .depth_bias_slope = bias },
        &pipeline));
    return pipeline;
}

TEST_GPU(fixed_state_distinguishes_pipelines)
{
    gpu_pipeline pipeline = depth_only(gpu, -1);
    const VkPipeline first = handle_of(gpu, pipeline);
    gpu_pipeline_destroy(gpu, &pipeline);
    gpu_pipeline flat = depth_only(gpu, 0);
    CHECK(handle_of(gpu, flat) != first);
    pipeline = depth_only(gpu, -1);
    CHECK(handle_of(gpu, pipeline) == first);
    gpu_pipeline_destroy(gpu, &pipeline);
    gpu_pipeline_destroy(gpu, &flat);
}

TEST_GPU(the_oldest_pipelines_are_freed)
{
    enum { COUNT = POOLED_PIPELINES + 5 };
    for (uint32_t i = 0; i < COUNT; i++) {
        gpu_pipeline pipeline = affine(gpu, "test.pool", 100 + i);
        gpu_pipeline_destroy(gpu, &pipeline);
        CHECK(gpu->pipeline_pool.count <= POOLED_PIPELINES);
    }
    CHECK(gpu->pipeline_pool.count == POOLED_PIPELINES);
    const struct pipeline *oldest = gpu->pipeline_pool.pipelines[0];
    assert_int_equal(oldest->constants[0].value, 100 + COUNT - POOLED_PIPELINES);
}
