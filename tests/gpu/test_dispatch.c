// Compute: ordering through every kind of resource, constants, indirect dispatch, refused shaders.
#include "framework/gpu_test.h"
#include "gpu_test_shaders.h"

#include <string.h>

struct affine {
    uint32_t scale, offset, count;
};

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
    gpu_buffer buffer = test_gpu_buffer(gpu, COUNT * 4);
    gpu_pipeline pipeline = affine(gpu, 1);
    uint32_t expected = 0, got[COUNT];
    for (int frame = 0; frame < 4; frame++) { // and across submissions
        struct gpu_cmd *cmd = gpu_frame_begin(gpu);
        for (uint32_t i = 0; i < 10; i++) {
            struct affine push = { 3, i, COUNT };
            gpu_dispatch(cmd, pipeline, GPU_BIND({ "Values", .buffer = buffer }), &push,
                         sizeof push, gpu_groups(COUNT, 64), 1, 1);
            expected = expected * 3 + i;
        }
        CHECK(gpu_frame_end(gpu, cmd));
    }
    CHECK(gpu_buffer_download(gpu, buffer, 0, got, sizeof got));
    for (int i = 0; i < COUNT; i++) assert_int_equal(got[i], expected);
    gpu_buffer_destroy(gpu, &buffer);
    gpu_pipeline_destroy(gpu, &pipeline);
}

TEST_GPU(ping_pong_between_buffers_keeps_order)
{
    enum { COUNT = 300, STEPS = 25 };
    gpu_buffer buffers[2] = { test_gpu_buffer(gpu, COUNT * 4), test_gpu_buffer(gpu, COUNT * 4) };
    gpu_pipeline shift = test_gpu_compute(gpu, &shader_test_shift_comp);
    uint32_t values[COUNT], got[COUNT];
    for (uint32_t i = 0; i < COUNT; i++) values[i] = i * i;
    CHECK(gpu_buffer_upload(gpu, buffers[0], 0, values, sizeof values));
    struct gpu_cmd *cmd = gpu_frame_begin(gpu);
    for (int i = 0; i < STEPS; i++) {
        gpu_dispatch(
            cmd, shift,
            GPU_BIND({ "To", .buffer = buffers[1 - i % 2] }, { "From", .buffer = buffers[i % 2] }),
            NULL, 0, gpu_groups(COUNT, 64), 1, 1);
    }
    CHECK(gpu_frame_end(gpu, cmd));
    CHECK(gpu_buffer_download(gpu, buffers[STEPS % 2], 0, got, sizeof got));
    for (uint32_t i = 0; i < COUNT; i++)
        assert_int_equal(got[i], values[(i + STEPS) % COUNT] + STEPS);
    for (int i = 0; i < 2; i++) gpu_buffer_destroy(gpu, &buffers[i]);
    gpu_pipeline_destroy(gpu, &shift);
}

TEST_GPU(ping_pong_between_images_keeps_order)
{
    enum { SIZE = 16, STEPS = 21 };
    gpu_image images[2];
    for (int i = 0; i < 2; i++)
        images[i] = test_gpu_image(gpu, GPU_2D, GPU_R32U, SIZE, SIZE, 1, 1, GPU_STORAGE);
    gpu_pipeline step = test_gpu_compute(gpu, &shader_test_step_2d_comp);
    uint32_t values[SIZE * SIZE], got[SIZE * SIZE];
    for (uint32_t i = 0; i < SIZE * SIZE; i++) values[i] = i * 7;
    CHECK(gpu_image_upload(gpu, images[0], 0, 0, values, sizeof values));
    struct gpu_cmd *cmd = gpu_frame_begin(gpu);
    for (int i = 0; i < STEPS; i++) {
        gpu_dispatch(cmd, step,
                     GPU_BIND({ "source", .image = images[i % 2] },
                              { "destination", .image = images[1 - i % 2] }),
                     NULL, 0, SIZE / 8, SIZE / 8, 1);
    }
    CHECK(gpu_frame_end(gpu, cmd));
    CHECK(gpu_image_download(gpu, images[STEPS % 2], 0, 0, got, sizeof got));
    for (uint32_t y = 0; y < SIZE; y++) {
        for (uint32_t x = 0; x < SIZE; x++) {
            assert_int_equal(got[y * SIZE + x], values[y * SIZE + (x + STEPS) % SIZE] + STEPS);
        }
    }
    for (int i = 0; i < 2; i++) gpu_image_destroy(gpu, &images[i]);
    gpu_pipeline_destroy(gpu, &step);
}

