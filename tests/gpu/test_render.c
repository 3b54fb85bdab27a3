// Rendering: depth, culling, blending, every kind of target, barriers around renderings.
#include "framework/gpu_test.h"
#include "gpu_test_shaders.h"

#include <string.h>

enum { WIDTH = 16, HEIGHT = 8, PIXELS = WIDTH * HEIGHT };

struct push {
    float color[4], depth, size;
};

static const struct gpu_graphics_desc triangle_desc = {
    .name = "test.triangle",
    .vertex = &shader_test_triangle_vert,
    .fragment = &shader_test_triangle_frag,
    .color_formats = { GPU_RGBA32F },
};

static gpu_pipeline graphics(struct gpu *gpu, const struct gpu_graphics_desc *desc)
{
    gpu_pipeline pipeline;
    if (!gpu_graphics_pipeline_create(gpu, desc, &pipeline))
        fail_msg("no pipeline: %s", test_last_message());
    return pipeline;
}

static gpu_image target(struct gpu *gpu, enum gpu_format format, uint32_t usage)
{
    return test_gpu_image(gpu, GPU_2D, format, WIDTH, HEIGHT, 1, 1, GPU_ATTACHMENT | usage);
}

static void begin(struct gpu_cmd *cmd, gpu_image color, bool load)
{
    gpu_render_begin(cmd, &(struct gpu_render_desc){ .color = { { .image = color, .load = load } },
                                                     .color_count = 1,
                                                     .width = WIDTH,
                                                     .height = HEIGHT });
}

static void draw(struct gpu_cmd *cmd, gpu_pipeline pipeline, float value, float depth)
{
    struct push push = { { value, value, value, 1 }, depth, 1 };
    gpu_draw(cmd, &(struct gpu_draw_desc){
                      .pipeline = pipeline, .push = &push, .push_bytes = sizeof push, .count = 3 });
}

static void check_red(struct gpu *gpu, gpu_image image, uint32_t mip, uint32_t layer, size_t count,
                      float expected)
{
    float got[PIXELS];
    assert_true(count <= PIXELS);
    CHECK(gpu_image_download_float(gpu, image, mip, layer, got, 1, count));
    for (size_t i = 0; i < count; i++) CHECK_NEAR(got[i], expected, 1e-6);
}

TEST_GPU(the_nearer_triangle_wins_with_reversed_depth)
{
    gpu_image color = target(gpu, GPU_RGBA32F, 0), depth = target(gpu, GPU_D32F, 0);
    struct gpu_graphics_desc desc = triangle_desc;
    desc.depth_format = GPU_D32F;
    desc.depth_compare = GPU_GREATER;
    desc.depth_write = true;
    gpu_pipeline pipeline = graphics(gpu, &desc);
    struct gpu_cmd *cmd = gpu_frame_begin(gpu);
    gpu_render_begin(cmd, &(struct gpu_render_desc){ .color = { { .image = color } },
                                                     .color_count = 1,
                                                     .depth = { .image = depth },
                                                     .width = WIDTH,
                                                     .height = HEIGHT });
    draw(cmd, pipeline, 1, 0.5f);
    draw(cmd, pipeline, 2, 0.75f);
    draw(cmd, pipeline, 3, 0.25f);
    gpu_render_end(cmd);
    CHECK(gpu_frame_end(gpu, cmd));
    check_red(gpu, color, 0, 0, PIXELS, 2);
    check_red(gpu, depth, 0, 0, PIXELS, 0.75f);
    gpu_image_destroy(gpu, &color);
    gpu_image_destroy(gpu, &depth);
    gpu_pipeline_destroy(gpu, &pipeline);
}

