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
    AT(ag_context_desc, follow_links, 56),
    AT(ag_context_desc, reserved, 64),
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
    AT(ag_device_adopt, memory, 72),
    AT(ag_device_adopt, vk_allocation_callbacks, 80),
    AT(ag_device_adopt, reserved, 88),
    SIZE(ag_memory_request, 56),
    AT(ag_memory_request, bytes, 0),
    AT(ag_memory_request, alignment, 8),
    AT(ag_memory_request, vk_memory_type, 16),
    AT(ag_memory_request, mapped, 20),
    AT(ag_memory_request, reserved, 24),
    SIZE(ag_memory_block, 64),
    AT(ag_memory_block, vk_memory, 0),
    AT(ag_memory_block, offset, 8),
    AT(ag_memory_block, mapped, 16),
    AT(ag_memory_block, handle, 24),
    AT(ag_memory_block, reserved, 32),
    SIZE(ag_memory_callbacks, 56),
    AT(ag_memory_callbacks, allocate, 0),
    AT(ag_memory_callbacks, free, 8),
    AT(ag_memory_callbacks, user, 16),
    AT(ag_memory_callbacks, reserved, 24),
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
    AT(ag_device_counters, passes, 48),
    AT(ag_device_counters, reserved, 56),
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
    AT(ag_renderer_desc, id_layer, 56),
    AT(ag_renderer_desc, host_gbuffer, 57),
    AT(ag_renderer_desc, wait_for_updates, 58),
    AT(ag_renderer_desc, gbuffer_layout, 64),
    AT(ag_renderer_desc, reserved, 72),
    SIZE(ag_frame_desc, 136),
    AT(ag_frame_desc, camera, 0),
    AT(ag_frame_desc, time_s, 48),
    AT(ag_frame_desc, animation, 56),
    AT(ag_frame_desc, auto_exposure, 60),
    AT(ag_frame_desc, exposure_ev, 64),
    AT(ag_frame_desc, camera_cut, 68),
    AT(ag_frame_desc, pick, 72),
    AT(ag_frame_desc, gbuffer, 80),
    AT(ag_frame_desc, views, 88),
    AT(ag_frame_desc, view_count, 96),
    AT(ag_frame_desc, matrices, 104),
    AT(ag_frame_desc, reserved, 112),
    SIZE(ag_view_desc, 80),
    AT(ag_view_desc, width, 0),
    AT(ag_view_desc, height, 4),
    AT(ag_view_desc, indirect_layer, 8),
    AT(ag_view_desc, display_layer, 9),
    AT(ag_view_desc, motion_layer, 10),
    AT(ag_view_desc, host_gbuffer, 11),
    AT(ag_view_desc, gbuffer_layout, 16),
    AT(ag_view_desc, reserved, 24),
    SIZE(ag_view_frame, 104),
    AT(ag_view_frame, view, 0),
    AT(ag_view_frame, camera, 8),
    AT(ag_view_frame, auto_exposure, 52),
    AT(ag_view_frame, exposure_ev, 56),
    AT(ag_view_frame, camera_cut, 60),
    AT(ag_view_frame, gbuffer, 64),
    AT(ag_view_frame, matrices, 72),
    AT(ag_view_frame, reserved, 80),
    SIZE(ag_pick, 56),
    AT(ag_pick, frame, 0),
    AT(ag_pick, x, 8),
    AT(ag_pick, y, 12),
    AT(ag_pick, instance, 16),
    AT(ag_pick, triangle, 20),
    AT(ag_pick, reserved, 24),
    SIZE(ag_gbuffer, 640),
    AT(ag_gbuffer, depth, 0),
    AT(ag_gbuffer, normal, 72),
    AT(ag_gbuffer, albedo, 144),
    AT(ag_gbuffer, material, 216),
    AT(ag_gbuffer, dielectric, 288),
    AT(ag_gbuffer, emissive, 360),
    AT(ag_gbuffer, motion, 432),
    AT(ag_gbuffer, id, 504),
    AT(ag_gbuffer, motion_offset, 576),
    AT(ag_gbuffer, reserved, 584),
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
    SIZE(ag_device_info, 840),
    AT(ag_device_info, name, 0),
    AT(ag_device_info, driver, 256),
    AT(ag_device_info, software, 512),
    AT(ag_device_info, usable, 513),
    AT(ag_device_info, missing, 514),
    AT(ag_device_info, reserved, 776),
    SIZE(ag_option_info, 96),
    AT(ag_option_info, name, 0),
    AT(ag_option_info, type, 8),
    AT(ag_option_info, initial, 16),
    AT(ag_option_info, min, 24),
    AT(ag_option_info, max, 32),
    AT(ag_option_info, unit, 40),
    AT(ag_option_info, effect, 48),
    AT(ag_option_info, help, 56),
    AT(ag_option_info, expert, 64),
    AT(ag_option_info, reserved, 72),
    SIZE(ag_technique_info, 120),
    AT(ag_technique_info, name, 0),
    AT(ag_technique_info, title, 8),
    AT(ag_technique_info, paper, 16),
    AT(ag_technique_info, role, 24),
    AT(ag_technique_info, moving_geometry, 32),
    AT(ag_technique_info, moving_lights, 33),
    AT(ag_technique_info, needs_bake, 34),
    AT(ag_technique_info, makes_specular, 35),
    AT(ag_technique_info, publishes_probes, 36),
    AT(ag_technique_info, has_lightmap, 37),
    AT(ag_technique_info, exports_bake, 38),
    AT(ag_technique_info, option_count, 40),
    AT(ag_technique_info, preset_count, 44),
    AT(ag_technique_info, debug_view_count, 48),
    AT(ag_technique_info, reserved, 56),
    SIZE(ag_builtin_scene_info, 56),
    AT(ag_builtin_scene_info, name, 0),
    AT(ag_builtin_scene_info, title, 8),
    AT(ag_builtin_scene_info, option_count, 16),
    AT(ag_builtin_scene_info, reserved, 24),
    SIZE(ag_compare_desc, 56),
    AT(ag_compare_desc, radiance, 0),
    AT(ag_compare_desc, ev, 4),
    AT(ag_compare_desc, mask, 8),
    AT(ag_compare_desc, ignore_not_finite, 16),
    AT(ag_compare_desc, pixels_per_degree, 20),
    AT(ag_compare_desc, reserved, 24),
    SIZE(ag_metrics, 184),
    AT(ag_metrics, mse, 0),
    AT(ag_metrics, mae, 8),
    AT(ag_metrics, relmse, 16),
    AT(ag_metrics, psnr, 24),
    AT(ag_metrics, ssim, 32),
    AT(ag_metrics, flip, 40),
    AT(ag_metrics, flip_hdr, 48),
    AT(ag_metrics, mean_a, 56),
    AT(ag_metrics, mean_b, 80),
    AT(ag_metrics, counted, 104),
    AT(ag_metrics, ignored, 112),
    AT(ag_metrics, reserved, 120),
    SIZE(ag_material_desc, 128),
    AT(ag_material_desc, base_color, 0),
    AT(ag_material_desc, metallic, 16),
    AT(ag_material_desc, roughness, 20),
    AT(ag_material_desc, emissive, 24),
    AT(ag_material_desc, double_sided, 36),
    AT(ag_material_desc, ior, 40),
    AT(ag_material_desc, specular, 44),
    AT(ag_material_desc, specular_color, 48),
    AT(ag_material_desc, unlit, 60),
    AT(ag_material_desc, alpha_mode, 64),
    AT(ag_material_desc, alpha_cutoff, 68),
    AT(ag_material_desc, maps, 72),
    AT(ag_material_desc, reserved, 80),
    SIZE(ag_mesh_desc, 136),
    AT(ag_mesh_desc, positions, 0),
    AT(ag_mesh_desc, normals, 8),
    AT(ag_mesh_desc, vertex_count, 16),
    AT(ag_mesh_desc, indices, 24),
    AT(ag_mesh_desc, index_count, 32),
    AT(ag_mesh_desc, material, 36),
    AT(ag_mesh_desc, uv, 40),
    AT(ag_mesh_desc, tangents, 56),
    AT(ag_mesh_desc, colors, 64),
    AT(ag_mesh_desc, reserved, 72),
    SIZE(ag_scene_memory_desc, 112),
    AT(ag_scene_memory_desc, bytes, 0),
    AT(ag_scene_memory_desc, size, 8),
    AT(ag_scene_memory_desc, name, 16),
    AT(ag_scene_memory_desc, folder, 24),
    AT(ag_scene_memory_desc, read, 32),
    AT(ag_scene_memory_desc, user, 40),
    AT(ag_scene_memory_desc, reserved, 48),
    SIZE(ag_scene_image_desc, 128),
    AT(ag_scene_image_desc, name, 0),
    AT(ag_scene_image_desc, pixels, 8),
    AT(ag_scene_image_desc, width, 16),
    AT(ag_scene_image_desc, height, 20),
    AT(ag_scene_image_desc, channels, 24),
    AT(ag_scene_image_desc, row_bytes, 32),
    AT(ag_scene_image_desc, encoded, 40),
    AT(ag_scene_image_desc, encoded_bytes, 48),
    AT(ag_scene_image_desc, linear, 56),
    AT(ag_scene_image_desc, reserved, 64),
    SIZE(ag_texture_map, 56),
    AT(ag_texture_map, image, 0),
    AT(ag_texture_map, uv_set, 4),
    AT(ag_texture_map, wrap_u, 8),
    AT(ag_texture_map, wrap_v, 12),
    AT(ag_texture_map, nearest, 16),
    AT(ag_texture_map, uv_offset, 20),
    AT(ag_texture_map, uv_scale, 28),
    AT(ag_texture_map, uv_rotation_rad, 36),
    AT(ag_texture_map, reserved, 40),
    SIZE(ag_material_maps, 408),
    AT(ag_material_maps, base_color, 0),
    AT(ag_material_maps, metallic_roughness, 56),
    AT(ag_material_maps, normal, 112),
    AT(ag_material_maps, emissive, 168),
    AT(ag_material_maps, specular, 224),
    AT(ag_material_maps, specular_color, 280),
    AT(ag_material_maps, normal_scale, 336),
    AT(ag_material_maps, reserved, 344),
    SIZE(ag_light_desc, 104),
    AT(ag_light_desc, type, 0),
    AT(ag_light_desc, position, 4),
    AT(ag_light_desc, direction, 16),
    AT(ag_light_desc, intensity, 28),
    AT(ag_light_desc, inner_rad, 40),
    AT(ag_light_desc, outer_rad, 44),
    AT(ag_light_desc, enabled, 48),
    AT(ag_light_desc, reserved, 56),
    SIZE(ag_area_light_desc, 80),
    AT(ag_area_light_desc, position, 0),
    AT(ag_area_light_desc, direction, 12),
    AT(ag_area_light_desc, width, 24),
    AT(ag_area_light_desc, height, 28),
    AT(ag_area_light_desc, radiance, 32),
    AT(ag_area_light_desc, reserved, 48),
    SIZE(ag_default_lighting, 72),
    AT(ag_default_lighting, needed, 0),
    AT(ag_default_lighting, sun_direction, 4),
    AT(ag_default_lighting, sun_lux, 16),
    AT(ag_default_lighting, sky, 28),
    AT(ag_default_lighting, reserved, 40),
    SIZE(ag_scene_info, 168),
    AT(ag_scene_info, instances, 0),
    AT(ag_scene_info, meshes, 4),
    AT(ag_scene_info, materials, 8),
    AT(ag_scene_info, images, 12),
    AT(ag_scene_info, lights, 16),
    AT(ag_scene_info, cameras, 20),
    AT(ag_scene_info, animations, 24),
    AT(ag_scene_info, skins, 28),
    AT(ag_scene_info, nodes, 32),
    AT(ag_scene_info, triangles, 40),
    AT(ag_scene_info, vertices, 48),
    AT(ag_scene_info, memory_bytes, 56),
    AT(ag_scene_info, bounds_min, 64),
    AT(ag_scene_info, bounds_max, 76),
    AT(ag_scene_info, sky, 88),
    AT(ag_scene_info, emissive, 100),
    AT(ag_scene_info, reserved, 104),
    SIZE(ag_instance_info, 120),
    AT(ag_instance_info, name, 0),
    AT(ag_instance_info, mesh, 8),
    AT(ag_instance_info, mobility, 12),
    AT(ag_instance_info, skinned, 16),
    AT(ag_instance_info, world_from_mesh, 20),
    AT(ag_instance_info, reserved, 88),
    SIZE(ag_mesh_info, 80),
    AT(ag_mesh_info, name, 0),
    AT(ag_mesh_info, vertex_count, 8),
    AT(ag_mesh_info, index_count, 12),
    AT(ag_mesh_info, material, 16),
    AT(ag_mesh_info, bounds_min, 20),
    AT(ag_mesh_info, bounds_max, 32),
    AT(ag_mesh_info, reserved, 48),
    SIZE(ag_light_info, 128),
    AT(ag_light_info, name, 0),
    AT(ag_light_info, light, 8),
    AT(ag_light_info, reserved, 112),
    SIZE(ag_animation_info, 48),
    AT(ag_animation_info, name, 0),
    AT(ag_animation_info, duration_s, 8),
    AT(ag_animation_info, reserved, 16),
    SIZE(ag_material_info, 184),
    AT(ag_material_info, name, 0),
    AT(ag_material_info, material, 8),
    AT(ag_material_info, base_color_map, 136),
    AT(ag_material_info, metallic_roughness_map, 137),
    AT(ag_material_info, normal_map, 138),
    AT(ag_material_info, emissive_map, 139),
    AT(ag_material_info, specular_map, 140),
    AT(ag_material_info, specular_color_map, 141),
    AT(ag_material_info, alpha_mode, 144),
    AT(ag_material_info, reserved, 152),
    SIZE(ag_reference_desc, 160),
    AT(ag_reference_desc, width, 0),
    AT(ag_reference_desc, height, 4),
    AT(ag_reference_desc, camera, 8),
    AT(ag_reference_desc, time_s, 56),
    AT(ag_reference_desc, animation, 64),
    AT(ag_reference_desc, bounces, 68),
    AT(ag_reference_desc, direct_only, 72),
    AT(ag_reference_desc, indirect_only, 73),
    AT(ag_reference_desc, guiding, 74),
    AT(ag_reference_desc, antialias, 75),
    AT(ag_reference_desc, obscurance_radius_m, 76),
    AT(ag_reference_desc, occlusion_decay_per_m, 80),
    AT(ag_reference_desc, obscurance_sphere, 84),
    AT(ag_reference_desc, seed, 88),
    AT(ag_reference_desc, reserved, 96),
    SIZE(ag_reference_info, 64),
    AT(ag_reference_info, samples, 0),
    AT(ag_reference_info, rays, 8),
    AT(ag_reference_info, mean, 16),
    AT(ag_reference_info, error, 24),
    AT(ag_reference_info, reserved, 32),
    SIZE(ag_bake_desc, 136),
    AT(ag_bake_desc, technique, 0),
    AT(ag_bake_desc, time_s, 8),
    AT(ag_bake_desc, animation, 16),
    AT(ag_bake_desc, seed, 24),
    AT(ag_bake_desc, threads, 32),
    AT(ag_bake_desc, shard, 36),
    AT(ag_bake_desc, shard_count, 40),
    AT(ag_bake_desc, checkpoint_every_s, 48),
    AT(ag_bake_desc, max_memory_bytes, 56),
    AT(ag_bake_desc, full_report, 64),
    AT(ag_bake_desc, lightmap_samples, 68),
    AT(ag_bake_desc, reserved, 72),
    SIZE(ag_bake_estimate, 72),
    AT(ag_bake_estimate, texels, 0),
    AT(ag_bake_estimate, rays, 8),
    AT(ag_bake_estimate, seconds, 16),
    AT(ag_bake_estimate, file_bytes, 24),
    AT(ag_bake_estimate, peak_memory_bytes, 32),
    AT(ag_bake_estimate, charts, 40),
    AT(ag_bake_estimate, texels_per_m, 44),
    AT(ag_bake_estimate, reserved, 48),
    SIZE(ag_bake_progress, 64),
    AT(ag_bake_progress, stage, 0),
    AT(ag_bake_progress, done, 8),
    AT(ag_bake_progress, seconds_left, 16),
    AT(ag_bake_progress, stopping, 24),
    AT(ag_bake_progress, reserved, 32),
    SIZE(ag_bake_origin, 8232),
    AT(ag_bake_origin, gi, 0),
    AT(ag_bake_origin, scene_name, 4096),
    AT(ag_bake_origin, seed, 8192),
    AT(ag_bake_origin, lightmap_samples, 8200),
    AT(ag_bake_origin, reserved, 8208),
    SIZE(ag_bake_info, 104),
    AT(ag_bake_info, technique, 0),
    AT(ag_bake_info, options, 8),
    AT(ag_bake_info, key, 16),
    AT(ag_bake_info, complete, 49),
    AT(ag_bake_info, seconds, 56),
    AT(ag_bake_info, bytes, 64),
    AT(ag_bake_info, split_stage, 72),
    AT(ag_bake_info, reserved, 80),
    SIZE(ag_lightmap_desc, 72),
    AT(ag_lightmap_desc, indirect_only, 0),
    AT(ag_lightmap_desc, denoise, 1),
    AT(ag_lightmap_desc, no_light, 2),
    AT(ag_lightmap_desc, reserved, 8),
    SIZE(ag_lightmap_info, 56),
    AT(ag_lightmap_info, width, 0),
    AT(ag_lightmap_info, height, 4),
    AT(ag_lightmap_info, has_back, 8),
    AT(ag_lightmap_info, charts, 12),
    AT(ag_lightmap_info, texels, 16),
    AT(ag_lightmap_info, texels_per_m, 20),
    AT(ag_lightmap_info, reserved, 24),
    SIZE(ag_sun_sky_desc, 56),
    AT(ag_sun_sky_desc, elevation, 0),
    AT(ag_sun_sky_desc, azimuth, 4),
    AT(ag_sun_sky_desc, turbidity, 8),
    AT(ag_sun_sky_desc, ground_albedo, 12),
    AT(ag_sun_sky_desc, reserved, 24),
    SIZE(ag_environment_info, 104),
    AT(ag_environment_info, width, 0),
    AT(ag_environment_info, height, 4),
    AT(ag_environment_info, mean, 8),
    AT(ag_environment_info, has_sun, 20),
    AT(ag_environment_info, to_sun, 24),
    AT(ag_environment_info, sun_lux, 36),
    AT(ag_environment_info, sun_radius, 48),
    AT(ag_environment_info, sh_error, 52),
    AT(ag_environment_info, reserved, 72),
    SIZE(ag_environment_use, 40),
    AT(ag_environment_use, strength, 0),
    AT(ag_environment_use, rotation, 4),
    AT(ag_environment_use, reserved, 8),
    SIZE(ag_light_paint, 96),
    AT(ag_light_paint, x, 0),
    AT(ag_light_paint, y, 4),
    AT(ag_light_paint, width, 8),
    AT(ag_light_paint, height, 12),
    AT(ag_light_paint, back, 16),
    AT(ag_light_paint, lux, 24),
    AT(ag_light_paint, reserved, 32),
    SIZE(ag_probes_handle, 80),
    AT(ag_probes_handle, vk_image, 0),
    AT(ag_probes_handle, vk_layout, 8),
    AT(ag_probes_handle, scale, 12),
    AT(ag_probes_handle, first, 16),
    AT(ag_probes_handle, spacing, 28),
    AT(ag_probes_handle, counts, 32),
    AT(ag_probes_handle, slab, 44),
    AT(ag_probes_handle, reserved, 48),
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
    renderer.reserved[5] = 1;
    assert_int_equal(ag_renderer_estimate_memory(context, &renderer, 0, &bytes), AG_ERROR_ARGUMENT);

    struct ag_view_desc view;
    memset(&view, 0xff, sizeof view);
    ag_view_desc_default(&view);
    assert_int_equal(ag_view_estimate_memory(context, NULL, &view, &bytes), AG_OK);
    view.reserved[6] = 1;
    assert_int_equal(ag_view_estimate_memory(context, NULL, &view, &bytes), AG_ERROR_ARGUMENT);

    struct ag_compare_desc compare;
    struct ag_metrics metrics;
    struct ag_image *image;
    assert_int_equal(ag_image_create(context, 1, 1, 3, &image), AG_OK);
    memset(&compare, 0xff, sizeof compare);
    ag_compare_desc_default(&compare);
    assert_int_equal(ag_image_metrics(context, image, image, &compare, &metrics), AG_OK);
    compare.reserved[0] = 1;
    assert_int_equal(ag_image_metrics(context, image, image, &compare, &metrics),
                     AG_ERROR_ARGUMENT);
    CHECK(strstr(ag_context_last_error(context), "newer library"));
    ag_image_destroy(context, image);
    ag_context_destroy(context);
}

