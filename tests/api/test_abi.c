// Reserved members of descriptions: programs for newer libraries are refused. abi.txt lists the
// sizes and members of structs.
#include "framework/test.h"

#include <afterglow/afterglow.h>

#include <string.h>

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
    renderer.reserved[4] = 1;
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

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wdeprecated-declarations"
TEST(former_names_of_functions_work)
{
    struct ag_bake_estimate estimate;
    assert_int_equal(ag_bake_estimate(NULL, false, &estimate), AG_ERROR_ARGUMENT);
    assert_int_equal(ag_bake_estimate_cost(NULL, false, &estimate), AG_ERROR_ARGUMENT);
}
#pragma GCC diagnostic pop

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
