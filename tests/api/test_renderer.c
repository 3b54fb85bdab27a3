// Renderers through the public API: frames, layers, changes between frames, several renderers,
// adopted devices and command buffers.
#include "api/counting_allocator.h"
#include "api/renderer_fixture.h"
#include "framework/own_device.h"

#include <afterglow/afterglow.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { WIDTH = FIXTURE_WIDTH, HEIGHT = FIXTURE_HEIGHT };

static double mean(const struct ag_image *image)
{
    double sum = 0;
    int count = image->width * image->height * image->channels;
    for (int i = 0; i < count; i++) sum += (double)image->pixels[i];
    return sum / count;
}

static double mean_of(struct renderer_fixture *s, const char *layer)
{
    struct ag_image *image = fixture_read(s, layer);
    double value = mean(image);
    ag_image_destroy(s->context, image);
    return value;
}

static bool equal(const struct ag_image *a, const struct ag_image *b)
{
    size_t count = (size_t)a->width * (size_t)a->height * (size_t)a->channels;
    return a->width == b->width && a->height == b->height && a->channels == b->channels &&
           memcmp(a->pixels, b->pixels, count * sizeof *a->pixels) == 0;
}

TEST(every_layer_is_finite_and_of_the_frames_size)
{
    struct renderer_fixture s = fixture_open("lpv", NULL);
    ag_renderer_destroy(s.renderer);
    struct ag_renderer_desc desc = fixture_renderer_desc("lpv");
    desc.id_layer = true;
    assert_int_equal(ag_renderer_create(s.device, s.scene, &desc, &s.renderer), AG_OK);
    assert_int_equal(ag_renderer_render(s.renderer, &s.frame), AG_OK);
    const char *name;
    for (int i = 0; (name = ag_layer_name(i)); i++) {
        if (strcmp(name, "debug") == 0) continue; // not asked for
        struct ag_image *image = fixture_read(&s, name);
        bool single = strcmp(name, "depth") == 0 || strcmp(name, "visibility") == 0;
        assert_int_equal(image->width, WIDTH);
        assert_int_equal(image->height, HEIGHT);
        assert_int_equal(image->channels, single ? 1 : strcmp(name, "id") == 0 ? 2 : 3);
        for (int k = 0; k < WIDTH * HEIGHT * image->channels; k++)
            CHECK(isfinite(image->pixels[k]));
        ag_image_destroy(s.context, image);
    }
    CHECK(mean_of(&s, "direct") > 0 && mean_of(&s, "indirect") > 0);
    CHECK(mean_of(&s, "visibility") == 1.0);
    float ev = 0;
    assert_int_equal(ag_renderer_exposure(s.renderer, &ev), AG_OK);
    CHECK(isfinite(ev) && ev != 0);
    fixture_close(&s);
}

TEST(unknown_layers_and_layers_not_kept_are_refused)
{
    struct renderer_fixture s = fixture_open("lpv", NULL);
    struct ag_image *image = (struct ag_image *)1;
    assert_int_equal(ag_renderer_read(s.renderer, "color", &image), AG_ERROR_ARGUMENT); // no frame
    assert_null(image);
    assert_int_equal(ag_renderer_render(s.renderer, &s.frame), AG_OK);
    assert_int_equal(ag_renderer_read(s.renderer, "colour", &image), AG_ERROR_ARGUMENT);
    CHECK(strstr(ag_context_last_error(s.context), "did you mean color?"));
    assert_int_equal(ag_renderer_read(s.renderer, "debug", &image), AG_ERROR_ARGUMENT);
    assert_int_equal(ag_renderer_read(s.renderer, NULL, &image), AG_ERROR_ARGUMENT);
    assert_int_equal(ag_renderer_set_debug_view(s.renderer, "no-such-view"), AG_ERROR_ARGUMENT);
    ag_renderer_destroy(s.renderer);
    struct ag_renderer_desc desc = fixture_renderer_desc("none");
    desc.indirect_layer = desc.display_layer = desc.motion_layer = false;
    assert_int_equal(ag_renderer_create(s.device, s.scene, &desc, &s.renderer), AG_OK);
    assert_int_equal(ag_renderer_render(s.renderer, &s.frame), AG_OK);
    assert_int_equal(ag_renderer_read(s.renderer, "indirect", &image), AG_ERROR_ARGUMENT);
    assert_int_equal(ag_renderer_read(s.renderer, "display", &image), AG_ERROR_ARGUMENT);
    assert_int_equal(ag_renderer_read(s.renderer, "motion", &image), AG_ERROR_ARGUMENT);
    CHECK(strstr(ag_context_last_error(s.context), "motion_layer"));
    CHECK(mean_of(&s, "irradiance") == 0.0); // that nobody writes
    fixture_close(&s);
}

