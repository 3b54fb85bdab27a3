#include "framework/gpu_test.h"
#include "gpu_test_shaders.h"

struct push {
    float color[4], depth, size;
};

static gpu_image target(struct gpu *gpu, enum gpu_format format, uint32_t usage)
{
    gpu_image image;
    CHECK(gpu_image_create(gpu,
                           &(struct gpu_image_desc){ .name = "test.target",
                                                     .format = format,
                                                     .width = 16,
                                                     .height = 8,
                                                     .usage = GPU_ATTACHMENT | usage },
                           &image));
    return image;
}

TEST_GPU(the_nearer_triangle_wins_with_reversed_depth)
{
    gpu_image color = target(gpu, GPU_RGBA8, GPU_SAMPLED),
              depth = target(gpu, GPU_D32F, GPU_SAMPLED);
    gpu_pipeline pipeline;
    CHECK(gpu_graphics_pipeline_create(
        gpu,
        &(struct gpu_graphics_desc){ .name = "test.triangle",
                                     .vertex = &shader_test_triangle_vert,
                                     .fragment = &shader_test_triangle_frag,
                                     .color_formats = { GPU_RGBA8 },
                                     .depth_format = GPU_D32F,
                                     .depth_compare = GPU_GREATER,
                                     .depth_write = true },
        &pipeline));
    struct gpu_cmd *cmd = gpu_frame_begin(gpu);
    gpu_render_begin(cmd, &(struct gpu_render_desc){ .color = { { .image = color } },
                                                     .color_count = 1,
                                                     .depth = { .image = depth },
                                                     .width = 16,
                                                     .height = 8 });
    const struct push draws[] = { { { 1, 0, 0, 1 }, 0.5f, 1 },
                                  { { 0, 1, 0, 1 }, 0.75f, 1 },
                                  { { 0, 0, 1, 1 }, 0.25f, 1 } };
    for (int i = 0; i < 3; i++) {
        gpu_draw(cmd, &(struct gpu_draw_desc){ .pipeline = pipeline,
                                               .push = &draws[i],
                                               .push_bytes = sizeof draws[i],
                                               .count = 3,
                                               .cull = GPU_CULL_BACK });
    }
    gpu_render_end(cmd);
    CHECK(gpu_frame_end(gpu, cmd));
    float colors[16 * 8][4], depths[16 * 8];
    CHECK(gpu_image_download_float(gpu, color, 0, 0, colors[0], 4, 16 * 8 * 4));
    CHECK(gpu_image_download_float(gpu, depth, 0, 0, depths, 1, 16 * 8));
    for (int i = 0; i < 16 * 8; i++) {
        assert_true(colors[i][0] == 0 && colors[i][1] == 1 && colors[i][2] == 0);
        assert_true(depths[i] == 0.75f);
    }
    gpu_image_destroy(gpu, &color);
    gpu_image_destroy(gpu, &depth);
    gpu_pipeline_destroy(gpu, &pipeline);
}
