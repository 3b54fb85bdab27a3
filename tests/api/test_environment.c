// Environments through the public API: arguments, files, sharing, and changes while they are used.
#include "api/counting_allocator.h"
#include "api/moving_box.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const double PI = 3.14159265358979;

#define CHECK_REFUSED(context, call, names)                                                        \
    do {                                                                                           \
        assert_int_equal((call), AG_ERROR_ARGUMENT);                                               \
        if (!strstr(ag_context_last_error(context), names))                                        \
            fail_msg("does not name %s: %s", names, ag_context_last_error(context));               \
    } while (0)

static struct ag_environment *uniform(struct ag_context *context, float radiance)
{
    struct ag_environment *environment = NULL;
    float pixels[8 * 4];
    for (int i = 0; i < 8 * 4; i++) pixels[i] = radiance;
    const struct ag_image image = { .width = 8, .height = 4, .channels = 1, .pixels = pixels };
    assert_int_equal(ag_environment_from_image(context, &image, &environment), AG_OK);
    return environment;
}

static void use(struct ag_scene *scene, const struct ag_environment *environment, float strength)
{
    struct ag_environment_use how;
    ag_environment_use_default(&how);
    how.strength = strength;
    assert_int_equal(ag_scene_set_environment(scene, environment, &how), AG_OK);
}

// ---- arguments

TEST(wrong_arguments_of_environments_are_refused)
{
    struct ag_context *context = fixture_context();
    struct ag_environment *none = (struct ag_environment *)1;
    float pixel[4] = { 1, 1, 1, 1 };
    struct ag_image image = { .width = 1, .height = 1, .channels = 3, .pixels = pixel };
    assert_int_equal(ag_environment_load(NULL, "a.hdr", &none), AG_ERROR_ARGUMENT);
    assert_null(none);
    CHECK_REFUSED(context, ag_environment_load(context, NULL, &none), "path is NULL");
    CHECK_REFUSED(context, ag_environment_load(context, "a.hdr", NULL), "out is NULL");
    assert_int_equal(ag_environment_from_image(NULL, &image, &none), AG_ERROR_ARGUMENT);
    CHECK_REFUSED(context, ag_environment_from_image(context, NULL, &none), "image is NULL");
    CHECK_REFUSED(context, ag_environment_from_image(context, &image, NULL), "out is NULL");
    for (int i = 0; i < 5; i++) {
        struct ag_image wrong = image;
        if (i == 0) wrong.width = 0;
        if (i == 1) wrong.height = 16385;
        if (i == 2) wrong.channels = 0;
        if (i == 3) wrong.channels = 5;
        if (i == 4) wrong.pixels = NULL;
        none = (struct ag_environment *)1;
        CHECK_REFUSED(context, ag_environment_from_image(context, &wrong, &none), "image of");
        assert_null(none);
    }
    assert_int_equal(ag_environment_from_sun_sky(NULL, NULL, &none), AG_ERROR_ARGUMENT);
    CHECK_REFUSED(context, ag_environment_from_sun_sky(context, NULL, NULL), "out is NULL");
    ag_environment_destroy(NULL);
    ag_sun_sky_desc_default(NULL);
    ag_environment_use_default(NULL);
    ag_context_destroy(context);
}