TEST(debug_views_fill_the_debug_layer_until_they_are_switched_off)
{
    struct renderer_fixture s = fixture_open("lpv", NULL);
    struct ag_technique_info info;
    const char *view = NULL;
    for (int i = 0; ag_technique_get(i, &info); i++)
        if (strcmp(info.name, "lpv") == 0) ag_technique_debug_view_get(i, 0, &view, NULL);
    assert_non_null(view);
    assert_int_equal(ag_renderer_set_debug_view(s.renderer, view), AG_OK);
    assert_int_equal(ag_renderer_render(s.renderer, &s.frame), AG_OK);
    CHECK(mean_of(&s, "debug") > 0);
    assert_int_equal(ag_renderer_set_debug_view(s.renderer, NULL), AG_OK);
    assert_int_equal(ag_renderer_render(s.renderer, &s.frame), AG_OK);
    struct ag_image *image = NULL;
    assert_int_equal(ag_renderer_read(s.renderer, "debug", &image), AG_ERROR_ARGUMENT);
    fixture_close(&s);
}

TEST(wrong_frames_are_refused)
{
    uint64_t number = 0;
    struct renderer_fixture s = fixture_open("none", NULL);
    struct ag_frame_desc frame;
    assert_int_equal(ag_renderer_render(s.renderer, NULL), AG_ERROR_ARGUMENT);
    ag_frame_desc_default(&frame); // no camera yet
    assert_int_equal(ag_renderer_render(s.renderer, &frame), AG_ERROR_ARGUMENT);
    frame = s.frame;
    frame.animation = 1;
    assert_int_equal(ag_renderer_render(s.renderer, &frame), AG_ERROR_ARGUMENT);
    frame = s.frame;
    frame.time_s = (double)NAN;
    assert_int_equal(ag_renderer_render(s.renderer, &frame), AG_ERROR_ARGUMENT);
    frame = s.frame;
    frame.auto_exposure = false;
    frame.exposure_ev = INFINITY;
    assert_int_equal(ag_renderer_render(s.renderer, &frame), AG_ERROR_ARGUMENT);
    frame = s.frame;
    frame.camera.near_m = 0;
    assert_int_equal(ag_renderer_render(s.renderer, &frame), AG_ERROR_ARGUMENT);
    frame = s.frame;
    frame.camera.vertical_fov_rad = 3.2f;
    assert_int_equal(ag_renderer_render(s.renderer, &frame), AG_ERROR_ARGUMENT);
    assert_int_equal(ag_renderer_recorded_done(s.renderer, 1), AG_ERROR_ARGUMENT);
    assert_int_equal(ag_renderer_record(s.renderer, &s.frame, &s, &number),
                     AG_ERROR_ARGUMENT); // not lent
    fixture_close(&s);
}

