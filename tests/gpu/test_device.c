// Device list and selection, error messages, refused objects, device loss.
#include "framework/gpu_test.h"
#include "gpu_test_shaders.h"

#include "gpu/vk.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

TEST(devices_are_listed_with_their_missing_features)
{
    test_gpu_require();
    struct gpu_device_info infos[16];
    int count, again;
    CHECK(gpu_list_devices(test_host(), infos, 16, &count));
    for (int i = 0; i < count && i < 16; i++) {
        assert_true(infos[i].name[0] && infos[i].driver[0]);
        assert_int_equal(infos[i].usable, !infos[i].missing[0]);
    }
    CHECK(gpu_list_devices(test_host(), infos, 1, &again));
    assert_int_equal(again, count);
}

static struct gpu *open_device(const char *device)
{
    return gpu_create(test_host(), &(struct gpu_desc){ .device = device });
}

TEST(a_device_is_selected_by_number_or_part_of_its_name)
{
    struct gpu *best = test_gpu();
    char part[256];
    snprintf(part, sizeof part, "%s", gpu_info(best)->name + 1);
    for (char *c = part; *c; c++) *c = (char)toupper((unsigned char)*c);
    struct gpu *named = open_device(part);
    CHECK(named != NULL);
    CHECK_STRING(gpu_info(named)->name, gpu_info(best)->name);
    gpu_destroy(named);
    struct gpu_device_info infos[16];
    int count;
    CHECK(gpu_list_devices(test_host(), infos, 16, &count));
    for (int i = 0; i < count; i++) {
        char number[16];
        snprintf(number, sizeof number, "%d", i);
        struct gpu *numbered = open_device(number);
        assert_int_equal(numbered != NULL, infos[i].usable);
        if (numbered) CHECK_STRING(gpu_info(numbered)->name, infos[i].name);
        gpu_destroy(numbered);
    }
    test_gpu_finish(best);
}

TEST(an_unknown_device_lists_the_available_ones)
{
    test_gpu_require();
    struct gpu_device_info infos[16];
    int count;
    CHECK(gpu_list_devices(test_host(), infos, 16, &count));
    const char *wrong[] = { "no such device", "99" };
    for (int i = 0; i < 2; i++) {
        test_forget_messages();
        assert_null(open_device(wrong[i]));
        assert_non_null(strstr(test_last_message(), wrong[i]));
        for (int k = 0; k < count; k++) assert_non_null(strstr(test_last_message(), infos[k].name));
        assert_int_equal(test_host()->failure, FAIL_ARGUMENT);
    }
}

TEST(a_missing_validation_layer_is_named)
{
    test_gpu_require();
    setenv("VK_LAYER_PATH", test_path(""), 1); // an empty folder
    struct gpu *gpu = gpu_create(test_host(), &(struct gpu_desc){ .validation = true });
    unsetenv("VK_LAYER_PATH");
    assert_null(gpu);
    assert_non_null(strstr(test_last_message(), "VK_LAYER_KHRONOS_validation"));
    assert_int_equal(test_host()->failure, FAIL_UNSUPPORTED);
}

TEST(required_features_are_listed_one_per_line)
{
    const char *text = gpu_required_features();
    assert_non_null(strstr(text, "\ndynamicRendering\n"));
    assert_non_null(strstr(text, "VK_KHR_push_descriptor\n"));
    assert_null(strchr(text, ' ') == strstr(text, " 1.3") ? NULL
                                                          : text); // no space but in "Vulkan 1.3"
}

TEST(a_validation_message_is_counted)
{
    test_gpu_require();
    struct gpu *gpu = gpu_create(test_host(), &(struct gpu_desc){ .validation = true });
    CHECK(gpu != NULL);
    assert_int_equal(gpu_validation_messages(gpu), 0);
    VkBuffer buffer = VK_NULL_HANDLE; // a size of 0 is not valid
    vkCreateBuffer(gpu->device,
                   &(VkBufferCreateInfo){ .sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO,
                                          .usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT },
                   NULL, &buffer);
    assert_true(gpu_validation_messages(gpu) > 0);
    vkDestroyBuffer(gpu->device, buffer, NULL);
    gpu_destroy(gpu);
}