TEST(members_of_a_clear_sky_that_are_wrong_are_refused_by_name)
{
    struct ag_context *context = fixture_context();
    struct ag_environment *environment = NULL;
    const struct {
        float elevation, azimuth, turbidity, albedo;
        uint64_t reserved;
        const char *names;
    } cases[] = { { 1.6f, 0, 3, 0.2f, 0, "elevation" },  { -1.6f, 0, 3, 0.2f, 0, "elevation" },
                  { NAN, 0, 3, 0.2f, 0, "elevation" },   { 1, INFINITY, 3, 0.2f, 0, "azimuth" },
                  { 1, 0, 1.9f, 0.2f, 0, "turbidity" },  { 1, 0, 10.1f, 0.2f, 0, "turbidity" },
                  { 1, 0, NAN, 0.2f, 0, "turbidity" },   { 1, 0, 3, -0.1f, 0, "ground_albedo[1]" },
                  { 1, 0, 3, 1.1f, 0, "ground_albedo" }, { 1, 0, 3, NAN, 0, "ground_albedo" },
                  { 1, 0, 3, 0.2f, 1, "reserved" } };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct ag_sun_sky_desc desc;
        ag_sun_sky_desc_default(&desc);
        desc.elevation = cases[i].elevation;
        desc.azimuth = cases[i].azimuth;
        desc.turbidity = cases[i].turbidity;
        desc.ground_albedo[1] = cases[i].albedo;
        desc.reserved[0] = cases[i].reserved;
        CHECK_REFUSED(context, ag_environment_from_sun_sky(context, &desc, &environment),
                      cases[i].names);
        assert_null(environment);
    }
    ag_context_destroy(context);
}

TEST(wrong_uses_of_an_environment_are_refused_and_change_nothing)
{
    struct ag_context *context = fixture_context(), *other = fixture_context();
    struct ag_scene *scene = NULL;
    struct ag_environment *environment = uniform(context, 1e12f), *foreign = uniform(other, 1);
    assert_int_equal(ag_scene_load(context, "@cornell", &scene), AG_OK);
    const struct {
        float strength, rotation;
        uint64_t reserved;
        const char *names;
    } cases[] = { { -1, 0, 0, "strength" },     { NAN, 0, 0, "strength" },
                  { 1.1e6f, 0, 0, "strength" }, { INFINITY, 0, 0, "strength" },
                  { 1e4f, 0, 0, "strength" }, // brighter than is accepted of lights
                  { 1, NAN, 0, "rotation" },    { 1, -INFINITY, 0, "rotation" },
                  { 1, 0, 1, "reserved" } };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct ag_environment_use how;
        ag_environment_use_default(&how);
        how.strength = cases[i].strength;
        how.rotation = cases[i].rotation;
        how.reserved[0] = cases[i].reserved;
        CHECK_REFUSED(context, ag_scene_set_environment(scene, environment, &how), cases[i].names);
    }
    CHECK_REFUSED(context, ag_scene_set_environment(scene, foreign, NULL), "another context");
    assert_int_equal(ag_scene_set_environment(NULL, environment, NULL), AG_ERROR_ARGUMENT);
    assert_int_equal(ag_scene_set_environment(scene, NULL, NULL), AG_OK);
    assert_int_equal(ag_scene_set_environment(scene, environment, NULL), AG_OK);
    struct ag_environment_info info;
    assert_int_equal(ag_environment_get_info(NULL, &info), AG_ERROR_ARGUMENT);
    CHECK_REFUSED(context, ag_environment_get_info(environment, NULL), "out is NULL");
    ag_environment_destroy(environment);
    ag_environment_destroy(foreign);
    ag_scene_destroy(scene);
    ag_context_destroy(context);
    ag_context_destroy(other);
}

// ---- content

TEST(info_tells_the_size_the_mean_and_the_sun)
{
    struct ag_context *context = fixture_context();
    struct ag_environment *environment = uniform(context, 5);
    struct ag_environment_info info;
    memset(&info, 0xff, sizeof info);
    assert_int_equal(ag_environment_get_info(environment, &info), AG_OK);
    assert_true(info.width == 8 && info.height == 4 && !info.has_sun);
    for (int c = 0; c < 3; c++) {
        CHECK_RELATIVE(info.mean[c], 5, 1e-4);
        CHECK(info.to_sun[c] == 0 && info.sun_lux[c] == 0);
    }
    for (int i = 0; i < 4; i++) {
        CHECK_NEAR(info.sh_error[i], 0, 1e-3);
        CHECK(info.reserved[i] == 0);
    }
    ag_environment_destroy(environment);

    struct ag_sun_sky_desc sky;
    ag_sun_sky_desc_default(&sky);
    sky.elevation = 0.5f;
    sky.azimuth = 1;
    assert_int_equal(ag_environment_from_sun_sky(context, &sky, &environment), AG_OK);
    assert_int_equal(ag_environment_get_info(environment, &info), AG_OK);
    CHECK(info.has_sun && info.width > 100 && info.mean[2] > info.mean[0] && info.mean[0] > 100);
    CHECK_NEAR(info.to_sun[0], cos(0.5) * sin(1), 1e-5);
    CHECK_NEAR(info.to_sun[1], sin(0.5), 1e-5);
    CHECK_NEAR(info.to_sun[2], -cos(0.5) * cos(1), 1e-5);
    CHECK(info.sun_lux[0] > info.sun_lux[2] && info.sun_lux[0] < 133300);
    CHECK_NEAR(info.sun_radius, 0.00465, 1e-5);
    for (int i = 1; i < 4; i++) CHECK(info.sh_error[i] <= info.sh_error[i - 1]);
    ag_environment_destroy(environment);
    ag_context_destroy(context);
}