TEST(wrong_renderers_are_refused)
{
    struct renderer_fixture s = fixture_open("none", NULL);
    struct ag_renderer *renderer = (struct ag_renderer *)1;
    struct ag_renderer_desc desc = fixture_renderer_desc("lpv:stepz=4");
    assert_int_equal(ag_renderer_create(s.device, s.scene, &desc, &renderer), AG_ERROR_ARGUMENT);
    assert_null(renderer);
    CHECK(strstr(ag_context_last_error(s.context), "steps"));
    desc = fixture_renderer_desc("none");
    desc.height = 0;
    assert_int_equal(ag_renderer_create(s.device, s.scene, &desc, &renderer), AG_ERROR_ARGUMENT);
    desc = fixture_renderer_desc("none");
    desc.frame_options = "cascades=9";
    assert_int_equal(ag_renderer_create(s.device, s.scene, &desc, &renderer), AG_ERROR_ARGUMENT);
    struct ag_context *other = fixture_context();
    struct ag_scene *stranger = NULL;
    assert_int_equal(ag_scene_load(other, "@cornell", &stranger), AG_OK);
    assert_int_equal(ag_renderer_create(s.device, stranger, NULL, &renderer), AG_ERROR_ARGUMENT);
    ag_scene_destroy(stranger);
    ag_context_destroy(other);
    // After each refused call only the fixture uses the scene.
    ag_renderer_destroy(s.renderer);
    s.renderer = NULL;
    struct ag_material_desc material;
    ag_material_desc_default(&material);
    assert_int_equal(ag_scene_add_material(s.scene, &material, NULL), AG_OK);
    fixture_close(&s);
}

TEST(lights_may_change_while_a_renderer_exists)
{
    struct renderer_fixture s = fixture_open("lpv", NULL);
    assert_int_equal(ag_renderer_render(s.renderer, &s.frame), AG_OK);
    double once = mean_of(&s, "color");
    struct ag_light_info light;
    assert_int_equal(ag_scene_get_light(s.scene, 0, 0, 0, &light), AG_OK);
    assert_int_equal(ag_scene_add_light(s.scene, &light.light, NULL), AG_OK);
    assert_int_equal(ag_renderer_render(s.renderer, &s.frame), AG_OK);
    CHECK_RELATIVE(mean_of(&s, "color"), 2 * once, 5e-3);
    assert_int_equal(ag_scene_remove_lights(s.scene), AG_OK);
    assert_int_equal(ag_renderer_render(s.renderer, &s.frame), AG_OK);
    CHECK(mean_of(&s, "color") == 0.0);
    fixture_close(&s);
}

TEST(a_resize_changes_the_size_of_every_layer)
{
    struct renderer_fixture s = fixture_open("lpv", NULL);
    assert_int_equal(ag_renderer_render(s.renderer, &s.frame), AG_OK);
    assert_int_equal(ag_renderer_resize(s.renderer, 0, 10), AG_ERROR_ARGUMENT);
    assert_int_equal(ag_renderer_resize(s.renderer, 10, 16385), AG_ERROR_ARGUMENT);
    assert_int_equal(ag_renderer_resize(s.renderer, 17, 9), AG_OK);
    struct ag_image *image = NULL;
    assert_int_equal(ag_renderer_read(s.renderer, "color", &image), AG_ERROR_ARGUMENT); // not yet
    assert_int_equal(ag_renderer_render(s.renderer, &s.frame), AG_OK);
    image = fixture_read(&s, "color");
    CHECK(image->width == 17 && image->height == 9);
    CHECK(mean(image) > 0);
    ag_image_destroy(s.context, image);
    fixture_close(&s);
}