TEST_GPU(in_place_updates_of_a_volume_keep_order)
{
    enum { SIZE = 8, DEPTH = 5, STEPS = 6 };
    gpu_image volume =
        test_gpu_image(gpu, GPU_3D, GPU_R32F, SIZE, SIZE, DEPTH, 1, GPU_STORAGE | GPU_SAMPLED);
    gpu_pipeline step = test_gpu_compute(gpu, &shader_test_volume_comp);
    struct gpu_cmd *cmd = gpu_frame_begin(gpu);
    for (int i = 0; i < STEPS; i++)
        gpu_dispatch(cmd, step, GPU_BIND({ "volume", .image = volume }), NULL, 0, 1, 1, DEPTH);
    CHECK(gpu_frame_end(gpu, cmd));
    float got[SIZE * SIZE * DEPTH];
    CHECK(gpu_image_download(gpu, volume, 0, 0, got, sizeof got));
    for (int i = 0; i < SIZE * SIZE * DEPTH; i++) {
        float z = (float)(i / (SIZE * SIZE));
        CHECK_NEAR(got[i], z * ((1 << STEPS) - 1), 0); // v ← 2v + z from 0
    }
    gpu_image_destroy(gpu, &volume);
    gpu_pipeline_destroy(gpu, &step);
}

// Each mip is written as a storage image, then sampled.
TEST_GPU(each_mip_is_computed_from_the_previous_one)
{
    enum { SIZE = 64, MIPS = 7 };
    gpu_image image =
        test_gpu_image(gpu, GPU_2D, GPU_R32F, SIZE, SIZE, 1, MIPS, GPU_STORAGE | GPU_SAMPLED);
    gpu_pipeline reduce = test_gpu_compute(gpu, &shader_test_reduce_comp);
    float texels[SIZE * SIZE], expected = 0, got;
    for (int i = 0; i < SIZE * SIZE; i++) expected += texels[i] = (float)(i % 17);
    CHECK(gpu_image_upload(gpu, image, 0, 0, texels, sizeof texels));
    struct gpu_cmd *cmd = gpu_frame_begin(gpu);
    for (uint32_t mip = 1; mip < MIPS; mip++) {
        uint32_t groups = gpu_groups(SIZE >> mip, 8);
        gpu_dispatch(cmd, reduce,
                     GPU_BIND({ "above", .image = image, .mip = mip - 1, .one_mip = true },
                              { "below", .image = image, .mip = mip }),
                     NULL, 0, groups, groups, 1);
    }
    CHECK(gpu_frame_end(gpu, cmd));
    CHECK(gpu_image_download_float(gpu, image, MIPS - 1, 0, &got, 1, 1));
    CHECK_NEAR(got, expected, 0);
    gpu_image_destroy(gpu, &image);
    gpu_pipeline_destroy(gpu, &reduce);
}

TEST_GPU(each_layer_is_computed_from_the_previous_one)
{
    enum { SIZE = 8, LAYERS = 6 };
    gpu_image image = test_gpu_image(gpu, GPU_2D_ARRAY, GPU_R32F, SIZE, SIZE, LAYERS, 1,
                                     GPU_STORAGE | GPU_SAMPLED);
    gpu_pipeline pipeline = test_gpu_compute(gpu, &shader_test_layer_comp);
    struct gpu_cmd *cmd = gpu_frame_begin(gpu);
    for (uint32_t layer = 1; layer < LAYERS; layer++) {
        gpu_dispatch(cmd, pipeline,
                     GPU_BIND({ "below", .image = image, .layer = layer - 1, .one_layer = true },
                              { "layer", .image = image, .layer = layer, .one_layer = true }),
                     NULL, 0, 1, 1, 1);
    }
    CHECK(gpu_frame_end(gpu, cmd));
    float got[SIZE * SIZE];
    for (uint32_t layer = 0; layer < LAYERS; layer++) {
        CHECK(gpu_image_download(gpu, image, 0, layer, got, sizeof got));
        for (int i = 0; i < SIZE * SIZE; i++) CHECK_NEAR(got[i], (float)layer, 0);
    }
    gpu_image_destroy(gpu, &image);
    gpu_pipeline_destroy(gpu, &pipeline);
}