static void write_bytes(const char *path, const char *bytes, size_t size)
{
    FILE *file = fopen(path, "wb");
    assert_true(file && fwrite(bytes, 1, size, file) == size && fclose(file) == 0);
}

TEST(files_that_are_no_environment_are_refused_by_name)
{
    struct ag_context *context = fixture_context();
    struct ag_environment *environment = (struct ag_environment *)1;
    const struct {
        const char *name, *bytes, *names;
        enum ag_result result;
    } cases[] = { { "absent.hdr", NULL, "absent.hdr", AG_ERROR_FILE },
                  { "absent.exr", NULL, "absent.exr", AG_ERROR_FILE },
                  { "damaged.hdr", "#?RADIANCE\n\n", "damaged.hdr", AG_ERROR_FORMAT },
                  { "damaged.exr", "v/1\1", "damaged.exr", AG_ERROR_FORMAT },
                  { "photo.png", "\x89PNG", ".hdr or .exr", AG_ERROR_UNSUPPORTED },
                  { "nothing", "", "nothing", AG_ERROR_UNSUPPORTED } };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        const char *path = test_path(cases[i].name);
        if (cases[i].bytes) write_bytes(path, cases[i].bytes, strlen(cases[i].bytes));
        assert_int_equal(ag_environment_load(context, path, &environment), cases[i].result);
        assert_null(environment);
        if (!strstr(ag_context_last_error(context), cases[i].names))
            fail_msg("does not name %s: %s", cases[i].names, ag_context_last_error(context));
        environment = (struct ag_environment *)1;
    }
    ag_context_destroy(context);
}

TEST(an_exr_file_is_the_image_that_was_written)
{
    struct ag_context *context = fixture_context();
    struct ag_image *image = NULL;
    struct ag_environment *environments[2] = { NULL };
    struct ag_environment_info info[2];
    assert_int_equal(ag_image_create(context, 16, 8, 3, &image), AG_OK);
    for (int i = 0; i < 16 * 8 * 3; i++) image->pixels[i] = (float)(i % 7) + 0.25f;
    char path[300];
    snprintf(path, sizeof path, "%s", test_path("round.exr"));
    assert_int_equal(
        ag_image_write_exr(context, path, &(struct ag_image_layer){ "color", image }, 1, NULL, 0),
        AG_OK);
    assert_int_equal(ag_environment_load(context, path, &environments[0]), AG_OK);
    assert_int_equal(ag_environment_from_image(context, image, &environments[1]), AG_OK);
    ag_image_destroy(context, image);
    for (int i = 0; i < 2; i++) {
        assert_int_equal(ag_environment_get_info(environments[i], &info[i]), AG_OK);
        ag_environment_destroy(environments[i]);
    }
    CHECK(memcmp(info[0].mean, info[1].mean, sizeof info[0].mean) == 0);
    CHECK(info[0].width == 16 && info[0].height == 8);
    CHECK(memcmp(info[0].sh_error, info[1].sh_error, sizeof info[0].sh_error) == 0);
    ag_context_destroy(context);
}