static uint32_t run_sum(struct gpu *gpu, uint32_t word)
{
    gpu_buffer words = test_gpu_buffer(gpu, 40), total = test_gpu_buffer(gpu, 4);
    gpu_pipeline sum = test_gpu_compute(gpu, &shader_test_sum_comp);
    struct gpu_cmd *cmd = gpu_frame_begin(gpu);
    gpu_fill_buffer(cmd, words, 0, 40, word);
    gpu_dispatch(cmd, sum, GPU_BIND({ "Words", .buffer = words }, { "Total", .buffer = total }),
                 NULL, 0, 1, 1, 1);
    CHECK(gpu_frame_end(gpu, cmd));
    uint32_t got = 0;
    CHECK(gpu_buffer_download(gpu, total, 0, &got, 4));
    gpu_buffer_destroy(gpu, &words);
    gpu_buffer_destroy(gpu, &total);
    gpu_pipeline_destroy(gpu, &sum);
    return got;
}

TEST(two_devices_are_independent)
{
    test_gpu_require();
    const struct gpu_desc desc = { .validation = true };
    struct gpu *a = gpu_create(test_host(), &desc), *b = gpu_create(test_host(), &desc);
    CHECK(a && b);
    assert_int_equal(run_sum(a, 3), 30);
    assert_int_equal(run_sum(b, 4), 40);
    test_gpu_finish(a);
    gpu_destroy(a);
    assert_int_equal(run_sum(b, 5), 50);
    test_gpu_finish(b);
    gpu_destroy(b);
}

TEST(leaked_objects_are_named_and_freed)
{
    test_gpu_require();
    struct gpu *gpu = gpu_create(test_host(), &(struct gpu_desc){ .validation = true });
    CHECK(gpu != NULL);
    gpu_buffer buffer;
    CHECK(gpu_buffer_create(
        gpu, &(struct gpu_buffer_desc){ "forgotten.buffer", 4, GPU_BUFFER_STORAGE }, &buffer));
    assert_int_equal(gpu_live_objects(gpu), 1);
    test_forget_messages();
    gpu_destroy(gpu); // the validation layer reports objects that still exist
    assert_non_null(strstr(test_last_message(), "forgotten.buffer"));
}

static void check_refused(struct gpu *gpu, struct gpu_image_desc desc, enum fail_kind kind)
{
    gpu_image image;
    test_forget_messages();
    assert_false(gpu_image_create(gpu, &desc, &image));
    assert_int_equal(image.id, 0);
    assert_non_null(strstr(test_last_message(), "test.bad"));
    assert_int_equal(test_host()->failure, kind);
}

TEST_GPU(invalid_images_and_buffers_are_refused_with_the_reason)
{
    const struct gpu_limits *l = gpu_limits(gpu);
    const uint32_t s = GPU_SAMPLED;
    check_refused(gpu, (struct gpu_image_desc){ "test.bad", GPU_2D, GPU_R8, 0, 4, 1, 1, s, NULL },
                  FAIL_ARGUMENT);
    check_refused(gpu,
                  (struct gpu_image_desc){ "test.bad", GPU_2D, GPU_R8, l->max_image_2d + 1, 4, 1, 1,
                                           s, NULL },
                  FAIL_ARGUMENT);
    check_refused(
        gpu, (struct gpu_image_desc){ "test.bad", GPU_3D, GPU_R8, 4, 4, UINT32_MAX, 1, s, NULL },
        FAIL_ARGUMENT);
    check_refused(gpu,
                  (struct gpu_image_desc){ "test.bad", GPU_2D_ARRAY, GPU_R8, 4, 4,
                                           l->max_layers + 1, 1, s, NULL },
                  FAIL_ARGUMENT);
    check_refused(gpu, (struct gpu_image_desc){ "test.bad", GPU_2D, GPU_R8, 4, 4, 2, 1, s, NULL },
                  FAIL_ARGUMENT);
    check_refused(gpu, (struct gpu_image_desc){ "test.bad", GPU_CUBE, GPU_R8, 4, 8, 6, 1, s, NULL },
                  FAIL_ARGUMENT);
    check_refused(
        gpu, (struct gpu_image_desc){ "test.bad", GPU_CUBE_ARRAY, GPU_R8, 4, 4, 7, 1, s, NULL },
        FAIL_ARGUMENT);
    check_refused(gpu, (struct gpu_image_desc){ "test.bad", GPU_2D, GPU_R8, 4, 4, 1, 4, s, NULL },
                  FAIL_ARGUMENT);
    check_refused(
        gpu, (struct gpu_image_desc){ "test.bad", GPU_2D, GPU_FORMAT_COUNT, 4, 4, 1, 1, s, NULL },
        FAIL_ARGUMENT);
    check_refused(gpu, (struct gpu_image_desc){ "test.bad", GPU_2D, GPU_R8, 4, 4, 1, 1, 64, NULL },
                  FAIL_ARGUMENT);
    check_refused(
        gpu, (struct gpu_image_desc){ "test.bad", GPU_2D, GPU_D32F, 4, 4, 1, 1, GPU_STORAGE, NULL },
        FAIL_UNSUPPORTED);
    gpu_buffer buffer;
    assert_false(gpu_buffer_create(
        gpu, &(struct gpu_buffer_desc){ "test.bad", 0, GPU_BUFFER_STORAGE }, &buffer));
    assert_false(gpu_buffer_create(
        gpu, &(struct gpu_buffer_desc){ "test.bad", SIZE_MAX, GPU_BUFFER_STORAGE }, &buffer));
    assert_int_equal(test_host()->failure, FAIL_MEMORY);
    assert_false(
        gpu_buffer_create(gpu, &(struct gpu_buffer_desc){ "test.bad", 4, 1u << 20 }, &buffer));
}

