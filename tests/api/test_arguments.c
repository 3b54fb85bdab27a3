// Wrong arguments yield a result and a message; no object is left half built.
#include "framework/test.h"

#include <afterglow/afterglow.h>

#include <math.h>
#include <string.h>

static struct ag_context *open_context(void)
{
    struct ag_context *context = NULL;
    assert_int_equal(ag_context_create(NULL, &context), AG_OK);
    return context;
}

// A refused call logs one sentence.
#define CHECK_REFUSED(context, call)                                                               \
    do {                                                                                           \
        assert_int_equal((call), AG_ERROR_ARGUMENT);                                               \
        if (context) CHECK(ag_context_last_error(context)[0]);                                     \
    } while (0)

TEST(destroying_nothing_does_nothing)
{
    struct ag_context *context = open_context();
    ag_context_destroy(NULL);
    ag_device_destroy(NULL);
    ag_scene_destroy(NULL);
    ag_renderer_destroy(NULL);
    ag_image_destroy(NULL, NULL);
    ag_image_destroy(context, NULL);
    ag_context_destroy(context);
}

TEST(default_functions_accept_nothing)
{
    ag_context_desc_default(NULL);
    ag_device_desc_default(NULL);
    ag_renderer_desc_default(NULL);
    ag_frame_desc_default(NULL);
    ag_view_desc_default(NULL);
    ag_view_frame_default(NULL);
    ag_material_desc_default(NULL);
    ag_material_maps_default(NULL);
    ag_light_desc_default(NULL, AG_LIGHT_SUN);
    ag_compare_desc_default(NULL);
    ag_light_paint_default(NULL);
}

TEST(a_null_context_is_refused)
{
    struct ag_context *context;
    struct ag_device *device;
    struct ag_scene *scene;
    struct ag_image *image;
    struct ag_metrics metrics;
    uint64_t bytes;
    int count;
    char text[8];
    struct ag_device_info info;
    CHECK_REFUSED(NULL, ag_context_create(NULL, NULL));
    CHECK_REFUSED(NULL, ag_device_list(NULL, &info, 1, &count));
    CHECK_REFUSED(NULL, ag_device_create(NULL, NULL, &device));
    CHECK_REFUSED(NULL, ag_scene_load(NULL, "@cornell", &scene));
    CHECK_REFUSED(NULL, ag_scene_load_memory(NULL, NULL, &scene));
    CHECK_REFUSED(NULL, ag_scene_create(NULL, &scene));
    CHECK_REFUSED(NULL, ag_image_create(NULL, 1, 1, 1, &image));
    CHECK_REFUSED(NULL, ag_image_read(NULL, "a.png", NULL, &image));
    CHECK_REFUSED(NULL, ag_image_read_attribute(NULL, "a.exr", "name", text, sizeof text));
    CHECK_REFUSED(NULL, ag_image_write_png(NULL, "a.png", NULL));
    CHECK_REFUSED(NULL, ag_image_write_exr(NULL, "a.exr", NULL, 0, NULL, 0));
    CHECK_REFUSED(NULL, ag_image_tonemap(NULL, NULL, 0, &image));
    CHECK_REFUSED(NULL, ag_image_tonemap_curve(NULL, NULL, 0, AG_TONEMAP_AGX, &image));
    CHECK_REFUSED(NULL, ag_image_side_by_side(NULL, NULL, NULL, 0, &image));
    CHECK_REFUSED(NULL, ag_image_metrics(NULL, NULL, NULL, NULL, &metrics));
    CHECK_REFUSED(NULL, ag_image_error_map(NULL, NULL, NULL, NULL, AG_DIFFERENCE_FLIP, 0, &image));
    CHECK_REFUSED(NULL, ag_renderer_estimate_memory(NULL, NULL, 0, &bytes));
    CHECK_REFUSED(NULL, ag_view_estimate_memory(NULL, NULL, NULL, &bytes));
    CHECK_STRING(ag_context_last_error(NULL), "");
    (void)context;
}