TEST(environments_fail_cleanly_at_each_allocation)
{
    struct counting_allocator allocator = { 0 };
    struct ag_context_desc desc;
    struct ag_context *context = NULL;
    float pixels[6] = { 1, 2, 3, 4, 5, 6 };
    const struct ag_image image = { .width = 2, .height = 1, .channels = 3, .pixels = pixels };
    ag_context_desc_default(&desc);
    desc.reallocate = counting_reallocate;
    desc.user = &allocator;
    assert_int_equal(ag_context_create(&desc, &context), AG_OK);
    const long before = allocator.blocks;
    do {
        struct ag_environment *environment = NULL;
        allocator.asked = 0;
        allocator.refuse_at++;
        const enum ag_result result = ag_environment_from_image(context, &image, &environment);
        CHECK(result == (allocator.asked >= allocator.refuse_at ? AG_ERROR_MEMORY : AG_OK));
        CHECK((result == AG_OK) == (environment != NULL));
        ag_environment_destroy(environment);
        CHECK(allocator.blocks == before);
    } while (allocator.asked >= allocator.refuse_at); // until nothing was refused
    CHECK(allocator.refuse_at > 4);
    ag_context_destroy(context);
    CHECK(allocator.blocks == 0);
}

TEST(another_use_of_an_environment_allocates_nothing)
{
    struct counting_allocator allocator = { 0 };
    struct ag_context_desc desc;
    struct ag_context *context = NULL;
    struct ag_scene *scene = NULL;
    ag_context_desc_default(&desc);
    desc.reallocate = counting_reallocate;
    desc.user = &allocator;
    assert_int_equal(ag_context_create(&desc, &context), AG_OK);
    assert_int_equal(ag_scene_load(context, "@cornell", &scene), AG_OK);
    struct ag_environment *environment = uniform(context, 1);
    use(scene, environment, 1);
    const long asked = allocator.asked;
    for (int i = 0; i < 8; i++) use(scene, environment, (float)i);
    CHECK(allocator.asked == asked);
    ag_environment_destroy(environment);
    ag_scene_destroy(scene);
    ag_context_destroy(context);
    CHECK(allocator.blocks == 0);
}

// ---- scenes

// Mean of the direct light that a floor reflects from the environment, by the reference.
static double floor_radiance(struct ag_context *context, struct ag_scene *scene)
{
    struct ag_reference_desc desc;
    struct ag_reference *reference = NULL;
    struct ag_image *image = NULL;
    const float eye[3] = { 0, 3, 0.1f }, target[3] = { 0, 0, 0 };
    ag_reference_desc_default(&desc);
    desc.width = desc.height = 8;
    assert_int_equal(ag_scene_look_at(scene, eye, target, 0.5f, &desc.camera), AG_OK);
    assert_int_equal(ag_reference_create(scene, &desc, &reference), AG_OK);
    assert_int_equal(ag_reference_render(reference, 16, NULL, NULL), AG_OK);
    assert_int_equal(ag_reference_read(reference, "irradiance_emitters_sky", &image), AG_OK);
    double sum = 0;
    for (int i = 0; i < 8 * 8 * 3; i++) sum += (double)image->pixels[i] / (8 * 8 * 3);
    ag_image_destroy(context, image);
    ag_reference_destroy(reference);
    return sum;
}

static struct ag_scene *floor_scene(struct ag_context *context)
{
    static const float corners[12] = { -9, 0, -9, -9, 0, 9, 9, 0, 9, 9, 0, -9 };
    static const uint32_t indices[6] = { 0, 1, 2, 0, 2, 3 };
    struct ag_scene *scene = NULL;
    struct ag_material_desc material;
    struct ag_mesh_desc mesh = {
        .positions = corners, .vertex_count = 4, .indices = indices, .index_count = 6
    };
    int index = -1;
    ag_material_desc_default(&material);
    assert_int_equal(ag_scene_create(context, &scene), AG_OK);
    assert_int_equal(ag_scene_add_material(scene, &material, &mesh.material), AG_OK);
    assert_int_equal(ag_scene_add_mesh(scene, &mesh, &index), AG_OK);
    assert_int_equal(ag_scene_add_instance(scene, index, NULL, NULL), AG_OK);
    return scene;
}

