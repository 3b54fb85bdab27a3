// Reloading of shaders that changed on disk.
#include "framework/gpu_test.h"
#include "gpu_test_shaders.h"

#include <stdio.h>
#include <string.h>

static const char file_name[] = "test_reload.comp.spv";

static void write_file(const char *path, const void *data, size_t bytes)
{
    FILE *file = fopen(path, "wb");
    CHECK(file && fwrite(data, 1, bytes, file) == bytes && fclose(file) == 0);
}

// The value that the pipeline writes.
static uint32_t run(struct gpu *gpu, gpu_pipeline pipeline)
{
    const uint32_t push[2] = { 0 };
    gpu_buffer values = test_gpu_buffer(gpu, 8 * 4);
    struct gpu_cmd *cmd = gpu_frame_begin(gpu);
    gpu_dispatch(cmd, pipeline, GPU_BIND({ "Values", .buffer = values }), push, sizeof push, 1, 1,
                 1);
    CHECK(gpu_frame_end(gpu, cmd));
    uint32_t got = 0;
    CHECK(gpu_buffer_download(gpu, values, 0, &got, 4));
    gpu_buffer_destroy(gpu, &values);
    return got;
}

TEST(a_changed_shader_is_reloaded_and_an_invalid_one_is_not)
{
    test_gpu_require();
    char path[512];
    snprintf(path, sizeof path, "%s", test_path(file_name));
    remove(path);
    const struct gpu_shader *first = &shader_test_reload_comp,
                            *second = &shader_test_reload_changed_comp;
    struct gpu *gpu = gpu_create(
        test_host(), &(struct gpu_desc){ .validation = true, .shader_dir = test_path("") });
    CHECK(gpu != NULL);
    gpu_pipeline pipeline = test_gpu_compute(gpu, first);
    assert_int_equal(run(gpu, pipeline), 1);
    assert_int_equal(gpu_reload_shaders(gpu), 0); // there is no file yet

    write_file(path, second->words, second->word_count * 4);
    assert_int_equal(gpu_reload_shaders(gpu), 1);
    assert_int_equal(run(gpu, pipeline), 2); // another value, through another binding
    assert_int_equal(gpu_reload_shaders(gpu), 0);

    write_file(path, second->words, second->word_count * 4 - 20); // truncated
    test_forget_messages();
    assert_int_equal(gpu_reload_shaders(gpu), 0);
    assert_non_null(strstr(test_last_message(), "the previous one is kept"));
    assert_int_equal(run(gpu, pipeline), 2);
    write_file(path, "text", 3);
    assert_int_equal(gpu_reload_shaders(gpu), 0);
    assert_int_equal(run(gpu, pipeline), 2);

    write_file(path, first->words, first->word_count * 4);
    assert_int_equal(gpu_reload_shaders(gpu), 1);
    assert_int_equal(run(gpu, pipeline), 1);
    gpu_pipeline_destroy(gpu, &pipeline);

    // An existing file is used.
    write_file(path, second->words, second->word_count * 4);
    pipeline = test_gpu_compute(gpu, first);
    assert_int_equal(run(gpu, pipeline), 2);
    gpu_pipeline_destroy(gpu, &pipeline);
    write_file(path, "text", 4); // unless it is invalid
    test_forget_messages();
    pipeline = test_gpu_compute(gpu, first);
    assert_non_null(strstr(test_last_message(), "the embedded one is used"));
    assert_int_equal(run(gpu, pipeline), 1);
    gpu_pipeline_destroy(gpu, &pipeline);
    test_gpu_finish(gpu);
    gpu_destroy(gpu);
}

TEST(a_missing_shader_folder_is_reported)
{
    test_gpu_require();
    struct host host = *test_host();
    host.log_up_to = LOG_WARNING; // the warning is then the last message
    test_forget_messages();
    struct gpu *gpu = gpu_create(&host, &(struct gpu_desc){ .shader_dir = test_path("nowhere") });
    CHECK(gpu != NULL);
    assert_non_null(strstr(test_last_message(), "No such file or directory"));
    gpu_destroy(gpu);
}

TEST_GPU(without_a_folder_nothing_is_reloaded)
{
    gpu_pipeline pipeline = test_gpu_compute(gpu, &shader_test_reload_comp);
    assert_int_equal(gpu_reload_shaders(gpu), 0);
    gpu_pipeline_destroy(gpu, &pipeline);
}