TEST(times_and_memory_are_listed_by_name)
{
    struct renderer_fixture s = fixture_open("lpv", NULL);
    assert_int_equal(ag_renderer_timings(s.renderer, NULL, 0), 0); // no frame
    assert_int_equal(ag_renderer_render(s.renderer, &s.frame), AG_OK);
    struct ag_timing timings[64];
    int count = ag_renderer_timings(s.renderer, timings, 64);
    double whole = 0, parts = 0;
    for (int i = 0; i < count; i++) {
        CHECK(timings[i].ms >= 0);
        if (strcmp(timings[i].name, "frame") == 0)
            whole = timings[i].ms;
        else
            parts += timings[i].ms;
    }
    CHECK(count > 3 && whole > 0 && parts > 0 && parts <= 1.01 * whole);
    // A capacity below the number of passes: the count is complete, nothing is written beyond.
    timings[1].ms = -1;
    assert_int_equal(ag_renderer_timings(s.renderer, timings, 1), count);
    CHECK(timings[1].ms == -1);

    struct ag_memory owners[64];
    count = ag_renderer_memory(s.renderer, owners, 64);
    uint64_t taken = 0, estimate = 0;
    bool has_lpv = false;
    for (int i = 0; i < count; i++) {
        has_lpv |= strcmp(owners[i].owner, "lpv") == 0;
        if (strcmp(owners[i].owner, "scene") != 0 && strcmp(owners[i].owner, "gpu") != 0)
            taken += owners[i].bytes;
    }
    CHECK(has_lpv);
    struct ag_renderer_desc desc = fixture_renderer_desc("lpv");
    assert_int_equal(ag_renderer_estimate_memory(s.context, &desc, 1, &estimate), AG_OK);
    if (taken > estimate)
        fail_msg("%llu bytes are taken, %llu were estimated at most", (unsigned long long)taken,
                 (unsigned long long)estimate);
    CHECK(strncmp(ag_renderer_gi(s.renderer), "lpv:", 4) == 0);
    fixture_close(&s);
}

TEST(two_contexts_do_not_affect_each_other)
{
    struct renderer_fixture alone = fixture_open("lpv", NULL);
    assert_int_equal(ag_renderer_render(alone.renderer, &alone.frame), AG_OK);
    struct ag_image *expected = fixture_read(&alone, "color");
    struct renderer_fixture a = fixture_open("lpv", NULL), b = fixture_open("ambient", NULL);
    for (int i = 0; i < 2; i++) {
        assert_int_equal(ag_renderer_render(a.renderer, &a.frame), AG_OK);
        assert_int_equal(ag_renderer_render(b.renderer, &b.frame), AG_OK);
    }
    struct ag_image *of_a = fixture_read(&a, "color"), *of_b = fixture_read(&b, "color");
    CHECK(equal(of_a, expected));
    CHECK(!equal(of_b, expected));
    ag_image_destroy(b.context, of_b);
    fixture_close(&b); // a goes on without b
    assert_int_equal(ag_renderer_render(a.renderer, &a.frame), AG_OK);
    ag_image_destroy(a.context, of_a);
    fixture_close(&a);
    ag_image_destroy(alone.context, expected);
    fixture_close(&alone);
}

// Creates a renderer, renders and reads an image, or returns the first failure; afterwards
// allocations succeed again. *calls: allocations so far.
static enum ag_result render_once(struct renderer_fixture *s, struct counting_allocator *allocator,
                                  struct ag_image **image, long *calls)
{
    long begun = allocator->asked;
    struct ag_renderer_desc desc = fixture_renderer_desc("lpv");
    struct ag_renderer *renderer = NULL;
    enum ag_result result = ag_renderer_create(s->device, s->scene, &desc, &renderer);
    if (result == AG_OK) result = ag_renderer_render(renderer, &s->frame);
    if (result == AG_OK) result = ag_renderer_read(renderer, "color", image);
    *calls = allocator->asked - begun;
    allocator->refuse_at = 0;
    ag_renderer_destroy(renderer);
    return result;
}

