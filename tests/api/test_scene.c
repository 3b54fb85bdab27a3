// Scenes through the public API: contents are returned unchanged, wrong contents are refused.
#include "framework/test.h"

#include <afterglow/afterglow.h>

#include <math.h>
#include <stdio.h>
#include <string.h>

static struct ag_context *context;
static struct ag_scene *scene;

static void begin(void)
{
    assert_int_equal(ag_context_create(NULL, &context), AG_OK);
    assert_int_equal(ag_scene_create(context, &scene), AG_OK);
}

static void end(void)
{
    ag_scene_destroy(scene);
    ag_context_destroy(context);
}

static const float CORNERS[12] = { 0, 0, 0, 2, 0, 0, 2, 0, 2, 0, 0, 2 };
static const uint32_t INDICES[6] = { 0, 2, 1, 0, 3, 2 };

static struct ag_mesh_desc square(void)
{
    return (struct ag_mesh_desc){
        .positions = CORNERS, .vertex_count = 4, .indices = INDICES, .index_count = 6
    };
}

static int add_square(void)
{
    struct ag_material_desc material;
    ag_material_desc_default(&material);
    assert_int_equal(ag_scene_add_material(scene, &material, NULL), AG_OK);
    int mesh = -1;
    struct ag_mesh_desc desc = square();
    assert_int_equal(ag_scene_add_mesh(scene, &desc, &mesh), AG_OK);
    return mesh;
}

TEST(specular_and_unlit_materials_are_kept_and_checked)
{
    begin();
    struct ag_material_desc material;
    ag_material_desc_default(&material);
    assert_true(material.ior == 1.5f && material.specular == 1 && !material.unlit);
    assert_true(material.specular_color[2] == 1);
    material.ior = 1.8f;
    material.specular = 0.5f;
    material.specular_color[1] = 3;
    material.unlit = true;
    int index = -1;
    assert_int_equal(ag_scene_add_material(scene, &material, &index), AG_OK);
    struct ag_material_info info;
    assert_int_equal(ag_scene_get_material(scene, index, &info), AG_OK);
    assert_true(info.material.ior == 1.8f && info.material.specular == 0.5f);
    assert_true(info.material.specular_color[1] == 3 && info.material.unlit);
    assert_true(!info.specular_map && !info.specular_color_map);
    static const struct {
        float ior, specular, color;
    } wrong[] = { { 0.5f, 1, 1 }, { NAN, 1, 1 },    { INFINITY, 1, 1 }, { 1.5f, -1, 1 },
                  { 1.5f, 2, 1 }, { 1.5f, NAN, 1 }, { 1.5f, 1, -1 },    { 1.5f, 1, NAN } };
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        material.ior = wrong[i].ior;
        material.specular = wrong[i].specular;
        material.specular_color[0] = wrong[i].color;
        assert_int_equal(ag_scene_add_material(scene, &material, NULL), AG_ERROR_ARGUMENT);
    }
    end();
}

TEST(instances_are_placed_by_their_transform)
{
    begin();
    int mesh = add_square();
    float moved[16] = { 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 10, 20, 30, 1 };
    int instance = -1;
    assert_int_equal(ag_scene_add_instance(scene, mesh, NULL, NULL), AG_OK);
    assert_int_equal(ag_scene_add_instance(scene, mesh, moved, &instance), AG_OK);
    assert_int_equal(instance, 1);
    struct ag_scene_info info;
    assert_int_equal(ag_scene_get_info(scene, 0, 0, &info), AG_OK);
    assert_int_equal(info.instances, 2);
    assert_true(info.triangles == 4);
    const float low[3] = { 0, 0, 0 }, high[3] = { 12, 20, 32 };
    for (int i = 0; i < 3; i++) {
        CHECK_NEAR(info.bounds_min[i], low[i], 1e-6);
        CHECK_NEAR(info.bounds_max[i], high[i], 1e-6);
    }
    end();
}

TEST(an_empty_scene_has_no_bounds)
{
    begin();
    struct ag_scene_info info;
    assert_int_equal(ag_scene_get_info(scene, 0, 0, &info), AG_OK);
    CHECK(info.bounds_min[0] > info.bounds_max[0]);
    assert_true(info.triangles == 0);
    end();
}