TEST_GPU(clears_fills_and_copies_keep_order_with_dispatches)
{
    enum { COUNT = 128 };
    gpu_buffer a = test_gpu_buffer(gpu, COUNT * 4), b = test_gpu_buffer(gpu, COUNT * 4);
    gpu_pipeline pipeline = affine(gpu, 1);
    struct affine push = { 2, 1, COUNT };
    struct gpu_cmd *cmd = gpu_frame_begin(gpu);
    gpu_fill_buffer(cmd, a, 0, COUNT * 4, 5);
    gpu_dispatch(cmd, pipeline, GPU_BIND({ "Values", .buffer = a }), &push, sizeof push, 2, 1,
                 1); // 11
    gpu_copy_buffer(cmd, b, 0, a, 0, COUNT * 4);
    gpu_fill_buffer(cmd, a, 0, 64 * 4, 9);
    gpu_dispatch(cmd, pipeline, GPU_BIND({ "Values", .buffer = b }), &push, sizeof push, 2, 1,
                 1); // 23
    gpu_copy_buffer(cmd, a, 64 * 4, b, 0, 32 * 4);
    CHECK(gpu_frame_end(gpu, cmd));
    uint32_t got[COUNT];
    CHECK(gpu_buffer_download(gpu, a, 0, got, sizeof got));
    for (int i = 0; i < COUNT; i++) assert_int_equal(got[i], i < 64 ? 9 : i < 96 ? 23 : 11);
    gpu_buffer_destroy(gpu, &a);
    gpu_buffer_destroy(gpu, &b);
    gpu_pipeline_destroy(gpu, &pipeline);
}

TEST_GPU(images_are_cleared_and_copied_with_all_mips_and_layers)
{
    const struct gpu_image_desc descs[] = {
        { "test.a", GPU_2D_ARRAY, GPU_RGBA16F, 8, 4, 3, 2, GPU_SAMPLED, NULL },
        { "test.b", GPU_2D_ARRAY, GPU_RGBA16F, 8, 4, 3, 2, GPU_STORAGE, NULL },
        { "test.depth", GPU_2D_ARRAY, GPU_D32F, 8, 4, 3, 2, GPU_SAMPLED, NULL },
    };
    gpu_image images[3];
    for (int i = 0; i < 3; i++) CHECK(gpu_image_create(gpu, &descs[i], &images[i]));
    struct gpu_cmd *cmd = gpu_frame_begin(gpu);
    gpu_clear_image(cmd, images[0], (float[]){ 1, 2, 3, 4 });
    gpu_copy_image(cmd, images[1], images[0]);
    gpu_clear_image(cmd, images[0], (float[]){ 5, 6, 7, 8 });
    gpu_clear_image(cmd, images[2], (float[]){ 0.5f, 0, 0, 0 });
    CHECK(gpu_frame_end(gpu, cmd));
    float got[8][4];
    CHECK(gpu_image_download_float(gpu, images[1], 1, 2, got[0], 4, 8 * 4));
    for (int i = 0; i < 32; i++) CHECK_NEAR(got[i / 4][i % 4], i % 4 + 1, 0);
    CHECK(gpu_image_download_float(gpu, images[0], 1, 2, got[0], 4, 8 * 4));
    for (int i = 0; i < 32; i++) CHECK_NEAR(got[i / 4][i % 4], i % 4 + 5, 0);
    CHECK(gpu_image_download_float(gpu, images[2], 1, 2, got[0], 1, 8));
    CHECK_NEAR(got[1][3], 0.5, 0);
    for (int i = 0; i < 3; i++) gpu_image_destroy(gpu, &images[i]);
}