TEST(a_refused_allocation_in_a_renderer_is_a_memory_error_and_the_next_one_works)
{
    enum { SAMPLES = 24 }; // of all allocations, evenly spread
    test_gpu_require();
    struct counting_allocator allocator = { 0 };
    struct renderer_fixture s = { 0 };
    struct ag_context_desc desc;
    ag_context_desc_default(&desc);
    desc.reallocate = counting_reallocate;
    desc.user = &allocator;
    assert_int_equal(ag_context_create(&desc, &s.context), AG_OK);
    assert_int_equal(ag_device_create(s.context, NULL, &s.device), AG_OK);
    assert_int_equal(ag_scene_load(s.context, "@cornell:light=point", &s.scene), AG_OK);
    ag_frame_desc_default(&s.frame);
    assert_int_equal(ag_scene_camera(s.scene, "main", 0, 0, &s.frame.camera), AG_OK);

    struct ag_image *expected = NULL, *image = NULL;
    long calls, ignored;
    assert_int_equal(render_once(&s, &allocator, &expected, &calls),
                     AG_OK); // makes what lasts, too
    assert_int_equal(render_once(&s, &allocator, &image, &calls), AG_OK);
    CHECK(equal(image, expected));
    ag_image_destroy(s.context, image);
    assert_true(calls > SAMPLES);
    for (long i = 0; i < SAMPLES; i++) {
        long refused = 1 + i * (calls - 1) / (SAMPLES - 1);
        allocator.refuse_at = allocator.asked + refused;
        image = NULL;
        long asked;
        enum ag_result result = render_once(&s, &allocator, &image, &asked);
        if (asked < refused) { // lists that have grown already: there was nothing to refuse
            CHECK(result == AG_OK && equal(image, expected));
            ag_image_destroy(s.context, image);
        } else if (result != AG_ERROR_MEMORY || image)
            fail_msg("refusal %ld of %ld gives \"%s\"", refused, calls, ag_result_string(result));
    }
    assert_int_equal(render_once(&s, &allocator, &image, &ignored), AG_OK);
    CHECK(equal(image, expected));
    ag_image_destroy(s.context, image);
    ag_image_destroy(s.context, expected);
    fixture_close(&s);
    assert_int_equal(allocator.blocks, 0);
}

TEST(two_renderers_share_a_device_and_a_scene)
{
    struct renderer_fixture s = fixture_open("lpv", NULL);
    struct ag_renderer_desc desc = fixture_renderer_desc("none");
    struct ag_renderer *second = NULL;
    assert_int_equal(ag_renderer_create(s.device, s.scene, &desc, &second), AG_OK);
    assert_int_equal(ag_renderer_render(s.renderer, &s.frame), AG_OK);
    assert_int_equal(ag_renderer_render(second, &s.frame), AG_OK);
    struct ag_image *with = fixture_read(&s, "color"), *without = NULL;
    assert_int_equal(ag_renderer_read(second, "color", &without), AG_OK);
    CHECK(mean(with) > mean(without));
    ag_image_destroy(s.context, with);
    ag_image_destroy(s.context, without);
    ag_renderer_destroy(second);
    fixture_close(&s);
}

// ---- adopted device

// The image from the library's own device; static storage.
static const struct ag_image *expected_color(void)
{
    static float pixels[WIDTH * HEIGHT * 3];
    static const struct ag_image copy = { WIDTH, HEIGHT, 3, pixels };
    struct renderer_fixture s = fixture_open("lpv", NULL);
    assert_int_equal(ag_renderer_render(s.renderer, &s.frame), AG_OK);
    struct ag_image *color = fixture_read(&s, "color");
    memcpy(pixels, color->pixels, sizeof pixels);
    ag_image_destroy(s.context, color);
    fixture_close(&s);
    return &copy;
}

TEST(an_adopted_device_renders_the_same_and_its_queue_is_locked)
{
    const struct ag_image *expected = expected_color();
    struct own_device own;
    own_device_open(&own, 0);
    struct ag_device_adopt adopt = fixture_lend(&own);
    struct renderer_fixture s = fixture_open("lpv", &adopt);
    int before = own.locks;
    assert_int_equal(ag_renderer_render(s.renderer, &s.frame), AG_OK);
    assert_int_equal(own.locks, before + 1);
    struct ag_image *color = fixture_read(&s, "color");
    CHECK(equal(color, expected));
    assert_int_equal(own.held, 0);
    struct ag_layer_handle layer;
    assert_int_equal(ag_renderer_layer_handle(s.renderer, "irradiance", &layer), AG_OK);
    CHECK(layer.vk_image != NULL && layer.scale > 0);
    assert_int_equal(ag_renderer_layer_handle(s.renderer, "position", &layer),
                     AG_ERROR_UNSUPPORTED);
    ag_image_destroy(s.context, color);
    fixture_close(&s);
    own_device_close(&own);
}