TEST(wrong_meshes_are_refused)
{
    begin();
    struct ag_mesh_desc desc = square();
    int index = 5;
    assert_int_equal(ag_scene_add_mesh(scene, NULL, &index), AG_ERROR_ARGUMENT);
    assert_int_equal(index, -1);
    desc.material = 7;
    assert_int_equal(ag_scene_add_mesh(scene, &desc, &index), AG_ERROR_ARGUMENT);
    add_square();
    desc = square();
    desc.index_count = 5;
    assert_int_equal(ag_scene_add_mesh(scene, &desc, NULL), AG_ERROR_ARGUMENT);
    const uint32_t beyond[3] = { 0, 1, 4 };
    desc = square();
    desc.indices = beyond;
    desc.index_count = 3;
    assert_int_equal(ag_scene_add_mesh(scene, &desc, NULL), AG_ERROR_ARGUMENT);
    float broken[12];
    memcpy(broken, CORNERS, sizeof broken);
    broken[4] = NAN;
    desc = square();
    desc.positions = broken;
    assert_int_equal(ag_scene_add_mesh(scene, &desc, NULL), AG_ERROR_ARGUMENT);
    desc.positions = NULL;
    assert_int_equal(ag_scene_add_mesh(scene, &desc, NULL), AG_ERROR_ARGUMENT);
    struct ag_scene_info info;
    assert_int_equal(ag_scene_get_info(scene, 0, 0, &info), AG_OK);
    assert_int_equal(info.meshes, 1);
    end();
}

TEST(wrong_instances_are_refused)
{
    begin();
    int mesh = add_square();
    float projective[16] = { 1, 0, 0, 0.5f, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1 };
    assert_int_equal(ag_scene_add_instance(scene, mesh, projective, NULL), AG_ERROR_ARGUMENT);
    projective[3] = INFINITY;
    assert_int_equal(ag_scene_add_instance(scene, mesh, projective, NULL), AG_ERROR_ARGUMENT);
    assert_int_equal(ag_scene_add_instance(scene, mesh + 1, NULL, NULL), AG_ERROR_ARGUMENT);
    assert_int_equal(ag_scene_add_instance(scene, -1, NULL, NULL), AG_ERROR_ARGUMENT);
    end();
}

TEST(wrong_materials_are_refused)
{
    begin();
    struct ag_material_desc desc;
    ag_material_desc_default(&desc);
    desc.base_color[1] = 1.5f;
    assert_int_equal(ag_scene_add_material(scene, &desc, NULL), AG_ERROR_ARGUMENT);
    ag_material_desc_default(&desc);
    desc.emissive[2] = -1;
    assert_int_equal(ag_scene_add_material(scene, &desc, NULL), AG_ERROR_ARGUMENT);
    ag_material_desc_default(&desc);
    desc.roughness = NAN;
    assert_int_equal(ag_scene_add_material(scene, &desc, NULL), AG_ERROR_ARGUMENT);
    end();
}

TEST(materials_are_returned_unchanged)
{
    begin();
    struct ag_material_desc desc;
    struct ag_material_info info;
    ag_material_desc_default(&desc);
    desc.base_color[0] = 0.25f;
    desc.metallic = 0.5f;
    desc.emissive[1] = 300;
    desc.double_sided = true;
    int index = -1;
    assert_int_equal(ag_scene_add_material(scene, &desc, &index), AG_OK);
    assert_int_equal(ag_scene_get_material(scene, index, &info), AG_OK);
    assert_memory_equal(info.material.base_color, desc.base_color, sizeof desc.base_color);
    assert_memory_equal(info.material.emissive, desc.emissive, sizeof desc.emissive);
    assert_true(info.material.metallic == 0.5f && info.material.double_sided);
    CHECK_STRING(info.alpha_mode, "opaque");
    assert_false(info.base_color_map);
    end();
}