TEST_GPU(counter_clockwise_faces_are_front_faces)
{
    const struct {
        enum gpu_cull cull;
        bool flip;
        float expected;
    } cases[] = { { GPU_CULL_NONE, false, 1 },  { GPU_CULL_NONE, true, 1 },
                  { GPU_CULL_BACK, false, 1 },  { GPU_CULL_BACK, true, 0 },
                  { GPU_CULL_FRONT, false, 0 }, { GPU_CULL_FRONT, true, 1 } };
    gpu_image color = target(gpu, GPU_RGBA32F, 0);
    gpu_pipeline pipeline = graphics(gpu, &triangle_desc);
    for (int i = 0; i < 6; i++) {
        struct push push = { { 1, 1, 1, 1 }, 0, 1 };
        struct gpu_cmd *cmd = gpu_frame_begin(gpu);
        begin(cmd, color, false);
        gpu_draw(cmd, &(struct gpu_draw_desc){ .pipeline = pipeline,
                                               .push = &push,
                                               .push_bytes = sizeof push,
                                               .count = 3,
                                               .cull = cases[i].cull,
                                               .flip_front = cases[i].flip });
        gpu_render_end(cmd);
        CHECK(gpu_frame_end(gpu, cmd));
        check_red(gpu, color, 0, 0, PIXELS, cases[i].expected);
    }
    gpu_image_destroy(gpu, &color);
    gpu_pipeline_destroy(gpu, &pipeline);
}

TEST_GPU(loaded_targets_are_blended)
{
    gpu_image color = target(gpu, GPU_RGBA32F, 0);
    struct gpu_graphics_desc desc = triangle_desc;
    desc.blend = GPU_BLEND_ADD;
    gpu_pipeline pipeline = graphics(gpu, &desc);
    struct gpu_cmd *cmd = gpu_frame_begin(gpu);
    begin(cmd, color, true); // a new image loads zero
    draw(cmd, pipeline, 1, 0);
    draw(cmd, pipeline, 2, 0);
    gpu_render_end(cmd);
    begin(cmd, color, true);
    draw(cmd, pipeline, 4, 0);
    gpu_render_end(cmd);
    CHECK(gpu_frame_end(gpu, cmd));
    check_red(gpu, color, 0, 0, PIXELS, 7);
    gpu_image_destroy(gpu, &color);
    gpu_pipeline_destroy(gpu, &pipeline);
}

TEST_GPU(a_rendering_without_draws_clears_its_targets)
{
    gpu_image color = target(gpu, GPU_R32U, 0), depth = target(gpu, GPU_D32F, 0);
    struct gpu_cmd *cmd = gpu_frame_begin(gpu);
    gpu_render_begin(cmd,
                     &(struct gpu_render_desc){ .color = { { .image = color, .clear = { 41 } } },
                                                .color_count = 1,
                                                .depth = { .image = depth, .clear = { 0.5f } },
                                                .width = WIDTH,
                                                .height = HEIGHT });
    gpu_render_end(cmd);
    CHECK(gpu_frame_end(gpu, cmd));
    check_red(gpu, color, 0, 0, PIXELS, 41);
    check_red(gpu, depth, 0, 0, PIXELS, 0.5f);
    gpu_image_destroy(gpu, &color);
    gpu_image_destroy(gpu, &depth);
}

TEST_GPU(a_smaller_rendering_leaves_the_rest_zero)
{
    gpu_image color = target(gpu, GPU_RGBA32F, 0);
    struct gpu_cmd *cmd = gpu_frame_begin(gpu);
    gpu_render_begin(cmd,
                     &(struct gpu_render_desc){ .color = { { .image = color, .clear = { 1 } } },
                                                .color_count = 1,
                                                .width = WIDTH,
                                                .height = 2 });
    gpu_render_end(cmd);
    CHECK(gpu_frame_end(gpu, cmd));
    float got[PIXELS];
    CHECK(gpu_image_download_float(gpu, color, 0, 0, got, 1, PIXELS));
    for (int i = 0; i < PIXELS; i++) CHECK_NEAR(got[i], i < 2 * WIDTH ? 1 : 0, 0);
    gpu_image_destroy(gpu, &color);
}