TEST(a_null_object_is_refused)
{
    struct ag_camera camera;
    struct ag_default_lighting lighting;
    struct ag_scene_info scene_info;
    struct ag_light_info light_info;
    struct ag_animation_info animation_info;
    struct ag_material_info material_info;
    struct ag_renderer *renderer = (struct ag_renderer *)1;
    struct ag_image *image = (struct ag_image *)1;
    const float zero[3] = { 0 };
    float ev;
    CHECK_REFUSED(NULL, ag_scene_add_material(NULL, NULL, NULL));
    CHECK_REFUSED(NULL, ag_scene_add_mesh(NULL, NULL, NULL));
    CHECK_REFUSED(NULL, ag_scene_add_image(NULL, NULL, NULL));
    CHECK_REFUSED(NULL, ag_scene_get_material_maps(NULL, 0, NULL));
    CHECK_REFUSED(NULL, ag_scene_add_instance(NULL, 0, NULL, NULL));
    CHECK_REFUSED(NULL, ag_scene_add_light(NULL, NULL, NULL));
    CHECK_REFUSED(NULL, ag_scene_remove_lights(NULL));
    CHECK_REFUSED(NULL, ag_scene_set_sky(NULL, zero));
    CHECK_REFUSED(NULL, ag_scene_look_at(NULL, zero, zero, 1, &camera));
    CHECK_REFUSED(NULL, ag_scene_camera(NULL, "main", 0, 0, &camera));
    CHECK_REFUSED(NULL, ag_scene_default_camera(NULL, 0, 0, &camera, NULL));
    CHECK_REFUSED(NULL, ag_scene_default_lighting(NULL, &lighting));
    CHECK_REFUSED(NULL, ag_scene_add_default_lighting(NULL, NULL));
    CHECK_REFUSED(NULL, ag_scene_get_info(NULL, 0, 0, &scene_info));
    CHECK_REFUSED(NULL, ag_scene_get_light(NULL, 0, 0, 0, &light_info));
    CHECK_REFUSED(NULL, ag_scene_get_animation(NULL, 0, &animation_info));
    CHECK_REFUSED(NULL, ag_scene_get_material(NULL, 0, &material_info));
    assert_int_equal(ag_scene_camera_count(NULL), 0);
    assert_null(ag_scene_camera_name(NULL, 0));
    CHECK_REFUSED(NULL, ag_renderer_create(NULL, NULL, NULL, &renderer));
    assert_null(renderer);
    CHECK_REFUSED(NULL, ag_renderer_resize(NULL, 1, 1));
    struct ag_view *view = (struct ag_view *)1;
    struct ag_layer_handle handle;
    CHECK_REFUSED(NULL, ag_view_create(NULL, NULL, &view));
    assert_null(view);
    CHECK_REFUSED(NULL, ag_view_resize(NULL, 1, 1));
    CHECK_REFUSED(NULL, ag_view_read(NULL, "color", &image));
    CHECK_REFUSED(NULL, ag_view_layer_handle(NULL, "color", &handle));
    CHECK_REFUSED(NULL, ag_view_exposure(NULL, &ev));
    ag_view_destroy(NULL);
    CHECK_REFUSED(NULL, ag_renderer_render(NULL, NULL));
    CHECK_REFUSED(NULL, ag_renderer_record(NULL, NULL, NULL, NULL));
    CHECK_REFUSED(NULL, ag_renderer_recorded_done(NULL, 1));
    CHECK_REFUSED(NULL, ag_renderer_wait(NULL));
    CHECK_REFUSED(NULL, ag_renderer_read(NULL, "color", &image));
    assert_null(image);
    CHECK_REFUSED(NULL, ag_renderer_layer_handle(NULL, "color", NULL));
    CHECK_REFUSED(NULL, ag_renderer_exposure(NULL, &ev));
    CHECK_REFUSED(NULL, ag_renderer_finished(NULL, NULL));
    CHECK_REFUSED(NULL, ag_renderer_picked(NULL, NULL));
    CHECK_REFUSED(NULL, ag_renderer_set_debug_view(NULL, NULL));
    CHECK_REFUSED(NULL, ag_renderer_set_display(NULL, NULL));
    CHECK_REFUSED(NULL, ag_renderer_set_gi(NULL, "none", NULL, 0));
    CHECK_REFUSED(NULL, ag_renderer_set_frame_options(NULL, NULL));
    assert_int_equal(ag_renderer_timings(NULL, NULL, 0), 0);
    assert_int_equal(ag_renderer_finished_timings(NULL, NULL, 0), 0);
    assert_int_equal(ag_renderer_memory(NULL, NULL, 0), 0);
    assert_int_equal(ag_device_memory(NULL, NULL, 0), 0);
    ag_device_get_counters(NULL, NULL);
    CHECK_REFUSED(NULL, ag_device_pipeline_cache(NULL, NULL, 0, NULL));
    assert_int_equal(ag_renderer_reload_shaders(NULL), 0);
    CHECK_STRING(ag_renderer_gi(NULL), "");
    assert_int_equal(ag_device_validation_messages(NULL), 0);
    ag_device_get_info(NULL, NULL);
    assert_true(ag_image_auto_exposure(NULL) == 0.0f);
    assert_true(ag_image_metered_exposure(NULL, AG_METERING_HIGHLIGHTS) == 0.0f);
}