TEST(lights_are_returned_unchanged)
{
    begin();
    for (int type = AG_LIGHT_SUN; type <= AG_LIGHT_SPOT; type++) {
        struct ag_light_desc desc;
        struct ag_light_info info;
        ag_light_desc_default(&desc, (enum ag_light_type)type);
        memcpy(desc.position, (float[3]){ 1, 2, 3 }, sizeof desc.position);
        memcpy(desc.direction, (float[3]){ 0, -3, 4 }, sizeof desc.direction);
        memcpy(desc.intensity, (float[3]){ 10, 20, 30 }, sizeof desc.intensity);
        int index = -1;
        assert_int_equal(ag_scene_add_light(scene, &desc, &index), AG_OK);
        assert_int_equal(index, type);
        assert_int_equal(ag_scene_get_light(scene, index, 0, 0, &info), AG_OK);
        assert_int_equal(info.light.type, type);
        for (int i = 0; i < 3; i++) {
            CHECK_NEAR(info.light.intensity[i], desc.intensity[i], 0);
            if (type != AG_LIGHT_SUN) CHECK_NEAR(info.light.position[i], desc.position[i], 1e-6);
            if (type != AG_LIGHT_POINT)
                CHECK_NEAR(info.light.direction[i], desc.direction[i] / 5, 1e-6);
        }
    }
    assert_int_equal(ag_scene_remove_lights(scene), AG_OK);
    struct ag_scene_info info;
    assert_int_equal(ag_scene_get_info(scene, 0, 0, &info), AG_OK);
    assert_int_equal(info.lights, 0);
    end();
}

TEST(wrong_lights_are_refused)
{
    begin();
    struct ag_light_desc desc;
    ag_light_desc_default(&desc, AG_LIGHT_SUN);
    desc.intensity[0] = -1;
    assert_int_equal(ag_scene_add_light(scene, &desc, NULL), AG_ERROR_ARGUMENT);
    ag_light_desc_default(&desc, AG_LIGHT_SUN);
    memset(desc.direction, 0, sizeof desc.direction);
    assert_int_equal(ag_scene_add_light(scene, &desc, NULL), AG_ERROR_ARGUMENT);
    ag_light_desc_default(&desc, AG_LIGHT_SPOT);
    desc.inner_rad = desc.outer_rad;
    assert_int_equal(ag_scene_add_light(scene, &desc, NULL), AG_ERROR_ARGUMENT);
    ag_light_desc_default(&desc, AG_LIGHT_POINT);
    desc.position[1] = INFINITY;
    assert_int_equal(ag_scene_add_light(scene, &desc, NULL), AG_ERROR_ARGUMENT);
    ag_light_desc_default(&desc, (enum ag_light_type)3);
    assert_int_equal(ag_scene_add_light(scene, &desc, NULL), AG_ERROR_ARGUMENT);
    const float negative[3] = { 0, -1, 0 };
    assert_int_equal(ag_scene_set_sky(scene, negative), AG_ERROR_ARGUMENT);
    assert_int_equal(ag_scene_set_sky(scene, NULL), AG_ERROR_ARGUMENT);
    end();
}

TEST(an_area_light_is_a_rectangle_around_its_position)
{
    begin();
    struct ag_area_light_desc desc;
    ag_area_light_desc_default(&desc);
    memcpy(desc.position, (float[3]){ 1, 2, 3 }, sizeof desc.position);
    memcpy(desc.direction, (float[3]){ 0, 0, -5 }, sizeof desc.direction);
    desc.width = 4;
    desc.height = 0.5f;
    int instance = -1;
    assert_int_equal(ag_scene_add_area_light(scene, &desc, &instance), AG_OK);
    assert_int_equal(instance, 0);
    struct ag_scene_info info;
    assert_int_equal(ag_scene_get_info(scene, 0, 0, &info), AG_OK);
    const float low[3] = { -1, 1.75f, 3 }, high[3] = { 3, 2.25f, 3 };
    for (int i = 0; i < 3; i++) {
        CHECK_NEAR(info.bounds_min[i], low[i], 1e-6);
        CHECK_NEAR(info.bounds_max[i], high[i], 1e-6);
    }
    CHECK(info.emissive && info.lights == 0);
    end();
}

