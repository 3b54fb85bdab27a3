// Scopes and their timings.
#include "framework/gpu_test.h"
#include "gpu_test_shaders.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static void work(struct gpu_cmd *cmd, gpu_pipeline sum, gpu_buffer words, gpu_buffer total)
{
    gpu_dispatch(cmd, sum, GPU_BIND({ "Words", .buffer = words }, { "Total", .buffer = total }),
                 NULL, 0, 1, 1, 1);
}

static void record_scopes(struct gpu *gpu, gpu_pipeline sum, gpu_buffer words, gpu_buffer total)
{
    struct gpu_cmd *cmd = gpu_frame_begin(gpu);
    gpu_scope_begin(cmd, "b.once");
    work(cmd, sum, words, total);
    gpu_scope_end(cmd);
    gpu_scope_begin(cmd, "outer");
    for (int i = 0; i < 3; i++) {
        gpu_scope_begin(cmd, "a.thrice");
        work(cmd, sum, words, total);
        gpu_scope_end(cmd);
        gpu_scope_begin(cmd, "c.nothing");
        gpu_scope_end(cmd);
    }
    gpu_scope_end(cmd);
    CHECK(gpu_frame_end(gpu, cmd));
    CHECK(gpu_wait(gpu));
}

// Times are the least of eight frames: other programs may interrupt a frame anywhere.
TEST_GPU(scopes_nest_and_sum_in_the_order_first_begun)
{
    if (!gpu_limits(gpu)->timestamps) test_skip("no timestamps");
    gpu_buffer words = test_gpu_buffer(gpu, 400000), total = test_gpu_buffer(gpu, 4);
    gpu_pipeline sum = test_gpu_compute(gpu, &shader_test_sum_comp);
    double thrice = INFINITY, nothing = INFINITY;
    struct gpu_timing t[8];
    for (int frame = 0; frame < 8; frame++) {
        record_scopes(gpu, sum, words, total);
        // Only the frame and innermost scopes are listed.
        assert_int_equal(gpu_frame_timings(gpu, t, 8), 4);
        CHECK_STRING(t[0].name, "frame");
        CHECK_STRING(t[1].name, "b.once");
        CHECK_STRING(t[2].name, "a.thrice");
        CHECK_STRING(t[3].name, "c.nothing");
        CHECK(t[1].ms > 0 && t[2].ms > 0 && t[3].ms >= 0);
        CHECK(t[1].ms + t[2].ms + t[3].ms <= t[0].ms + 1e-9);
        thrice = fmin(thrice, t[2].ms);
        nothing = fmin(nothing, t[3].ms);
    }
    CHECK(nothing < thrice);
    assert_int_equal(gpu_frame_timings(gpu, t, 2), 2);
    gpu_buffer_destroy(gpu, &words);
    gpu_buffer_destroy(gpu, &total);
    gpu_pipeline_destroy(gpu, &sum);
}

TEST_GPU(timings_are_of_the_newest_finished_frame)
{
    if (!gpu_limits(gpu)->timestamps) test_skip("no timestamps");
    for (int frame = 0; frame < 5; frame++) {
        char name[32], expected[32];
        struct gpu_timing t[4];
        snprintf(name, sizeof name, "frame.%d", frame);
        struct gpu_cmd *cmd = gpu_frame_begin(gpu);
        gpu_scope_begin(cmd, name);
        gpu_scope_end(cmd);
        CHECK(gpu_frame_end(gpu, cmd));
        if (frame < 3) continue;
        CHECK(gpu_wait(gpu));
        snprintf(expected, sizeof expected, "frame.%d", frame);
        assert_int_equal(gpu_frame_timings(gpu, t, 4), 2);
        CHECK_STRING(t[1].name, expected);
    }
}

TEST_GPU(scopes_without_a_dot_have_the_innermost_owner)
{
    if (!gpu_limits(gpu)->timestamps) test_skip("no timestamps");
    static const char *const names[] = { "alone", "vct.cones", "gpu.copy", "vo.lines", "vct.fill" };
    struct gpu_timing t[8];
    struct gpu_cmd *cmd = gpu_frame_begin(gpu);
    gpu_scope_begin(cmd, "alone");
    gpu_scope_end(cmd);
    gpu_owner_push(gpu, "vct");
    gpu_scope_begin(cmd, "cones");
    gpu_scope_end(cmd);
    gpu_scope_begin(cmd, "gpu.copy");
    gpu_scope_end(cmd);
    gpu_owner_push(gpu, "vo");
    gpu_scope_begin(cmd, "lines");
    gpu_scope_end(cmd);
    gpu_owner_pop(gpu);
    gpu_scope_begin(cmd, "fill");
    gpu_scope_end(cmd);
    gpu_owner_pop(gpu);
    CHECK(gpu_frame_end(gpu, cmd));
    CHECK(gpu_wait(gpu));
    assert_int_equal(gpu_frame_timings(gpu, t, 8), 6);
    for (int i = 0; i < 5; i++) CHECK_STRING(t[i + 1].name, names[i]);
}

TEST_GPU(scopes_beyond_the_limit_are_not_timed)
{
    struct gpu_timing t[300];
    struct gpu_cmd *cmd = gpu_frame_begin(gpu);
    for (int i = 0; i < 200; i++) {
        char name[16];
        snprintf(name, sizeof name, "s.%d", i);
        gpu_scope_begin(cmd, name);
        gpu_scope_end(cmd);
    }
    for (int i = 0; i < 40; i++) gpu_scope_begin(cmd, "deep");
    for (int i = 0; i < 40; i++) gpu_scope_end(cmd);
    CHECK(gpu_frame_end(gpu, cmd));
    CHECK(gpu_wait(gpu));
    assert_non_null(strstr(test_last_message(), "are timed"));
    int count = gpu_frame_timings(gpu, t, 300);
    if (gpu_limits(gpu)->timestamps) assert_in_range(count, 100, 199);
}

TEST_GPU(scopes_may_be_inside_a_rendering)
{
    gpu_image color = test_gpu_image(gpu, GPU_2D, GPU_RGBA8, 8, 8, 1, 1, GPU_ATTACHMENT);
    struct gpu_cmd *cmd = gpu_frame_begin(gpu);
    gpu_scope_begin(cmd, "around");
    gpu_render_begin(
        cmd, &(struct gpu_render_desc){
                 .color = { { .image = color } }, .color_count = 1, .width = 8, .height = 8 });
    gpu_scope_begin(cmd, "inside");
    gpu_scope_end(cmd);
    gpu_render_end(cmd);
    gpu_scope_end(cmd);
    CHECK(gpu_frame_end(gpu, cmd));
    gpu_image_destroy(gpu, &color);
}