TEST_GPU(specialization_and_push_constants_reach_the_shader)
{
    gpu_buffer buffer = test_gpu_buffer(gpu, 64 * 4);
    gpu_pipeline one = affine(gpu, 1), hundred = affine(gpu, 100);
    struct affine push = { 1, 3, 10 };
    struct gpu_cmd *cmd = gpu_frame_begin(gpu);
    gpu_dispatch(cmd, one, GPU_BIND({ "Values", .buffer = buffer }), &push, sizeof push, 1, 1, 1);
    push.count = 5;
    gpu_dispatch(cmd, hundred, GPU_BIND({ "Values", .buffer = buffer }), &push, sizeof push, 1, 1,
                 1);
    CHECK(gpu_frame_end(gpu, cmd));
    uint32_t got[64];
    CHECK(gpu_buffer_download(gpu, buffer, 0, got, sizeof got));
    for (int i = 0; i < 64; i++) assert_int_equal(got[i], i < 5 ? 303 : i < 10 ? 3 : 0);
    gpu_buffer_destroy(gpu, &buffer);
    gpu_pipeline_destroy(gpu, &one);
    gpu_pipeline_destroy(gpu, &hundred);
}

TEST_GPU(an_indirect_dispatch_waits_for_its_arguments)
{
    enum { COUNT = 512 };
    gpu_buffer values = test_gpu_buffer(gpu, COUNT * 4), arguments = test_gpu_buffer(gpu, 16);
    gpu_pipeline write = test_gpu_compute(gpu, &shader_test_arguments_comp), add = affine(gpu, 1);
    struct gpu_cmd *cmd = gpu_frame_begin(gpu);
    struct affine push = { 1, 1, COUNT };
    const uint32_t counts[] = { 512, 128, 0 };
    for (int i = 0; i < 3; i++) {
        gpu_dispatch(cmd, write,
                     GPU_BIND(gpu_transient(cmd, "Count", &counts[i], 4),
                              { "Arguments", .buffer = arguments }),
                     NULL, 0, 1, 1, 1);
        gpu_dispatch_indirect(cmd, add, GPU_BIND({ "Values", .buffer = values }), &push,
                              sizeof push, arguments, 0);
    }
    CHECK(gpu_frame_end(gpu, cmd));
    uint32_t got[COUNT];
    CHECK(gpu_buffer_download(gpu, values, 0, got, sizeof got));
    for (int i = 0; i < COUNT; i++) assert_int_equal(got[i], i < 128 ? 2 : 1);
    gpu_buffer_destroy(gpu, &values);
    gpu_buffer_destroy(gpu, &arguments);
    gpu_pipeline_destroy(gpu, &write);
    gpu_pipeline_destroy(gpu, &add);
}

TEST_GPU(transient_data_larger_than_its_ring_is_correct)
{
    enum {
        BLOCKS = 60,
        WORDS = 3000,
        FRAMES = 5
    }; // 700 KiB a frame, from a ring that begins with 64
    static uint32_t words[WORDS];
    gpu_buffer total = test_gpu_buffer(gpu, 4);
    gpu_pipeline sum = test_gpu_compute(gpu, &shader_test_sum_comp);
    uint32_t expected = 0, got;
    for (int frame = 0; frame < FRAMES; frame++) {
        struct gpu_cmd *cmd = gpu_frame_begin(gpu);
        for (uint32_t block = 0; block < BLOCKS; block++) {
            for (uint32_t i = 0; i < WORDS; i++) expected += words[i] = block * i + (uint32_t)frame;
            gpu_dispatch(cmd, sum,
                         GPU_BIND(gpu_transient(cmd, "Words", words, sizeof words),
                                  { "Total", .buffer = total }),
                         NULL, 0, 1, 1, 1);
        }
        CHECK(gpu_frame_end(gpu, cmd));
    }
    CHECK(gpu_buffer_download(gpu, total, 0, &got, 4));
    assert_int_equal(got, expected);
    gpu_buffer_destroy(gpu, &total);
    gpu_pipeline_destroy(gpu, &sum);
}

// A frame uses its first binding (its constants, for example) to the end.
TEST_GPU(a_binding_stays_valid_when_the_ring_grows)
{
    enum { WORDS = 3000, BLOCKS = 100 };
    static uint32_t ones[WORDS], zeros[WORDS];
    for (int i = 0; i < WORDS; i++) ones[i] = 1;
    gpu_buffer total = test_gpu_buffer(gpu, 4);
    gpu_pipeline sum = test_gpu_compute(gpu, &shader_test_sum_comp);
    struct gpu_cmd *cmd = gpu_frame_begin(gpu);
    const struct gpu_binding first = gpu_transient(cmd, "Words", ones, sizeof ones);
    for (int block = 0; block < BLOCKS; block++) gpu_transient(cmd, "Words", zeros, sizeof zeros);
    gpu_dispatch(cmd, sum, GPU_BIND(first, { "Total", .buffer = total }), NULL, 0, 1, 1, 1);
    CHECK(gpu_frame_end(gpu, cmd));
    uint32_t got;
    CHECK(gpu_buffer_download(gpu, total, 0, &got, 4));
    assert_int_equal(got, WORDS);
    gpu_buffer_destroy(gpu, &total);
    gpu_pipeline_destroy(gpu, &sum);
}