TEST(wrong_area_lights_are_refused)
{
    begin();
    struct ag_area_light_desc desc;
    assert_int_equal(ag_scene_add_area_light(scene, NULL, NULL), AG_ERROR_ARGUMENT);
    const float wrong[][4] = { { 0, 1, 1, 1 },  { -1, 1, 1, 1 },  { NAN, 1, 1, 1 },
                               { 1, 0, 1, 1 },  { 1, 1, 0, 1 },   { 1, 1, NAN, 1 },
                               { 1, 1, 1, -1 }, { 1, 1, 1, NAN }, { 1e30f, 1e30f, 1, 1 } };
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
        ag_area_light_desc_default(&desc);
        desc.width = wrong[i][0];
        desc.height = wrong[i][1];
        desc.direction[1] = wrong[i][2];
        desc.radiance[2] = wrong[i][3];
        assert_int_equal(ag_scene_add_area_light(scene, &desc, NULL), AG_ERROR_ARGUMENT);
    }
    ag_area_light_desc_default(&desc);
    desc.position[2] = INFINITY;
    assert_int_equal(ag_scene_add_area_light(scene, &desc, NULL), AG_ERROR_ARGUMENT);
    struct ag_scene_info info;
    assert_int_equal(ag_scene_get_info(scene, 0, 0, &info), AG_OK);
    assert_int_equal(info.instances, 0);
    end();
}

TEST(only_a_dark_scene_gets_the_default_light_and_only_once)
{
    begin();
    assert_int_equal(ag_scene_add_instance(scene, add_square(), NULL, NULL), AG_OK);
    struct ag_default_lighting lighting;
    struct ag_scene_info info;
    assert_int_equal(ag_scene_default_lighting(scene, &lighting), AG_OK);
    assert_true(lighting.needed);
    for (int i = 0; i < 2; i++) {
        assert_int_equal(ag_scene_add_default_lighting(scene, &lighting), AG_OK);
        assert_int_equal(lighting.needed, i == 0);
        assert_int_equal(ag_scene_get_info(scene, 0, 0, &info), AG_OK);
        assert_int_equal(info.lights, 1);
    }
    CHECK(info.sky[0] > 0 && info.sky[1] > 0 && info.sky[2] > 0);
    end();
}

TEST(equal_eye_and_target_are_refused)
{
    begin();
    const float here[3] = { 1, 2, 3 }, there[3] = { 1, 2, 2 }, nowhere[3] = { NAN, 0, 0 };
    struct ag_camera camera;
    assert_int_equal(ag_scene_look_at(scene, here, here, 1, &camera), AG_ERROR_ARGUMENT);
    assert_int_equal(ag_scene_look_at(scene, here, nowhere, 1, &camera), AG_ERROR_ARGUMENT);
    assert_int_equal(ag_scene_look_at(scene, here, there, 0, &camera), AG_ERROR_ARGUMENT);
    assert_int_equal(ag_scene_look_at(scene, here, there, 3.2f, &camera), AG_ERROR_ARGUMENT);
    assert_int_equal(ag_scene_look_at(scene, here, there, 1, &camera), AG_OK);
    assert_memory_equal(camera.eye, here, sizeof here);
    assert_memory_equal(camera.target, there, sizeof there);
    CHECK(camera.near_m > 0);
    end();
}

// Far from the origin the image must not rotate or get lost.
TEST(a_far_scene_gets_the_same_view_as_a_near_one)
{
    static const float places[] = { 0.0f, 65536.0f, 16777216.0f, 5e7f };
    float first[3] = { 0 };
    for (size_t i = 0; i < sizeof places / sizeof *places; i++) {
        begin();
        const float x = places[i], r = fmaxf(1.0f, 0.5f * x);
        const float transform[16] = { r, 0, 0, 0, 0, r, 0, 0, 0, 0, r, 0, x, 0, -x, 1 };
        assert_int_equal(ag_scene_add_instance(scene, add_square(), transform, NULL), AG_OK);
        struct ag_camera camera;
        bool made_up = false;
        assert_int_equal(ag_scene_default_camera(scene, 0, 0, &camera, &made_up), AG_OK);
        float forward[3], length = 0;
        for (int k = 0; k < 3; k++) forward[k] = camera.target[k] - camera.eye[k];
        for (int k = 0; k < 3; k++) length = hypotf(length, forward[k]);
        CHECK(length > 0);
        for (int k = 0; k < 3; k++) {
            if (i == 0) first[k] = forward[k] / length;
            CHECK_NEAR(forward[k] / length, first[k], 1e-4f);
        }
        end();
    }
}