TEST(a_scene_gives_the_environment_that_it_has)
{
    struct ag_context *context = fixture_context();
    struct ag_scene *scene = floor_scene(context);
    struct ag_environment *made = uniform(context, 7), *got = (struct ag_environment *)1;
    struct ag_environment_use how;
    struct ag_environment_info info;
    assert_int_equal(ag_scene_get_environment(scene, &got, &how), AG_OK);
    assert_null(got);
    ag_environment_use_default(&how);
    how.strength = 3;
    how.rotation = 0.5f;
    assert_int_equal(ag_scene_set_environment(scene, made, &how), AG_OK);
    ag_environment_destroy(made);
    how = (struct ag_environment_use){ 0 };
    assert_int_equal(ag_scene_get_environment(scene, &got, &how), AG_OK);
    assert_non_null(got);
    CHECK(how.strength == 3 && fabsf(how.rotation - 0.5f) < 1e-6f);
    ag_scene_destroy(scene);
    assert_int_equal(ag_environment_get_info(got, &info), AG_OK);
    CHECK(info.width == 8 && info.height == 4 && fabsf(info.mean[0] - 7) < 0.01f);
    ag_environment_destroy(got);
    assert_int_equal(ag_scene_get_environment(NULL, &got, NULL), AG_ERROR_ARGUMENT);
    assert_null(got);
    ag_context_destroy(context);
}

TEST(a_scene_keeps_its_environment_until_it_is_replaced)
{
    struct ag_context *context = fixture_context();
    struct ag_scene *scene = floor_scene(context);
    struct ag_environment *three = uniform(context, 3), *five = uniform(context, 5);
    const float sky[3] = { 1, 1, 1 };
    use(scene, three, 1);
    ag_environment_destroy(three);
    CHECK_RELATIVE(floor_radiance(context, scene), 3 * PI, 0.02);
    use(scene, five, 2);
    ag_environment_destroy(five);
    CHECK_RELATIVE(floor_radiance(context, scene), 10 * PI, 0.02);
    assert_int_equal(ag_scene_set_sky(scene, sky), AG_OK); // is added
    CHECK_RELATIVE(floor_radiance(context, scene), 11 * PI, 0.02);
    assert_int_equal(ag_scene_set_environment(scene, NULL, NULL), AG_OK);
    CHECK_RELATIVE(floor_radiance(context, scene), PI, 0.02);
    ag_scene_destroy(scene);
    ag_context_destroy(context);
}

static bool replace(void *user, double done)
{
    (void)done;
    assert_int_equal(ag_scene_set_environment(user, NULL, NULL), AG_OK);
    return true;
}

TEST(a_reference_keeps_the_environment_of_its_moment)
{
    struct ag_context *context = fixture_context();
    struct ag_scene *scene = floor_scene(context);
    struct ag_reference_desc desc;
    struct ag_reference *reference = NULL;
    struct ag_reference_info info;
    struct ag_environment *environment = uniform(context, 3);
    ag_reference_desc_default(&desc);
    desc.width = desc.height = 8;
    const float eye[3] = { 0, 3, 0.1f }, target[3] = { 0, 0, 0 };
    assert_int_equal(ag_scene_look_at(scene, eye, target, 0.5f, &desc.camera), AG_OK);
    use(scene, environment, 1);
    ag_environment_destroy(environment);
    assert_int_equal(ag_reference_create(scene, &desc, &reference), AG_OK);
    assert_int_equal(ag_reference_render(reference, 8, replace, scene), AG_OK);
    assert_int_equal(ag_reference_render(reference, 8, NULL, NULL), AG_OK);
    assert_int_equal(ag_reference_get_info(reference, &info), AG_OK);
    CHECK(info.mean > 1);
    ag_reference_destroy(reference);
    ag_scene_destroy(scene);
    ag_context_destroy(context);
}