TEST(null_results_are_refused)
{
    struct ag_context *context = open_context();
    struct ag_scene *scene = NULL;
    assert_int_equal(ag_scene_load(context, "@cornell", &scene), AG_OK);
    CHECK_REFUSED(context, ag_device_list(context, NULL, 0, NULL));
    CHECK_REFUSED(context, ag_device_create(context, NULL, NULL));
    CHECK_REFUSED(context, ag_scene_load(context, "@cornell", NULL));
    CHECK_REFUSED(context, ag_scene_create(context, NULL));
    CHECK_REFUSED(context, ag_image_create(context, 1, 1, 1, NULL));
    CHECK_REFUSED(context, ag_image_read(context, "a.png", NULL, NULL));
    CHECK_REFUSED(context, ag_image_read_attribute(context, "a.exr", "name", NULL, 0));
    CHECK_REFUSED(context, ag_renderer_estimate_memory(context, NULL, 0, NULL));
    CHECK_REFUSED(context, ag_view_estimate_memory(context, NULL, NULL, NULL));
    CHECK_REFUSED(context, ag_renderer_create(NULL, scene, NULL, NULL));
    CHECK_REFUSED(context, ag_scene_get_info(scene, 0, 0, NULL));
    CHECK_REFUSED(context, ag_scene_camera(scene, "main", 0, 0, NULL));
    CHECK_REFUSED(context, ag_scene_default_camera(scene, 0, 0, NULL, NULL));
    CHECK_REFUSED(context, ag_scene_default_lighting(scene, NULL));
    CHECK_REFUSED(context, ag_scene_get_material(scene, 0, NULL));
    ag_scene_destroy(scene);
    ag_context_destroy(context);
}

TEST(indices_and_moments_out_of_range_are_refused)
{
    struct ag_context *context = open_context();
    struct ag_scene *scene = NULL;
    struct ag_scene_info info;
    struct ag_light_info light;
    struct ag_material_info material;
    struct ag_animation_info animation;
    struct ag_camera camera;
    assert_int_equal(ag_scene_load(context, "@cornell:light=point", &scene), AG_OK);
    assert_int_equal(ag_scene_get_info(scene, 0, 0, &info), AG_OK);
    CHECK_REFUSED(context, ag_scene_get_info(scene, 1, 0, &info));
    CHECK_REFUSED(context, ag_scene_get_info(scene, -2, 0, &info));
    CHECK_REFUSED(context, ag_scene_get_info(scene, 0, (double)NAN, &info));
    CHECK_REFUSED(context, ag_scene_get_light(scene, -1, 0, 0, &light));
    CHECK_REFUSED(context, ag_scene_get_light(scene, info.lights, 0, 0, &light));
    CHECK_REFUSED(context, ag_scene_get_material(scene, -1, &material));
    CHECK_REFUSED(context, ag_scene_get_material(scene, info.materials, &material));
    CHECK_REFUSED(context, ag_scene_get_animation(scene, 0, &animation));
    CHECK_REFUSED(context, ag_scene_camera(scene, "nobody", 0, 0, &camera));
    CHECK(strstr(ag_context_last_error(context), "main"));
    assert_null(ag_scene_camera_name(scene, -1));
    assert_null(ag_scene_camera_name(scene, info.cameras));
    ag_scene_destroy(scene);
    ag_context_destroy(context);
}

TEST(image_sizes_out_of_range_are_refused)
{
    struct ag_context *context = open_context();
    struct ag_image *image = (struct ag_image *)1;
    CHECK_REFUSED(context, ag_image_create(context, 0, 1, 1, &image));
    assert_null(image);
    CHECK_REFUSED(context, ag_image_create(context, 1, 16385, 1, &image));
    CHECK_REFUSED(context, ag_image_create(context, 1, 1, 0, &image));
    CHECK_REFUSED(context, ag_image_create(context, 1, 1, 5, &image));
    assert_int_equal(ag_image_create(context, 2, 1, 3, &image), AG_OK);
    image->width = 0; // a caller's mistake later on
    struct ag_metrics metrics;
    CHECK_REFUSED(context, ag_image_metrics(context, image, image, NULL, &metrics));
    CHECK_REFUSED(context, ag_image_write_png(context, test_path("a.png"), image));
    ag_image_destroy(context, image);
    ag_context_destroy(context);
}