TEST_GPU(handles_of_destroyed_objects_are_invalid)
{
    gpu_image image = test_gpu_image(gpu, GPU_2D, GPU_R8, 4, 4, 1, 1, GPU_SAMPLED), stale = image,
              none = { 0 };
    gpu_image_destroy(gpu, &image);
    gpu_image_destroy(gpu, &image);
    gpu_image_destroy(gpu, &none);
    assert_null(gpu_image_info(gpu, stale));
    gpu_image other =
        test_gpu_image(gpu, GPU_2D, GPU_R8, 4, 4, 1, 1, GPU_SAMPLED); // reuses the table entry
    assert_null(gpu_image_info(gpu, stale));
    gpu_image_destroy(gpu, &stale);
    CHECK_STRING(gpu_image_info(gpu, other)->name, "test.image");
    gpu_image_destroy(gpu, &other);
}

TEST_GPU(equal_sampler_descriptions_share_one_sampler)
{
    gpu_sampler a, b, c;
    struct gpu_sampler_desc desc = { .name = "test.a", .filter = GPU_LINEAR, .wrap_u = GPU_MIRROR };
    CHECK(gpu_sampler_get(gpu, &desc, &a));
    desc.name = "test.b";
    CHECK(gpu_sampler_get(gpu, &desc, &b));
    desc.mip_filter = GPU_LINEAR;
    CHECK(gpu_sampler_get(gpu, &desc, &c));
    assert_int_equal(a.id, b.id);
    assert_int_not_equal(a.id, c.id);
    desc.wrap_u = GPU_CLAMP + 1;
    assert_false(gpu_sampler_get(gpu, &desc, &c));
}

TEST(after_device_loss_every_call_fails_without_a_crash)
{
    test_gpu_require();
    struct gpu *gpu = gpu_create(test_host(), &(struct gpu_desc){ .validation = true });
    CHECK(gpu != NULL);
    gpu_buffer buffer = test_gpu_buffer(gpu, 64), other;
    gpu_image image;
    gpu_pipeline sum = test_gpu_compute(gpu, &shader_test_sum_comp), pipeline;
    struct gpu_cmd *cmd = gpu_frame_begin(gpu);
    assert_false(vk_check(gpu, VK_ERROR_DEVICE_LOST, "a call in the middle of a frame"));
    gpu_fill_buffer(cmd, buffer, 0, 64, 1);
    gpu_dispatch(cmd, sum, GPU_BIND({ "Words", .buffer = buffer }, { "Total", .buffer = buffer }),
                 NULL, 0, 1, 1, 1);
    assert_false(gpu_frame_end(gpu, cmd));
    assert_null(gpu_frame_begin(gpu));
    assert_int_equal(test_host()->failure, FAIL_DEVICE);
    assert_false(gpu_wait(gpu));
    assert_false(gpu_buffer_upload(gpu, buffer, 0, "1234", 4));
    assert_false(gpu_buffer_create(gpu, &(struct gpu_buffer_desc){ "test.lost", 4, 0 }, &other));
    assert_false(gpu_image_create(
        gpu,
        &(struct gpu_image_desc){ .name = "test.lost", .format = GPU_R8, .width = 1, .height = 1 },
        &image));
    assert_false(
        gpu_compute_pipeline_create(gpu, "test.lost", &shader_test_sum_comp, NULL, 0, &pipeline));
    gpu_buffer_destroy(gpu, &buffer);
    gpu_pipeline_destroy(gpu, &sum);
    assert_int_equal(gpu_live_objects(gpu), 0);
    vkDeviceWaitIdle(gpu->device); // the loss was simulated
    gpu_destroy(gpu);
}
