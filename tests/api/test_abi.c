// The binary interface: structs that a program allocates keep their size and the place of their
// members. A new member takes the first reserved words and gets a row; no other row changes.
#include "framework/test.h"

#include <afterglow/afterglow.h>

#include <string.h>

#define SIZE(type, bytes)                                                                          \
    {                                                                                              \
#type, sizeof(struct type), bytes                                                          \
    }
#define AT(type, member, offset)                                                                   \
    {                                                                                              \
#type "." #member, offsetof(struct type, member), offset                                   \
    }

// 64-bit platforms.
static const struct {
    const char *what;
    size_t got, stated;
} rows[] = {
    SIZE(ag_context_desc, 88),
    AT(ag_context_desc, log, 0),
    AT(ag_context_desc, reallocate, 8),
    AT(ag_context_desc, user, 16),
    AT(ag_context_desc, log_up_to, 24),
    AT(ag_context_desc, no_links_in, 32),
    AT(ag_context_desc, use_environment, 40),
    AT(ag_context_desc, importer, 48),
    AT(ag_context_desc, reserved, 56),
    SIZE(ag_device_adopt, 104),
    AT(ag_device_adopt, instance, 0),
    AT(ag_device_adopt, physical_device, 8),
    AT(ag_device_adopt, device, 16),
    AT(ag_device_adopt, queue, 24),
    AT(ag_device_adopt, queue_family, 32),
    AT(ag_device_adopt, lock_queue, 40),
    AT(ag_device_adopt, unlock_queue, 48),
    AT(ag_device_adopt, user, 56),
    AT(ag_device_adopt, vk_enabled_features, 64),
    AT(ag_device_adopt, reserved, 72),
    SIZE(ag_device_desc, 72),
    AT(ag_device_desc, device, 0),
    AT(ag_device_desc, validation, 8),
    AT(ag_device_desc, adopt, 16),
    AT(ag_device_desc, pipeline_cache, 24),
    AT(ag_device_desc, pipeline_cache_bytes, 32),
    AT(ag_device_desc, reserved, 40),
    SIZE(ag_device_counters, 112),
    AT(ag_device_counters, images, 0),
    AT(ag_device_counters, buffers, 8),
    AT(ag_device_counters, pipelines, 16),
    AT(ag_device_counters, compiled, 24),
    AT(ag_device_counters, frames, 32),
    AT(ag_device_counters, transfers, 40),
    AT(ag_device_counters, reserved, 48),
    SIZE(ag_renderer_desc, 120),
    AT(ag_renderer_desc, width, 0),
    AT(ag_renderer_desc, height, 4),
    AT(ag_renderer_desc, gi, 8),
    AT(ag_renderer_desc, frame_options, 16),
    AT(ag_renderer_desc, indirect_layer, 24),
    AT(ag_renderer_desc, display_layer, 25),
    AT(ag_renderer_desc, motion_layer, 26),
    AT(ag_renderer_desc, bakes, 32),
    AT(ag_renderer_desc, bake_count, 40),
    AT(ag_renderer_desc, bake_folder, 48),
    AT(ag_renderer_desc, reserved, 56),
    SIZE(ag_frame_desc, 136),
    AT(ag_frame_desc, camera, 0),
    AT(ag_frame_desc, time_s, 48),
    AT(ag_frame_desc, animation, 56),
    AT(ag_frame_desc, auto_exposure, 60),
    AT(ag_frame_desc, exposure_ev, 64),
    AT(ag_frame_desc, camera_cut, 68),
    AT(ag_frame_desc, reserved, 72),
    SIZE(ag_finished_frame, 64),
    AT(ag_finished_frame, frame, 0),
    AT(ag_finished_frame, exposure_ev, 8),
    AT(ag_finished_frame, scale, 12),
    AT(ag_finished_frame, reserved, 16),
    SIZE(ag_layer_handle, 72),
    AT(ag_layer_handle, vk_image, 0),
    AT(ag_layer_handle, vk_image_view, 8),
    AT(ag_layer_handle, vk_format, 16),
    AT(ag_layer_handle, vk_usage, 20),
    AT(ag_layer_handle, vk_layout, 24),
    AT(ag_layer_handle, width, 28),
    AT(ag_layer_handle, height, 32),
    AT(ag_layer_handle, scale, 36),
    AT(ag_layer_handle, reserved, 40),
    SIZE(ag_camera, 44),
    AT(ag_camera, eye, 0),
    AT(ag_camera, target, 12),
    AT(ag_camera, up, 24),
    AT(ag_camera, vertical_fov_rad, 36),
    AT(ag_camera, near_m, 40),
    SIZE(ag_memory, 40),
    AT(ag_memory, owner, 0),
    AT(ag_memory, bytes, 32),
    SIZE(ag_timing, 56),
    AT(ag_timing, name, 0),
    AT(ag_timing, ms, 48),
};

TEST(structs_keep_their_size_and_the_place_of_their_members)
{
    if (sizeof(void *) != 8) return;
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
        if (rows[i].got != rows[i].stated)
            fail_msg("%s: %zu, not %zu", rows[i].what, rows[i].got, rows[i].stated);
}

TEST(reserved_members_are_zero_by_default_and_refused_otherwise)
{
    struct ag_context *context = NULL;
    struct ag_context_desc desc;
    memset(&desc, 0xff, sizeof desc);
    ag_context_desc_default(&desc);
    desc.reserved[1] = 1;
    assert_int_equal(ag_context_create(&desc, &context), AG_ERROR_ARGUMENT);
    desc.reserved[1] = 0;
    assert_int_equal(ag_context_create(&desc, &context), AG_OK);

    struct ag_device *device = NULL;
    struct ag_device_desc device_desc;
    memset(&device_desc, 0xff, sizeof device_desc);
    ag_device_desc_default(&device_desc);
    device_desc.reserved[0] = 1;
    assert_int_equal(ag_device_create(context, &device_desc, &device), AG_ERROR_ARGUMENT);
    CHECK(strstr(ag_context_last_error(context), "newer library"));

    uint64_t bytes = 0;
    struct ag_renderer_desc renderer;
    memset(&renderer, 0xff, sizeof renderer);
    ag_renderer_desc_default(&renderer);
    assert_int_equal(ag_renderer_estimate_memory(context, &renderer, 0, &bytes), AG_OK);
    renderer.reserved[7] = 1;
    assert_int_equal(ag_renderer_estimate_memory(context, &renderer, 0, &bytes), AG_ERROR_ARGUMENT);
    ag_context_destroy(context);
}