TEST_GPU(a_target_is_sampled_and_rendered_again)
{
    gpu_image images[2] = { target(gpu, GPU_RGBA32F, GPU_SAMPLED),
                            target(gpu, GPU_RGBA32F, GPU_SAMPLED) };
    struct gpu_graphics_desc desc = triangle_desc;
    gpu_pipeline plain = graphics(gpu, &desc);
    desc.fragment = &shader_test_textured_frag;
    desc.name = "test.textured";
    gpu_pipeline doubling = graphics(gpu, &desc);
    float expected = 3;
    for (int frame = 0; frame < 3; frame++) {
        struct gpu_cmd *cmd = gpu_frame_begin(gpu);
        begin(cmd, images[0], false);
        draw(cmd, plain, 3, 0);
        gpu_render_end(cmd);
        expected = 3;
        for (int i = 0; i < 6; i++) {
            struct gpu_binding source = { .name = "image", .image = images[i % 2] };
            // Some renderings list the texture in `reads`, others not: all must wait.
            gpu_render_begin(cmd,
                             &(struct gpu_render_desc){ .color = { { .image = images[1 - i % 2] } },
                                                        .color_count = 1,
                                                        .width = WIDTH,
                                                        .height = HEIGHT,
                                                        .reads = &source,
                                                        .read_count = i % 4 < 2 });
            struct push push = { { 0 }, 0, 1 };
            gpu_draw(cmd, &(struct gpu_draw_desc){ .pipeline = doubling,
                                                   .bindings = &source,
                                                   .binding_count = 1,
                                                   .push = &push,
                                                   .push_bytes = sizeof push,
                                                   .count = 3 });
            gpu_render_end(cmd);
            expected *= 2;
        }
        CHECK(gpu_frame_end(gpu, cmd));
    }
    check_red(gpu, images[0], 0, 0, PIXELS, expected);
    for (int i = 0; i < 2; i++) gpu_image_destroy(gpu, &images[i]);
    gpu_pipeline_destroy(gpu, &plain);
    gpu_pipeline_destroy(gpu, &doubling);
}

// The second draw samples an image that was just cleared and is not listed in `reads`: the
// rendering is interrupted and must then load its target.
TEST_GPU(an_interrupted_rendering_keeps_its_target)
{
    gpu_image color = target(gpu, GPU_RGBA32F, 0), values = target(gpu, GPU_RGBA32F, GPU_SAMPLED);
    struct gpu_graphics_desc desc = triangle_desc;
    desc.blend = GPU_BLEND_ADD;
    gpu_pipeline plain = graphics(gpu, &desc);
    desc.fragment = &shader_test_textured_frag;
    gpu_pipeline doubling = graphics(gpu, &desc);
    struct gpu_cmd *cmd = gpu_frame_begin(gpu);
    gpu_clear_image(cmd, values, (float[]){ 5, 5, 5, 5 });
    begin(cmd, color, false);
    draw(cmd, plain, 1, 0);
    struct push push = { { 0 }, 0, 1 };
    gpu_draw(cmd, &(struct gpu_draw_desc){ .pipeline = doubling,
                                           GPU_BIND({ "image", .image = values }),
                                           .push = &push,
                                           .push_bytes = sizeof push,
                                           .count = 3 });
    draw(cmd, plain, 100, 0);
    gpu_render_end(cmd);
    CHECK(gpu_frame_end(gpu, cmd));
    check_red(gpu, color, 0, 0, PIXELS, 111);
    gpu_image_destroy(gpu, &color);
    gpu_image_destroy(gpu, &values);
    gpu_pipeline_destroy(gpu, &plain);
    gpu_pipeline_destroy(gpu, &doubling);
}

TEST_GPU(a_dispatch_reads_a_target)
{
    gpu_image color = target(gpu, GPU_RGBA32F, GPU_SAMPLED | GPU_STORAGE);
    gpu_buffer texels = test_gpu_buffer(gpu, PIXELS * 16);
    gpu_pipeline plain = graphics(gpu, &triangle_desc),
                 fetch = test_gpu_compute(gpu, &shader_test_fetch_comp);
    struct gpu_cmd *cmd = gpu_frame_begin(gpu);
    for (int i = 1; i <= 3; i++) { // each rendering waits for the previous dispatch
        begin(cmd, color, false);
        draw(cmd, plain, (float)i, 0);
        gpu_render_end(cmd);
        gpu_dispatch(cmd, fetch,
                     GPU_BIND({ "image", .image = color }, { "Texels", .buffer = texels }), NULL, 0,
                     WIDTH / 8, HEIGHT / 8, 1);
    }
    CHECK(gpu_frame_end(gpu, cmd));
    float got[PIXELS][4];
    CHECK(gpu_buffer_download(gpu, texels, 0, got, sizeof got));
    for (int i = 0; i < PIXELS; i++) CHECK_NEAR(got[i][0], 3, 0);
    gpu_image_destroy(gpu, &color);
    gpu_buffer_destroy(gpu, &texels);
    gpu_pipeline_destroy(gpu, &plain);
    gpu_pipeline_destroy(gpu, &fetch);
}