// The context in which it was made may be gone, whether or not another scene there uses it.
TEST(a_scene_takes_its_environment_to_another_context)
{
    for (int shared = 0; shared < 2; shared++) {
        struct counting_allocator allocator = { 0 };
        struct ag_context_desc desc;
        struct ag_context *from = NULL, *to = NULL;
        ag_context_desc_default(&desc);
        desc.reallocate = counting_reallocate;
        desc.user = &allocator;
        assert_int_equal(ag_context_create(&desc, &from), AG_OK);
        assert_int_equal(ag_context_create(&desc, &to), AG_OK);
        struct ag_scene *scene = floor_scene(from);
        struct ag_environment *environment = uniform(from, 3);
        use(scene, environment, 2);
        if (!shared) ag_environment_destroy(environment);
        assert_int_equal(ag_scene_transfer(scene, to), AG_OK);
        if (shared) ag_environment_destroy(environment);
        ag_context_destroy(from);
        CHECK_RELATIVE(floor_radiance(to, scene), 6 * PI, 0.02);
        assert_int_equal(ag_scene_set_environment(scene, NULL, NULL), AG_OK);
        ag_scene_destroy(scene);
        ag_context_destroy(to);
        CHECK(allocator.blocks == 0);
    }
}

// ---- renderers

static double mean_irradiance(struct renderer_fixture *s)
{
    if (ag_renderer_render(s->renderer, &s->frame) != AG_OK)
        fail_msg("%s", ag_context_last_error(s->context));
    struct ag_image *image = fixture_read(s, "irradiance");
    double sum = 0;
    const int values = image->width * image->height * image->channels;
    for (int i = 0; i < values; i++) sum += (double)image->pixels[i] / values;
    ag_image_destroy(s->context, image);
    return sum;
}

TEST(renderers_show_changes_in_their_next_frame)
{
    struct renderer_fixture s = fixture_open("ambient", NULL);
    assert_int_equal(ag_scene_remove_lights(s.scene), AG_OK);
    CHECK_NEAR(mean_irradiance(&s), 0, 1e-6);
    struct ag_environment *environment = uniform(s.context, 3);
    use(s.scene, environment, 1);
    const double once = mean_irradiance(&s);
    CHECK(once > PI);
    for (int i = 2; i < 5; i++) {
        use(s.scene, environment, (float)i);
        CHECK_RELATIVE(mean_irradiance(&s), i * once, 0.01);
    }
    struct ag_environment *other = uniform(s.context, 0.5f);
    ag_environment_destroy(environment); // the renderer still shows it
    use(s.scene, other, 1);
    ag_environment_destroy(other);
    CHECK_RELATIVE(mean_irradiance(&s), once / 6, 0.01);
    assert_int_equal(ag_scene_set_environment(s.scene, NULL, NULL), AG_OK);
    CHECK_NEAR(mean_irradiance(&s), 0, 1e-6);
    fixture_close(&s);
}

TEST(the_sun_of_an_environment_is_a_light_of_the_next_frame)
{
    struct renderer_fixture s = fixture_open("none", NULL);
    struct ag_environment *sky = NULL;
    assert_int_equal(ag_scene_remove_lights(s.scene), AG_OK);
    assert_int_equal(ag_environment_from_sun_sky(s.context, NULL, &sky), AG_OK);
    double mean[3] = { 0 };
    for (int i = 0; i < 3; i++) { // none, the sun opposite to −z, none
        struct ag_environment_use how;
        ag_environment_use_default(&how);
        how.rotation = (float)PI;
        assert_int_equal(ag_scene_set_environment(s.scene, i == 1 ? sky : NULL, &how), AG_OK);
        assert_int_equal(ag_renderer_render(s.renderer, &s.frame), AG_OK);
        struct ag_image *depth = fixture_read(&s, "depth"), *direct = fixture_read(&s, "direct");
        for (int p = 0; p < direct->width * direct->height; p++)
            if (depth->pixels[p * depth->channels] > 0)
                mean[i] += (double)direct->pixels[p * direct->channels + 1];
        ag_image_destroy(s.context, depth);
        ag_image_destroy(s.context, direct);
    }
    CHECK(mean[0] == 0 && mean[1] > 0 && mean[2] == 0);
    ag_environment_destroy(sky);
    fixture_close(&s);
}