TEST(a_frame_is_recorded_into_the_programs_command_buffer)
{
    const struct ag_image *expected = expected_color();
    struct own_device own;
    own_device_open(&own, 0);
    struct ag_device_adopt adopt = fixture_lend(&own);
    struct renderer_fixture s = fixture_open("lpv", &adopt);
    int before = own.locks;
    for (int i = 0; i < 2; i++) {
        uint64_t number = 0;
        VkCommandBuffer commands = own_device_begin(&own);
        assert_int_equal(ag_renderer_record(s.renderer, &s.frame, NULL, &number),
                         AG_ERROR_ARGUMENT);
        assert_int_equal(ag_renderer_record(s.renderer, &s.frame, commands, &number), AG_OK);
        // Calls that would wait are refused until the frame is reported done.
        struct ag_image *image = NULL;
        assert_int_equal(ag_renderer_read(s.renderer, "color", &image), AG_ERROR_ARGUMENT);
        assert_int_equal(ag_renderer_render(s.renderer, &s.frame), AG_ERROR_ARGUMENT);
        assert_int_equal(ag_renderer_recorded_done(s.renderer, 7), AG_ERROR_ARGUMENT);
        own_device_run(&own, commands);
        assert_int_equal(ag_renderer_recorded_done(s.renderer, number), AG_OK);
    }
    assert_int_equal(own.locks, before); // the program submitted
    struct ag_image *color = fixture_read(&s, "color");
    CHECK(equal(color, expected));
    ag_image_destroy(s.context, color);
    fixture_close(&s);
    own_device_close(&own);
}

TEST(an_adopted_device_needs_all_its_handles)
{
    struct ag_context *context = fixture_context();
    struct ag_device *device = NULL;
    struct ag_device_adopt adopt = { .instance = context };
    struct ag_device_desc desc;
    ag_device_desc_default(&desc);
    desc.adopt = &adopt;
    assert_int_equal(ag_device_create(context, &desc, &device), AG_ERROR_ARGUMENT);
    assert_null(device);
    CHECK(strstr(ag_device_required_features(), "VK_KHR_push_descriptor"));
    ag_context_destroy(context);
}

TEST(an_unknown_device_is_refused)
{
    test_gpu_require();
    struct ag_context *context = fixture_context();
    struct ag_device *device = NULL;
    struct ag_device_desc desc;
    ag_device_desc_default(&desc);
    desc.device = "no such device";
    CHECK(ag_device_create(context, &desc, &device) != AG_OK);
    assert_null(device);
    CHECK(strstr(ag_context_last_error(context), "no such device"));
    ag_context_destroy(context);
}

TEST(a_scene_lit_only_by_emission_causes_a_warning_without_a_technique_for_it)
{
    static const struct {
        const char *scene, *gi;
        bool warns;
    } cases[] = { { "@cornell", "none", true },
                  { "@cornell", "lpv", false },
                  { "@cornell", "ambient", false },
                  { "@cornell:light=point", "none", false } };
    struct renderer_fixture s = fixture_open("none", NULL);
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct ag_scene *scene = NULL;
        struct ag_renderer *renderer = NULL;
        struct ag_renderer_desc desc = fixture_renderer_desc(cases[i].gi);
        assert_int_equal(ag_scene_load(s.context, cases[i].scene, &scene), AG_OK);
        fixture_last_warning[0] = '\0';
        assert_int_equal(ag_renderer_create(s.device, scene, &desc, &renderer), AG_OK);
        CHECK_STRING(fixture_last_warning,
                     cases[i].warns ? "@cornell: only emissive surfaces light the scene and --gi "
                                      "none ignores their light; try --gi lpv"
                                    : "");
        ag_renderer_destroy(renderer);
        ag_scene_destroy(scene);
    }
    fixture_close(&s);
}
