// Scenes unsuitable for a grid of cells: techniques warn and still work.
#include "framework/gpu_test.h"

#include <afterglow/afterglow.h>

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { SIZE = 32, LOG_BYTES = 8192 };

static char said[LOG_BYTES]; // by level, "0 …\n" and so on

static void listen(void *user, enum ag_log_level level, const char *message)
{
    (void)user;
    const size_t length = strlen(said);
    snprintf(said + length, sizeof said - length, "%d %s\n", (int)level, message);
}

static void check_said(enum ag_log_level level, const char *gi, const char *what)
{
    char begin[64];
    snprintf(begin, sizeof begin, "%d gi %s: ", (int)level, gi);
    const char *line = strstr(said, begin);
    for (; line; line = strstr(line + 1, begin)) {
        const char *hit = strstr(line, what), *end = strchr(line, '\n');
        if (hit && hit < end) return;
    }
    fail_msg("not said by %s at level %d: %s; but\n%s", gi, (int)level, what, said);
}

// One device for all tests, one after the other: pipelines are compiled once.
struct floor_test {
    struct ag_context *context;
    struct ag_device *device;
    int messages; // of validation, before the test
};
static struct floor_test shared_test;

static bool close_device(void)
{
    ag_device_destroy(shared_test.device);
    ag_context_destroy(shared_test.context);
    return true;
}

static void open_device(void)
{
    struct ag_context_desc context;
    ag_context_desc_default(&context);
    context.log = listen;
    context.log_up_to = AG_LOG_INFO;
    assert_int_equal(ag_context_create(&context, &shared_test.context), AG_OK);
    struct ag_device_desc device;
    ag_device_desc_default(&device);
    device.validation = true;
    assert_int_equal(ag_device_create(shared_test.context, &device, &shared_test.device), AG_OK);
    test_register_end(close_device);
}

static struct floor_test floor_test_open(void)
{
    test_gpu_require();
    if (!shared_test.device) open_device();
    shared_test.messages = ag_device_validation_messages(shared_test.device);
    return shared_test;
}

static void floor_test_close(const struct floor_test *test)
{
    assert_int_equal(ag_device_validation_messages(test->device), test->messages);
}

// A floor of `side` metres with a wall at one end, below a point light.
static struct ag_scene *make_floor(struct ag_context *context, float side, float lamp_height)
{
    struct ag_scene *scene = NULL;
    assert_int_equal(ag_scene_create(context, &scene), AG_OK);
    struct ag_material_desc material;
    ag_material_desc_default(&material);
    int matte, mesh;
    assert_int_equal(ag_scene_add_material(scene, &material, &matte), AG_OK);
    const float h = 0.5f * side;
    const float positions[] = { -h, 0, -h, -h, 0, h, h, 0, h, h, 0, -h, -h, h, -h, h, h, -h };
    const uint32_t indices[] = { 0, 1, 2, 0, 2, 3, 0, 3, 5, 0, 5, 4 };
    const struct ag_mesh_desc desc = { .positions = positions,
                                       .vertex_count = 6,
                                       .indices = indices,
                                       .index_count = 12,
                                       .material = matte };
    assert_int_equal(ag_scene_add_mesh(scene, &desc, &mesh), AG_OK);
    assert_int_equal(ag_scene_add_instance(scene, mesh, NULL, NULL), AG_OK);
    struct ag_light_desc light;
    ag_light_desc_default(&light, AG_LIGHT_POINT);
    light.position[1] = lamp_height;
    for (int c = 0; c < 3; c++) light.intensity[c] = 1000.0f * lamp_height * lamp_height;
    assert_int_equal(ag_scene_add_light(scene, &light, NULL), AG_OK);
    return scene;
}