// Black but for its sun.
static struct ag_environment *sun_alone(struct ag_context *context)
{
    enum { WIDTH = 256 };
    struct ag_environment *environment = NULL;
    struct ag_environment_info info;
    struct ag_image *image = NULL;
    assert_int_equal(ag_image_create(context, WIDTH, WIDTH / 2, 1, &image), AG_OK);
    image->pixels[WIDTH * 40 + 100] = 1e6f;
    assert_int_equal(ag_environment_from_image(context, image, &environment), AG_OK);
    ag_image_destroy(context, image);
    assert_int_equal(ag_environment_get_info(environment, &info), AG_OK);
    assert_true(info.has_sun && info.mean[1] == 0);
    return environment;
}

TEST(a_scene_with_a_sun_is_not_lit_by_emissive_surfaces_alone)
{
    struct renderer_fixture s = fixture_open("none", NULL);
    for (int lit = 0; lit < 2; lit++) {
        struct ag_renderer_desc desc = fixture_renderer_desc("none");
        struct ag_environment *sun = sun_alone(s.context);
        ag_renderer_destroy(s.renderer);
        ag_scene_destroy(s.scene);
        s.renderer = NULL;
        assert_int_equal(ag_scene_load(s.context, "@cornell", &s.scene), AG_OK);
        if (lit) use(s.scene, sun, 1);
        ag_environment_destroy(sun);
        fixture_last_warning[0] = 0;
        assert_int_equal(ag_renderer_create(s.device, s.scene, &desc, &s.renderer), AG_OK);
        assert_int_equal(ag_renderer_render(s.renderer, &s.frame), AG_OK);
        const bool warned = strstr(fixture_last_warning, "only emissive surfaces");
        CHECK(warned != (lit == 1));
    }
    fixture_close(&s);
}

// Light of a new pose is made in the background, from a snapshot that has the old environment.
TEST(an_environment_is_replaced_while_light_is_made_in_the_background)
{
    struct renderer_fixture s = fixture_open("none", NULL);
    struct ag_scene *of_bake = NULL;
    struct ag_bake *bake = moving_box_bake(s.context, &of_bake);
    const struct ag_bake *one = bake;
    assert_non_null(bake);
    ag_renderer_destroy(s.renderer);
    s.renderer = NULL;
    const int box = moving_box_add(s.scene);
    assert_true(box >= 0);
    struct ag_renderer_desc desc = fixture_renderer_desc(MOVING_BOX_BACKGROUND);
    desc.bakes = &one;
    desc.bake_count = 1;
    struct ag_environment *environment = uniform(s.context, 100);
    use(s.scene, environment, 1);
    ag_environment_destroy(environment);
    if (ag_renderer_create(s.device, s.scene, &desc, &s.renderer) != AG_OK)
        fail_msg("%s", ag_context_last_error(s.context));
    for (int i = 0; i < 6; i++) {
        assert_int_equal(moving_box_place(s.scene, box, -1.0f + 0.3f * (float)i), AG_OK);
        assert_int_equal(ag_renderer_render(s.renderer, &s.frame), AG_OK);
        environment = i % 2 ? uniform(s.context, 50) : NULL;
        assert_int_equal(ag_scene_set_environment(s.scene, environment, NULL), AG_OK);
        ag_environment_destroy(environment);
        CHECK(isfinite(mean_irradiance(&s)));
    }
    ag_renderer_destroy(s.renderer); // waits for the light of the last pose, or ends it
    s.renderer = NULL;
    ag_bake_destroy(bake);
    ag_scene_destroy(of_bake);
    fixture_close(&s);
}