// Adds the object of a description with its reserved words as they are, then with the last one set.
#define CHECK_KNOWN(desc, call)                                                                    \
    do {                                                                                           \
        if ((call) != AG_OK) fail_msg("%s: %s", #call, ag_context_last_error(context));            \
        (desc).reserved[sizeof(desc).reserved / sizeof *(desc).reserved - 1] = 1;                  \
        assert_int_equal((call), AG_ERROR_ARGUMENT);                                               \
        CHECK(strstr(ag_context_last_error(context), "newer library"));                            \
    } while (0)

TEST(reserved_members_of_scenes_bakes_and_references_are_refused)
{
    struct ag_context *context;
    struct ag_scene *scene;
    assert_int_equal(ag_context_create(NULL, &context), AG_OK);
    assert_int_equal(ag_scene_create(context, &scene), AG_OK);
    struct ag_material_desc material;
    memset(&material, 0xff, sizeof material);
    ag_material_desc_default(&material);
    CHECK_KNOWN(material, ag_scene_add_material(scene, &material, NULL));
    static const float positions[9] = { 0, 0, 0, 1, 0, 0, 0, 1, 0 };
    static const uint32_t indices[3] = { 0, 1, 2 };
    struct ag_mesh_desc mesh = {
        .positions = positions, .vertex_count = 3, .indices = indices, .index_count = 3
    };
    CHECK_KNOWN(mesh, ag_scene_add_mesh(scene, &mesh, NULL));
    static const uint8_t texel[4] = { 255, 255, 255, 255 };
    struct ag_scene_image_desc texture = {
        .pixels = texel, .width = 1, .height = 1, .channels = 4
    };
    CHECK_KNOWN(texture, ag_scene_add_image(scene, &texture, NULL));
    struct ag_material_maps maps;
    memset(&maps, 0xff, sizeof maps);
    ag_material_maps_default(&maps);
    ag_material_desc_default(&material);
    material.maps = &maps;
    CHECK_KNOWN(maps, ag_scene_add_material(scene, &material, NULL));
    ag_material_maps_default(&maps);
    CHECK_KNOWN(maps.specular, ag_scene_add_material(scene, &material, NULL));
    struct ag_light_desc light;
    memset(&light, 0xff, sizeof light);
    ag_light_desc_default(&light, AG_LIGHT_SPOT);
    CHECK_KNOWN(light, ag_scene_add_light(scene, &light, NULL));
    struct ag_area_light_desc area;
    memset(&area, 0xff, sizeof area);
    ag_area_light_desc_default(&area);
    CHECK_KNOWN(area, ag_scene_add_area_light(scene, &area, NULL));
    struct ag_light_info info;
    memset(&info, 0xff, sizeof info);
    assert_int_equal(ag_scene_get_light(scene, 0, 0, 0.0, &info), AG_OK);
    CHECK_KNOWN(info.light, ag_scene_set_light(scene, 0, &info.light));
    struct ag_material_info look;
    memset(&look, 0xff, sizeof look);
    assert_int_equal(ag_scene_get_material(scene, 0, &look), AG_OK);
    CHECK_KNOWN(look.material, ag_scene_set_material(scene, 0, &look.material));

    struct ag_environment *environment = NULL;
    struct ag_sun_sky_desc sky;
    memset(&sky, 0xff, sizeof sky);
    ag_sun_sky_desc_default(&sky);
    assert_int_equal(ag_environment_from_sun_sky(context, &sky, &environment), AG_OK);
    struct ag_environment_use use;
    memset(&use, 0xff, sizeof use);
    ag_environment_use_default(&use);
    CHECK_KNOWN(use, ag_scene_set_environment(scene, environment, &use));
    ag_environment_destroy(environment);

    struct ag_reference *reference = NULL;
    struct ag_reference_desc desc;
    memset(&desc, 0xff, sizeof desc);
    ag_reference_desc_default(&desc);
    assert_int_equal(ag_scene_default_camera(scene, 0, 0.0, &desc.camera, NULL), AG_OK);
    desc.width = desc.height = 4;
    assert_int_equal(ag_reference_create(scene, &desc, &reference), AG_OK);
    ag_reference_destroy(reference);
    desc.reserved[0] = 1;
    assert_int_equal(ag_reference_create(scene, &desc, &reference), AG_ERROR_ARGUMENT);
    CHECK(strstr(ag_context_last_error(context), "newer library"));

    struct ag_bake *bake = NULL;
    struct ag_bake_desc bake_desc;
    memset(&bake_desc, 0xff, sizeof bake_desc);
    ag_bake_desc_default(&bake_desc);
    bake_desc.reserved[0] = 1;
    assert_int_equal(ag_bake_create(scene, "mrt", &bake_desc, &bake), AG_ERROR_ARGUMENT);
    CHECK(strstr(ag_context_last_error(context), "newer library"));
    ag_scene_destroy(scene);
    ag_context_destroy(context);
}