TEST_GPU(each_layer_of_a_depth_array_is_compared)
{
    enum { LAYERS = 3 };
    gpu_image depth = test_gpu_image(gpu, GPU_2D_ARRAY, GPU_D32F, WIDTH, HEIGHT, LAYERS, 1,
                                     GPU_ATTACHMENT | GPU_SAMPLED);
    gpu_buffer lit = test_gpu_buffer(gpu, PIXELS * 4);
    struct gpu_graphics_desc desc = triangle_desc;
    desc.fragment = NULL;
    desc.color_formats[0] = GPU_FORMAT_NONE;
    desc.depth_format = GPU_D32F;
    desc.depth_compare = GPU_GREATER;
    desc.depth_write = true;
    gpu_pipeline casters = graphics(gpu, &desc),
                 compare = test_gpu_compute(gpu, &shader_test_shadow_comp);
    gpu_sampler sampler;
    CHECK(gpu_sampler_get(gpu,
                          &(struct gpu_sampler_desc){ .name = "test.shadow",
                                                      .compare_greater = true,
                                                      .wrap_u = GPU_CLAMP,
                                                      .wrap_v = GPU_CLAMP },
                          &sampler));
    struct gpu_cmd *cmd = gpu_frame_begin(gpu);
    for (uint32_t layer = 0; layer < LAYERS; layer++) {
        gpu_render_begin(cmd,
                         &(struct gpu_render_desc){ .depth = { .image = depth, .layer = layer },
                                                    .width = WIDTH,
                                                    .height = HEIGHT });
        draw(cmd, casters, 0, 0.25f * (float)(layer + 1));
        gpu_render_end(cmd);
    }
    CHECK(gpu_frame_end(gpu, cmd));
    for (uint32_t layer = 0; layer < LAYERS; layer++) {
        float reference = 0.5f, got[PIXELS];
        cmd = gpu_frame_begin(gpu);
        gpu_dispatch(cmd, compare,
                     GPU_BIND({ "shadow", .image = depth, .sampler = sampler, .layer = layer,
                                .one_layer = true },
                              { "Lit", .buffer = lit }),
                     &reference, sizeof reference, WIDTH / 8, HEIGHT / 8, 1);
        CHECK(gpu_frame_end(gpu, cmd));
        CHECK(gpu_buffer_download(gpu, lit, 0, got, sizeof got));
        for (int i = 0; i < PIXELS; i++)
            CHECK_NEAR(got[i], layer < 2 ? 1 : 0, 0); // 0.5 ≥ 0.25, 0.5 ≥ 0.5, 0.5 < 0.75
    }
    gpu_image_destroy(gpu, &depth);
    gpu_buffer_destroy(gpu, &lit);
    gpu_pipeline_destroy(gpu, &casters);
    gpu_pipeline_destroy(gpu, &compare);
}

TEST_GPU(each_mip_is_rendered_from_the_previous_one)
{
    enum { MIPS = 4 };
    gpu_image image = test_gpu_image(gpu, GPU_2D, GPU_RGBA32F, WIDTH, HEIGHT, 1, MIPS,
                                     GPU_ATTACHMENT | GPU_SAMPLED);
    struct gpu_graphics_desc desc = triangle_desc;
    gpu_pipeline plain = graphics(gpu, &desc);
    desc.fragment = &shader_test_textured_frag;
    gpu_pipeline doubling = graphics(gpu, &desc);
    struct gpu_cmd *cmd = gpu_frame_begin(gpu);
    begin(cmd, image, false);
    draw(cmd, plain, 1, 0);
    gpu_render_end(cmd);
    for (uint32_t mip = 1; mip < MIPS; mip++) {
        struct push push = { { 0 }, 0, 1 };
        gpu_render_begin(cmd,
                         &(struct gpu_render_desc){ .color = { { .image = image, .mip = mip } },
                                                    .color_count = 1,
                                                    .width = WIDTH >> mip,
                                                    .height = HEIGHT >> mip });
        gpu_draw(cmd, &(struct gpu_draw_desc){
                          .pipeline = doubling,
                          GPU_BIND({ "image", .image = image, .mip = mip - 1, .one_mip = true }),
                          .push = &push,
                          .push_bytes = sizeof push,
                          .count = 3 });
        gpu_render_end(cmd);
    }
    CHECK(gpu_frame_end(gpu, cmd));
    for (uint32_t mip = 0; mip < MIPS; mip++) {
        check_red(gpu, image, mip, 0, (size_t)(WIDTH >> mip) * (HEIGHT >> mip), (float)(1 << mip));
    }
    gpu_image_destroy(gpu, &image);
    gpu_pipeline_destroy(gpu, &plain);
    gpu_pipeline_destroy(gpu, &doubling);
}