// Mean irradiance of the floor by `gi`. Afterwards `said` has the messages.
static double render_floor(struct floor_test *test, const char *gi, float side, float lamp_height)
{
    said[0] = '\0';
    struct ag_scene *scene = make_floor(test->context, side, lamp_height);
    struct ag_renderer *renderer = NULL;
    struct ag_renderer_desc desc;
    struct ag_frame_desc frame;
    ag_renderer_desc_default(&desc);
    desc.width = desc.height = SIZE;
    desc.gi = gi;
    ag_frame_desc_default(&frame);
    const float distance = side > 0 ? side : 1;
    const float eye[3] = { 0, distance, distance }, target[3] = { 0, 0, 0 };
    assert_int_equal(ag_scene_look_at(scene, eye, target, 1.0f, &frame.camera), AG_OK);
    assert_int_equal(ag_renderer_create(test->device, scene, &desc, &renderer), AG_OK);
    assert_int_equal(ag_renderer_render(renderer, &frame), AG_OK);
    struct ag_image *image = NULL;
    assert_int_equal(ag_renderer_read(renderer, "irradiance", &image), AG_OK);
    double sum = 0;
    for (int i = 0; i < 3 * SIZE * SIZE; i++) {
        CHECK(isfinite(image->pixels[i]) && image->pixels[i] >= 0.0f);
        sum += (double)image->pixels[i] / (3.0 * SIZE * SIZE);
    }
    ag_image_destroy(test->context, image);
    ag_renderer_destroy(renderer);
    ag_scene_destroy(scene);
    return sum;
}

static const char *const volumes[] = { "lpv", "holpv", "vct" };
enum { VOLUMES = sizeof volumes / sizeof volumes[0] };

TEST(a_suitable_scene_logs_its_cell_size)
{
    struct floor_test test = floor_test_open();
    for (int i = 0; i < VOLUMES; i++) {
        CHECK(render_floor(&test, volumes[i], 8, 2) > 0);
        check_said(AG_LOG_INFO, volumes[i],
                   strcmp(volumes[i], "vct") == 0 ? "scene: 60 x " : "scene: 32 x ");
        CHECK(!strstr(said, "0 gi") && !strstr(said, "1 gi")); // no error, no warning
    }
    floor_test_close(&test);
}

TEST(a_scene_too_large_for_its_cells_causes_a_warning)
{
    struct floor_test test = floor_test_open();
    for (int i = 0; i < VOLUMES; i++) {
        CHECK(render_floor(&test, volumes[i], 4000, 1000) > 0);
        check_said(AG_LOG_WARNING, volumes[i], "indirect light has no finer detail");
        if (strstr(volumes[i], "lpv"))
            check_said(AG_LOG_WARNING, volumes[i], "no finer detail; cascades=4,cell=");
    }
    floor_test_close(&test);
}

TEST(a_scene_without_extent_causes_a_warning)
{
    struct floor_test test = floor_test_open();
    for (int i = 0; i < VOLUMES; i++) {
        CHECK(render_floor(&test, volumes[i], 0, 2) == 0);
        check_said(AG_LOG_WARNING, volumes[i], "there is no indirect light");
    }
    floor_test_close(&test);
}

TEST(occlusion_by_cones_logs_the_same)
{
    struct floor_test test = floor_test_open();
    render_floor(&test, "vctao", 4000, 1000);
    check_said(AG_LOG_WARNING, "vctao", "ambient occlusion has no finer detail");
    render_floor(&test, "vctao", 0, 2);
    check_said(AG_LOG_WARNING, "vctao", "there is no ambient occlusion");
    floor_test_close(&test);
}

// The height of the wall is half the length of the floor.
TEST(a_light_outside_the_grid_has_the_same_effect)
{
    struct floor_test test = floor_test_open();
    for (int i = 0; i < VOLUMES; i++) {
        CHECK(render_floor(&test, volumes[i], 8, 100) > 0);
        if (strcmp(volumes[i], "vct") !=
            0) // every voxel asks the shadow maps, wherever the light is
            check_said(AG_LOG_INFO, volumes[i], "light 0 of scene is outside of the grid");
    }
    floor_test_close(&test);
}