TEST(invalid_comparisons_are_refused)
{
    struct ag_context *context = open_context();
    struct ag_image *a = NULL, *small = NULL, *map = (struct ag_image *)1;
    struct ag_metrics metrics;
    struct ag_compare_desc desc;
    assert_int_equal(ag_image_create(context, 4, 3, 3, &a), AG_OK);
    assert_int_equal(ag_image_create(context, 3, 4, 1, &small), AG_OK);
    ag_compare_desc_default(&desc);
    assert_int_equal(ag_image_metrics(context, a, a, &desc, &metrics), AG_OK);
    assert_int_equal((int)metrics.counted, 12);
    CHECK(metrics.ssim == 1.0 && metrics.flip == 0.0 && isnan(metrics.flip_hdr));
    CHECK_REFUSED(context,
                  ag_image_error_map(context, a, a, &desc, AG_DIFFERENCE_FLIP_HDR, 0, &map));
    assert_null(map);
    CHECK_REFUSED(context,
                  ag_image_error_map(context, a, a, &desc, (enum ag_difference)6, 0, &map));
    desc.mask = small;
    CHECK_REFUSED(context, ag_image_metrics(context, a, a, &desc, &metrics));
    desc.mask = a; // black: no pixel counts
    CHECK_REFUSED(context, ag_image_metrics(context, a, a, &desc, &metrics));
    desc.mask = NULL;
    desc.ev = NAN;
    CHECK_REFUSED(context, ag_image_metrics(context, a, a, &desc, &metrics));
    desc.ev = 0;
    desc.pixels_per_degree = 1e6f;
    CHECK_REFUSED(context, ag_image_metrics(context, a, a, &desc, &metrics));
    ag_image_destroy(context, a);
    ag_image_destroy(context, small);
    ag_context_destroy(context);
}

TEST(unknown_file_types_are_not_supported)
{
    struct ag_context *context = open_context();
    struct ag_image *image = NULL;
    assert_int_equal(ag_image_read(context, "a.jpg", NULL, &image), AG_ERROR_UNSUPPORTED);
    assert_int_equal(ag_image_read(context, test_path("none.png"), NULL, &image), AG_ERROR_FILE);
    assert_int_equal(ag_image_read(context, test_path("none.exr"), NULL, &image), AG_ERROR_FILE);
    assert_int_equal(ag_image_read(context, "a.png", "color", &image), AG_ERROR_ARGUMENT);
    struct ag_scene *scene = NULL;
    assert_int_equal(ag_scene_load(context, test_path("none.glb"), &scene), AG_ERROR_FILE);
    assert_null(scene);
    ag_context_destroy(context);
}

TEST(wrong_option_texts_name_the_nearest)
{
    struct ag_context *context = open_context();
    struct ag_renderer_desc desc;
    uint64_t bytes = 1;
    ag_renderer_desc_default(&desc);
    desc.frame_options = "shadow_sise=512";
    CHECK_REFUSED(context, ag_renderer_estimate_memory(context, &desc, 1, &bytes));
    CHECK(strstr(ag_context_last_error(context), "shadow_size"));
    assert_true(bytes == 0);
    ag_renderer_desc_default(&desc);
    desc.gi = "lpw";
    CHECK_REFUSED(context, ag_renderer_estimate_memory(context, &desc, 1, &bytes));
    CHECK(strstr(ag_context_last_error(context), "lpv"));
    ag_renderer_desc_default(&desc);
    desc.width = 16385;
    CHECK_REFUSED(context, ag_renderer_estimate_memory(context, &desc, 1, &bytes));
    CHECK_REFUSED(context, ag_renderer_estimate_memory(context, NULL, -1, &bytes));
    ag_context_destroy(context);
}

TEST(library_and_headers_have_one_version)
{
    assert_int_equal(ag_version(), AG_VERSION);
}

TEST(every_result_has_its_own_description)
{
    for (int a = AG_OK; a <= AG_ERROR_CANCELLED + 1; a++)
        for (int b = AG_OK; b < a; b++)
            assert_string_not_equal(ag_result_string((enum ag_result)a),
                                    ag_result_string((enum ag_result)b));
}