TEST_GPU(slices_of_a_volume_are_targets)
{
    enum { DEPTH = 4 };
    gpu_image volume = test_gpu_image(gpu, GPU_3D, GPU_RGBA32F, WIDTH, HEIGHT, DEPTH, 1,
                                      GPU_ATTACHMENT | GPU_STORAGE);
    gpu_pipeline plain = graphics(gpu, &triangle_desc);
    struct gpu_cmd *cmd = gpu_frame_begin(gpu);
    for (uint32_t slice = 1; slice < DEPTH; slice++) {
        gpu_render_begin(
            cmd, &(struct gpu_render_desc){ .color = { { .image = volume, .layer = slice } },
                                            .color_count = 1,
                                            .width = WIDTH,
                                            .height = HEIGHT });
        draw(cmd, plain, (float)slice, 0);
        gpu_render_end(cmd);
    }
    CHECK(gpu_frame_end(gpu, cmd));
    float got[PIXELS * DEPTH];
    CHECK(gpu_image_download_float(gpu, volume, 0, 0, got, 1, PIXELS * DEPTH));
    for (int i = 0; i < PIXELS * DEPTH; i++) CHECK_NEAR(got[i], i / PIXELS, 0);
    gpu_image_destroy(gpu, &volume);
    gpu_pipeline_destroy(gpu, &plain);
}

TEST_GPU(fragments_write_buffers_that_the_next_pass_reads)
{
    gpu_image color = target(gpu, GPU_RGBA32F, 0);
    gpu_buffer counter = test_gpu_buffer(gpu, 4), total = test_gpu_buffer(gpu, 4);
    struct gpu_graphics_desc desc = triangle_desc;
    desc.fragment = &shader_test_count_frag;
    gpu_pipeline count = graphics(gpu, &desc), sum = test_gpu_compute(gpu, &shader_test_sum_comp);
    struct push push = { { 0 }, 0, 1 };
    struct gpu_binding binding = { .name = "Counter", .buffer = counter };
    struct gpu_cmd *cmd = gpu_frame_begin(gpu);
    for (int i = 0; i < 3; i++) {
        gpu_render_begin(cmd, &(struct gpu_render_desc){ .color = { { .image = color } },
                                                         .color_count = 1,
                                                         .width = WIDTH,
                                                         .height = HEIGHT,
                                                         .reads = &binding,
                                                         .read_count = 1 });
        for (int k = 0; k < 2; k++) {
            gpu_draw(cmd, &(struct gpu_draw_desc){ .pipeline = count,
                                                   .bindings = &binding,
                                                   .binding_count = 1,
                                                   .push = &push,
                                                   .push_bytes = sizeof push,
                                                   .count = 3 });
        }
        gpu_render_end(cmd);
        gpu_dispatch(cmd, sum,
                     GPU_BIND({ "Words", .buffer = counter }, { "Total", .buffer = total }), NULL,
                     0, 1, 1, 1);
    }
    CHECK(gpu_frame_end(gpu, cmd));
    uint32_t got;
    CHECK(gpu_buffer_download(gpu, total, 0, &got, 4));
    assert_int_equal(got, PIXELS * 2 * (1 + 2 + 3));
    gpu_image_destroy(gpu, &color);
    gpu_buffer_destroy(gpu, &counter);
    gpu_buffer_destroy(gpu, &total);
    gpu_pipeline_destroy(gpu, &count);
    gpu_pipeline_destroy(gpu, &sum);
}