TEST_GPU(bindings_that_a_shader_does_not_use_are_optional)
{
    gpu_buffer values = test_gpu_buffer(gpu, 8 * 4);
    gpu_pipeline pipeline = test_gpu_compute(gpu, &shader_test_unused_comp);
    struct gpu_cmd *cmd = gpu_frame_begin(gpu);
    gpu_dispatch(cmd, pipeline, GPU_BIND({ "Values", .buffer = values }), NULL, 0, 1, 1, 1);
    CHECK(gpu_frame_end(gpu, cmd));
    uint32_t got[8];
    CHECK(gpu_buffer_download(gpu, values, 0, got, sizeof got));
    for (uint32_t i = 0; i < 8; i++) assert_int_equal(got[i], i);
    gpu_buffer_destroy(gpu, &values);
    gpu_pipeline_destroy(gpu, &pipeline);
}

TEST_GPU(cube_faces_are_in_vulkans_order)
{
    gpu_image cube = test_gpu_image(gpu, GPU_CUBE, GPU_R32F, 4, 4, 0, 1, GPU_SAMPLED);
    gpu_buffer faces = test_gpu_buffer(gpu, 6 * 4);
    gpu_pipeline pipeline = test_gpu_compute(gpu, &shader_test_cube_comp);
    for (uint32_t face = 0; face < 6; face++) {
        float texels[16];
        for (int i = 0; i < 16; i++) texels[i] = (float)face + 1;
        CHECK(gpu_image_upload(gpu, cube, 0, face, texels, sizeof texels));
    }
    struct gpu_cmd *cmd = gpu_frame_begin(gpu);
    gpu_dispatch(cmd, pipeline, GPU_BIND({ "cube", .image = cube }, { "Faces", .buffer = faces }),
                 NULL, 0, 1, 1, 1);
    CHECK(gpu_frame_end(gpu, cmd));
    float got[6];
    CHECK(gpu_buffer_download(gpu, faces, 0, got, sizeof got));
    for (int i = 0; i < 6; i++) CHECK_NEAR(got[i], i + 1, 0);
    gpu_image_destroy(gpu, &cube);
    gpu_buffer_destroy(gpu, &faces);
    gpu_pipeline_destroy(gpu, &pipeline);
}

TEST_GPU(zero_groups_dispatch_nothing_and_too_many_are_refused)
{
    gpu_buffer buffer = test_gpu_buffer(gpu, 64 * 4);
    gpu_pipeline pipeline = affine(gpu, 1);
    struct affine push = { 1, 1, 64 };
    uint32_t beyond = gpu_limits(gpu)->max_groups[1] + 1;
    struct gpu_cmd *cmd = gpu_frame_begin(gpu);
    gpu_dispatch(cmd, pipeline, GPU_BIND({ "Values", .buffer = buffer }), &push, sizeof push, 1, 0,
                 1);
    assert_string_equal(test_last_message(), "");
    gpu_dispatch(cmd, pipeline, GPU_BIND({ "Values", .buffer = buffer }), &push, sizeof push, 1,
                 beyond, 1);
    assert_non_null(strstr(test_last_message(), "test.affine"));
    CHECK(gpu_frame_end(gpu, cmd));
    uint32_t got[64];
    CHECK(gpu_buffer_download(gpu, buffer, 0, got, sizeof got));
    for (int i = 0; i < 64; i++) assert_int_equal(got[i], 0);
    gpu_buffer_destroy(gpu, &buffer);
    gpu_pipeline_destroy(gpu, &pipeline);
}

static void check_refused(struct gpu *gpu, const struct gpu_shader *shader, const char *why)
{
    gpu_pipeline pipeline;
    test_forget_messages();
    assert_false(gpu_compute_pipeline_create(gpu, "test.refused", shader, NULL, 0, &pipeline));
    assert_int_equal(pipeline.id, 0);
    if (!strstr(test_last_message(), why))
        fail_msg("\"%s\" does not say \"%s\"", test_last_message(), why);
}