TEST(messages_name_the_called_function)
{
    begin();
    struct ag_light_desc desc;
    ag_light_desc_default(&desc, AG_LIGHT_SUN);
    desc.intensity[0] = -1;
    assert_int_equal(ag_scene_add_light(scene, &desc, NULL), AG_ERROR_ARGUMENT);
    assert_non_null(strstr(ag_context_last_error(context), "cannot call ag_scene_add_light: "));
    desc.intensity[0] = 1;
    desc.direction[1] = -1e30f; // a direction need not be a unit vector
    assert_int_equal(ag_scene_add_light(scene, &desc, NULL), AG_OK);
    end();
}

TEST(a_scene_without_a_camera_gets_a_generated_one)
{
    begin();
    assert_int_equal(ag_scene_add_instance(scene, add_square(), NULL, NULL), AG_OK);
    struct ag_camera camera;
    bool made_up = false;
    assert_int_equal(ag_scene_camera_count(scene), 0);
    assert_int_equal(ag_scene_default_camera(scene, 0, 0, &camera, &made_up), AG_OK);
    assert_true(made_up);
    end();
    assert_int_equal(ag_context_create(NULL, &context), AG_OK);
    assert_int_equal(ag_scene_load(context, "@cornell", &scene), AG_OK);
    assert_int_equal(ag_scene_default_camera(scene, 0, 0, &camera, &made_up), AG_OK);
    assert_false(made_up);
    CHECK_STRING(ag_scene_camera_name(scene, 0), "main");
    end();
}

TEST(time_moves_animated_instances)
{
    const char *path = test_scene_path("box-animated.gltf");
    assert_int_equal(ag_context_create(NULL, &context), AG_OK);
    assert_int_equal(ag_scene_load(context, path, &scene), AG_OK);
    struct ag_animation_info animation;
    struct ag_scene_info rest, start, later, wrapped;
    assert_int_equal(ag_scene_get_animation(scene, 0, &animation), AG_OK);
    double half = animation.duration_s / 2;
    assert_int_equal(ag_scene_get_info(scene, -1, half, &rest), AG_OK);
    assert_int_equal(ag_scene_get_info(scene, 0, 0, &start), AG_OK);
    assert_int_equal(ag_scene_get_info(scene, 0, half, &later), AG_OK);
    assert_int_equal(ag_scene_get_info(scene, 0, half + animation.duration_s, &wrapped), AG_OK);
    CHECK(memcmp(start.bounds_max, later.bounds_max, sizeof later.bounds_max) != 0);
    for (int i = 0; i < 3; i++) {
        CHECK_NEAR(wrapped.bounds_max[i], later.bounds_max[i], 1e-4);
        CHECK(isfinite(rest.bounds_max[i]));
    }
    end();
}

// Beyond them 32-bit floats cannot be traced; Embree would end the program.
TEST(cameras_lights_and_times_beyond_the_limits_are_refused)
{
    begin();
    const float far_away[3] = { 1e19f, 0, 0 }, here[3] = { 0, 1, 0 };
    struct ag_camera camera;
    assert_int_equal(ag_scene_look_at(scene, far_away, here, 1, &camera), AG_ERROR_ARGUMENT);
    assert_non_null(strstr(ag_context_last_error(context), "1e+09 m"));
    struct ag_light_desc light;
    ag_light_desc_default(&light, AG_LIGHT_POINT);
    light.intensity[1] = 1e38f;
    assert_int_equal(ag_scene_add_light(scene, &light, NULL), AG_ERROR_ARGUMENT);
    assert_non_null(strstr(ag_context_last_error(context), "1e+15"));
    const float bright[3] = { 1e38f, 0, 0 };
    assert_int_equal(ag_scene_set_sky(scene, bright), AG_ERROR_ARGUMENT);
    struct ag_scene_info info;
    assert_int_equal(ag_scene_get_info(scene, 0, 1e300, &info), AG_ERROR_ARGUMENT);
    assert_non_null(strstr(ag_context_last_error(context), "time 1e+300 s is beyond"));
    assert_int_equal(ag_scene_get_info(scene, 0, 0, &info), AG_OK);
    end();
}