TEST_GPU(indices_are_read_from_an_offset)
{
    gpu_image color = target(gpu, GPU_RGBA32F, 0);
    gpu_buffer indices = test_gpu_buffer(gpu, 7 * 4);
    gpu_pipeline plain = graphics(gpu, &triangle_desc);
    const uint32_t words[7] = { 5, 5, 5, 5, 0, 1, 2 };
    CHECK(gpu_buffer_upload(gpu, indices, 0, words, sizeof words));
    struct gpu_cmd *cmd = gpu_frame_begin(gpu);
    begin(cmd, color, false);
    struct push push = { { 1 }, 0, 1 };
    gpu_draw(cmd, &(struct gpu_draw_desc){ .pipeline = plain,
                                           .push = &push,
                                           .push_bytes = sizeof push,
                                           .indices = indices,
                                           .index_offset = 16,
                                           .count = 3,
                                           .cull = GPU_CULL_BACK });
    gpu_render_end(cmd);
    CHECK(gpu_frame_end(gpu, cmd));
    check_red(gpu, color, 0, 0, PIXELS, 1);
    gpu_image_destroy(gpu, &color);
    gpu_buffer_destroy(gpu, &indices);
    gpu_pipeline_destroy(gpu, &plain);
}

#ifdef NDEBUG // debug builds assert instead
// Expects the frame to fail with this message.
static void check_misused(struct gpu *gpu, struct gpu_cmd *cmd, const char *says)
{
    if (!strstr(test_last_message(), says)) fail_msg("\"%s\"", test_last_message());
    assert_false(gpu_frame_end(gpu, cmd));
    test_forget_messages();
}

TEST_GPU(a_misused_rendering_is_logged_draws_nothing_and_fails_its_frame)
{
    gpu_image color = target(gpu, GPU_RGBA32F, GPU_SAMPLED),
              other = target(gpu, GPU_RGBA8, GPU_SAMPLED);
    struct gpu_graphics_desc desc = triangle_desc;
    gpu_pipeline plain = graphics(gpu, &desc);
    desc.fragment = &shader_test_textured_frag;
    gpu_pipeline textured = graphics(gpu, &desc);
    struct push push = { { 1, 1, 1, 1 }, 0, 1 };
    struct gpu_cmd *cmd = gpu_frame_begin(gpu);
    draw(cmd, plain, 1, 0);
    check_misused(gpu, cmd, "no rendering is open");
    cmd = gpu_frame_begin(gpu);
    begin(cmd, other, false);
    draw(cmd, plain, 1, 0);
    gpu_render_end(cmd);
    check_misused(gpu, cmd, "not of its formats");
    cmd = gpu_frame_begin(gpu);
    begin(cmd, color, false);
    gpu_draw(cmd, &(struct gpu_draw_desc){ .pipeline = textured,
                                           GPU_BIND({ "image", .image = color }),
                                           .push = &push,
                                           .push_bytes = sizeof push,
                                           .count = 3 });
    gpu_render_end(cmd);
    check_misused(gpu, cmd, "rendered to at once");
    cmd = gpu_frame_begin(gpu);
    gpu_fill_buffer(cmd, (gpu_buffer){ 0 }, 0, 4, 0);
    check_misused(gpu, cmd, "no such object");
    cmd = gpu_frame_begin(gpu);
    gpu_clear_image(cmd, color, (const float[4]){ 0 });
    CHECK(gpu_frame_end(gpu, cmd));
    cmd = gpu_frame_begin(gpu);
    gpu_render_begin(cmd, &(struct gpu_render_desc){ .color = { { .image = color } },
                                                     .color_count = 1,
                                                     .width = WIDTH + 1,
                                                     .height = HEIGHT });
    draw(cmd, plain, 1, 0);
    gpu_render_end(cmd);
    check_misused(gpu, cmd, "does not fit");
    check_red(gpu, color, 0, 0, PIXELS, 0);
    gpu_image_destroy(gpu, &color);
    gpu_image_destroy(gpu, &other);
    gpu_pipeline_destroy(gpu, &plain);
    gpu_pipeline_destroy(gpu, &textured);
}
#endif