TEST_GPU(invalid_shaders_are_refused_with_the_reason)
{
    uint32_t words[4096];
    struct gpu_shader shader = shader_test_affine_comp;
    assert_true(shader.word_count < 4096);
    memcpy(words, shader.words, shader.word_count * 4);
    check_refused(gpu, &shader_test_array_comp, "array of bindings");
    check_refused(gpu, &shader_test_triangle_vert, "another stage");
    shader.words = words;
    for (size_t count = 0; count < shader_test_affine_comp.word_count;
         count++) { // truncated at every length
        shader.word_count = count;
        check_refused(gpu, &shader, count < 5 ? "not SPIR-V" : "");
    }
    shader.word_count = shader_test_affine_comp.word_count;
    words[0] ^= 1;
    check_refused(gpu, &shader, "not SPIR-V");
    gpu_pipeline pipeline;
    struct gpu_constant unknown = { 77, 1 };
    assert_false(gpu_compute_pipeline_create(gpu, "test.refused", &shader_test_affine_comp,
                                             &unknown, 1, &pipeline));
    assert_non_null(strstr(test_last_message(), "77"));
}

#ifdef NDEBUG // debug builds assert instead
// Expects the frame to fail with this message.
static void check_misused(struct gpu *gpu, struct gpu_cmd *cmd, const char *says)
{
    if (!strstr(test_last_message(), says)) fail_msg("\"%s\"", test_last_message());
    assert_false(gpu_frame_end(gpu, cmd));
    test_forget_messages();
}

TEST_GPU(a_misused_dispatch_is_logged_and_skipped_and_fails_its_frame)
{
    gpu_buffer buffer = test_gpu_buffer(gpu, 64 * 4);
    gpu_image image = test_gpu_image(gpu, GPU_2D, GPU_R32U, 8, 8, 1, 1, GPU_SAMPLED);
    gpu_pipeline pipeline = affine(gpu, 1), step = test_gpu_compute(gpu, &shader_test_step_2d_comp);
    struct affine push = { 1, 1, 64 };
    struct gpu_cmd *cmd = gpu_frame_begin(gpu);
    gpu_dispatch(cmd, pipeline, GPU_BIND({ "Vaules", .buffer = buffer }), &push, sizeof push, 1, 1,
                 1);
    check_misused(gpu, cmd, "nothing is bound to \"Values\"");
    cmd = gpu_frame_begin(gpu);
    gpu_dispatch(cmd, pipeline, GPU_BIND({ "Values", .buffer = buffer }), &push, 4, 1, 1, 1);
    check_misused(gpu, cmd, "push constants");
    cmd = gpu_frame_begin(gpu);
    gpu_dispatch(cmd, pipeline, GPU_BIND({ "Values", .image = image }), &push, sizeof push, 1, 1,
                 1);
    check_misused(gpu, cmd, "no buffer");
    cmd = gpu_frame_begin(gpu);
    gpu_dispatch(cmd, pipeline, GPU_BIND({ "Values", .buffer = buffer, .offset = 256 }), &push,
                 sizeof push, 1, 1, 1);
    check_misused(gpu, cmd, "cannot see");
    cmd = gpu_frame_begin(gpu);
    gpu_dispatch(cmd, step,
                 GPU_BIND({ "source", .image = image }, { "destination", .image = image }), NULL, 0,
                 1, 1, 1);
    check_misused(gpu, cmd, "was not created for");
    cmd = gpu_frame_begin(gpu);
    gpu_dispatch(cmd, (gpu_pipeline){ 0 }, NULL, 0, NULL, 0, 1, 1, 1);
    check_misused(gpu, cmd, "none");
    uint32_t got[64];
    CHECK(gpu_buffer_download(gpu, buffer, 0, got, sizeof got));
    for (int i = 0; i < 64; i++) assert_int_equal(got[i], 0);
    gpu_buffer_destroy(gpu, &buffer);
    gpu_image_destroy(gpu, &image);
    gpu_pipeline_destroy(gpu, &pipeline);
    gpu_pipeline_destroy(gpu, &step);
}
#endif