// Instances that reach far are found when the scene is posed.
TEST(a_scene_built_beyond_the_largest_coordinate_has_no_camera)
{
    begin();
    const float transform[16] = { 1e15f, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1 };
    assert_int_equal(ag_scene_add_instance(scene, add_square(), transform, NULL), AG_OK);
    struct ag_camera camera;
    assert_int_not_equal(ag_scene_default_camera(scene, 0, 0, &camera, NULL), AG_OK);
    assert_non_null(strstr(ag_context_last_error(context), "1e+08 m"));
    end();
}

// Asked for by name, each once: minutes if a lookup took time in proportion to their number.
TEST(thousands_of_cameras_are_found_by_name)
{
    enum { COUNT = 40000 };
    FILE *file = fopen(test_path("cameras.gltf"), "w");
    assert_non_null(file);
    fprintf(file, "{\"asset\":{\"version\":\"2.0\"},\"cameras\":[");
    for (int i = 0; i < COUNT; i++)
        fprintf(file,
                "%s{\"type\":\"perspective\",\"name\":\"c%d\",\"perspective\":"
                "{\"yfov\":1,\"znear\":0.1}}",
                i ? "," : "", i / 2);
    fprintf(file, "],\"nodes\":[");
    for (int i = 0; i < COUNT; i++)
        fprintf(file, "%s{\"camera\":%d,\"translation\":[%d,0,0]}", i ? "," : "", i, i);
    fprintf(file, "]}");
    fclose(file);
    assert_int_equal(ag_context_create(NULL, &context), AG_OK);
    assert_int_equal(ag_scene_load(context, test_path("cameras.gltf"), &scene), AG_OK);
    assert_int_equal(ag_scene_camera_count(scene), COUNT);
    for (int i = 0; i < COUNT; i++) {
        struct ag_camera camera;
        const char *name = ag_scene_camera_name(scene, i);
        assert_int_equal(ag_scene_camera(scene, name, 0, 0, &camera), AG_OK);
        CHECK((int)camera.eye[0] == i / 2 * 2); // the first of that name
    }
    struct ag_camera camera;
    assert_int_equal(ag_scene_camera(scene, "c", 0, 0, &camera), AG_ERROR_ARGUMENT);
    end();
}

TEST(a_scale_multiplies_lengths_and_not_light)
{
    struct ag_scene_load_desc desc = { .scale = 0.01f };
    struct ag_scene *large = NULL, *small = NULL;
    struct ag_scene_info whole, scaled;
    struct ag_light_info light, scaled_light;
    begin();
    assert_int_equal(ag_scene_load_with(context, "@cornell:light=point", NULL, &large), AG_OK);
    assert_int_equal(ag_scene_load_with(context, "@cornell:light=point", &desc, &small), AG_OK);
    assert_int_equal(ag_scene_get_info(large, 0, 0, &whole), AG_OK);
    assert_int_equal(ag_scene_get_info(small, 0, 0, &scaled), AG_OK);
    assert_int_equal(ag_scene_get_light(large, 0, 0, 0, &light), AG_OK);
    assert_int_equal(ag_scene_get_light(small, 0, 0, 0, &scaled_light), AG_OK);
    for (int i = 0; i < 3; i++) {
        CHECK_NEAR(scaled.bounds_max[i], 0.01f * whole.bounds_max[i], 1e-6);
        CHECK_NEAR(scaled_light.light.position[i], 0.01f * light.light.position[i], 1e-6);
        CHECK(scaled_light.light.intensity[i] == light.light.intensity[i]);
    }
    ag_scene_destroy(large);
    ag_scene_destroy(small);
    desc.scale = -1;
    assert_int_equal(ag_scene_load_with(context, "@cornell", &desc, &small), AG_ERROR_ARGUMENT);
    desc.scale = 1;
    desc.reserved[7] = 1;
    assert_int_equal(ag_scene_load_with(context, "@cornell", &desc, &small), AG_ERROR_ARGUMENT);
    end();
}
