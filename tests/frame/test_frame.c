// The whole frame: composite, exposure, sizes, change flags, refused requests.
#include "frame/frame_fixture.h"

#include "image/png_file.h"
#include "image/exposure.h"
#include "image/tonemap.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double PI = 3.14159265358979323846;

static void begin(struct frame_fixture *s, struct gpu *gpu)
{
    fixture_init(s, gpu);
    int matte = fixture_matte(s, vec3_of(0.6f, 0.5f, 0.4f));
    fixture_floor(s, 4, matte);
    fixture_quad(s, vec3_of(-0.5f, 0.5f, 0.5f), vec3_of(0.5f, 0.5f, 0.5f),
                 vec3_of(0.5f, 0.5f, -0.5f), vec3_of(-0.5f, 0.5f, -0.5f), matte);
    fixture_add_sun(s, vec3_of(0.4f, -1, 0.2f), vec3_of(1000, 900, 800));
    fixture_add_point(s, vec3_of(-1, 1, 0), vec3_of(100, 200, 300));
    fixture_look(s, vec3_of(0, 2, 3), vec3_of(0, 0, 0));
    s->input.want_display = true;
    s->input.auto_exposure = true;
}

// A technique that fills each layer with a constant.
struct constant_layers {
    float irradiance, specular, visibility;
    bool view_is_complete;
};

static void fill(void *user, struct gpu_cmd *cmd, const struct frame_view *view)
{
    struct constant_layers *f = user;
    float e = f->irradiance * view->constants->radiance_scale;
    float l = f->specular * view->constants->radiance_scale;
    gpu_clear_image(cmd, view->layers[FRAME_IRRADIANCE], (float[4]){ e, e, e, 1 });
    gpu_clear_image(cmd, view->layers[FRAME_SPECULAR], (float[4]){ l, l, l, 1 });
    gpu_clear_image(cmd, view->layers[FRAME_VISIBILITY], (float[4]){ f->visibility });
    f->view_is_complete = view->width == 32 && view->light_count == 2 && view->pose &&
                          view->constants_binding.buffer.id && view->lights_binding.buffer.id &&
                          view->layers[FRAME_DIRECT].id && !box3_is_empty(view->bounds);
}

TEST_GPU(composite_is_the_sum_of_the_layers)
{
    struct frame_fixture s;
    begin(&s, gpu);
    struct constant_layers f = { .irradiance = 500, .specular = 20, .visibility = 0.5f };
    s.indirect = (struct frame_indirect){ .record = fill,
                                          .user = &f,
                                          .needs = FRAME_WRITES_IRRADIANCE | FRAME_WRITES_SPECULAR |
                                                   FRAME_WRITES_VISIBILITY };
    s.input.want_indirect_layer = true;
    fixture_open(&s);
    fixture_render(&s);
    CHECK(f.view_is_complete);
    float *color = fixture_read(&s, READ_COLOR), *direct = fixture_read(&s, READ_DIRECT);
    float *indirect = fixture_read(&s, READ_INDIRECT), *albedo = fixture_read(&s, READ_ALBEDO);
    float *depth = fixture_read(&s, READ_DEPTH),
          visibility = fixture_pixel(&s, READ_VISIBILITY, 1, 1).x;
    CHECK_NEAR(visibility, 0.5, 0.003);
    for (size_t i = 0; i < 32 * 32 * 3; i++) {
        double expected = (double)albedo[i] / PI * 500 * (double)visibility + 20;
        if (depth[i / 3] == 0) expected = 0;
        CHECK_RELATIVE(indirect[i], expected, 2e-3);
        CHECK_RELATIVE(color[i], (double)direct[i] + (double)indirect[i], 2e-3);
    }
    free(color), free(direct), free(indirect), free(albedo), free(depth);
    fixture_finish(&s);
}

TEST_GPU(without_a_technique_the_image_is_direct_light)
{
    struct frame_fixture s;
    begin(&s, gpu);
    fixture_open(&s);
    fixture_render(&s);
    float *color = fixture_read(&s, READ_COLOR), *direct = fixture_read(&s, READ_DIRECT);
    CHECK(memcmp(color, direct, 32 * 32 * 3 * sizeof *color) == 0);
    CHECK(fixture_pixel(&s, READ_VISIBILITY, 3, 3).x == 1);
    CHECK(fixture_pixel(&s, READ_IRRADIANCE, 3, 3).x == 0);
    free(color), free(direct);
    fixture_finish(&s);
}

// The EV that the CPU finds in the color layer.
static float cpu_exposure(struct frame_fixture *s, enum exposure_metering metering)
{
    float *color = fixture_read(s, READ_COLOR), *depth = fixture_read(s, READ_DEPTH);
    struct image image;
    assert_true(image_init(&image, test_host(), (int)s->width, (int)s->height, 4));
    for (size_t p = 0; p < (size_t)s->width * s->height; p++) {
        memcpy(image.pixels + 4 * p, color + 3 * p, 3 * sizeof *color);
        image.pixels[4 * p + 3] = depth[p] > 0 ? 1 : 0;
    }
    float ev = auto_exposure(&image, metering);
    image_finish(&image, test_host());
    free(color), free(depth);
    return ev;
}

TEST_GPU(exposure_equals_the_cpus)
{
    struct constant_layers f = { .irradiance = 500, .specular = 20, .visibility = 0.5f };
    for (int i = 0; i < 4; i++) {
        struct frame_fixture s;
        begin(&s, gpu);
        s.width = i == 0 ? 32 : i == 1 ? 131 : 640;
        s.height = i == 0 ? 32 : i == 1 ? 77 : 360;
        if (i == 3)
            s.indirect =
                (struct frame_indirect){ .record = fill,
                                         .user = &f,
                                         .needs = FRAME_WRITES_IRRADIANCE | FRAME_WRITES_SPECULAR |
                                                  FRAME_WRITES_VISIBILITY };
        fixture_look(&s, vec3_of(0, 1, 3), vec3_of(0, 1, 0)); // half of the image is background
        fixture_open(&s);
        fixture_render(&s);
        float ev;
        assert_true(frame_exposure(s.frame, &ev));
        // the layer is of half floats
        CHECK_NEAR(ev, cpu_exposure(&s, METERING_MEAN), i == 3 ? 2e-3 : 1e-4);
        fixture_finish(&s);
    }
}

// A floor and, close above a tenth of the visible part, a light: the rules differ.
TEST_GPU(exposure_for_highlights_equals_the_cpus)
{
    struct frame_fixture s;
    begin(&s, gpu);
    s.width = 131, s.height = 77;
    s.options.metering = METERING_HIGHLIGHTS;
    s.input.light_count = 0;
    fixture_add_point(&s, vec3_of(0.3f, 0.1f, 0), vec3_of(100, 100, 100));
    fixture_look(&s, vec3_of(0, 2, 0.1f), vec3_of(0, 0, 0));
    fixture_open(&s);
    fixture_render(&s);
    float ev;
    assert_true(frame_exposure(s.frame, &ev));
    CHECK_NEAR(ev, cpu_exposure(&s, METERING_HIGHLIGHTS), 1e-4);
    CHECK(ev > cpu_exposure(&s, METERING_MEAN) + 0.5f);
    fixture_finish(&s);
}

// Without punctual lights only the technique lights the image.
TEST_GPU(light_of_a_technique_alone_is_exposed_to_middle_grey)
{
    unsigned char *shown[2];
    float ev[2];
    for (int i = 0; i < 2; i++) {
        struct frame_fixture s;
        begin(&s, gpu);
        s.input.light_count = 0;
        struct constant_layers f = { .irradiance = i ? 1400 : 700, .visibility = 1 };
        s.indirect =
            (struct frame_indirect){ .record = fill,
                                     .user = &f,
                                     .needs = FRAME_WRITES_IRRADIANCE | FRAME_WRITES_SPECULAR |
                                              FRAME_WRITES_VISIBILITY };
        fixture_open(&s);
        fixture_render(&s);
        assert_true(frame_exposure(s.frame, &ev[i]));
        vec3s color = fixture_pixel(&s, READ_COLOR, 16, 16);
        CHECK_RELATIVE(luminance(color) * exposure_scale(ev[i]), 0.18, 0.02);
        float *display = fixture_read(&s, READ_DISPLAY);
        shown[i] = malloc(32 * 32 * 3);
        for (size_t k = 0; k < 32 * 32 * 3; k++)
            shown[i][k] = (unsigned char)lrintf(255 * srgb_encode(display[k]));
        free(display);
        fixture_finish(&s);
    }
    CHECK(ev[1] == ev[0] + 1);
    CHECK(memcmp(shown[0], shown[1], 32 * 32 * 3) == 0);
    free(shown[0]), free(shown[1]);
}

// If no visible surface is lit, exposure follows from the lights' intensity.
TEST_GPU(exposure_of_surfaces_in_shadow_follows_the_lights)
{
    float ev[3];
    for (int i = 0; i < 3; i++) {
        struct frame_fixture s;
        begin(&s, gpu);
        s.input.light_count = 0;
        fixture_add_sun(&s, vec3_of(0, 1, 0), vec3_of(1000 * (i == 1 ? 2 : 1), 0, 0)); // from below
        if (i == 2) s.input.environment.sky = vec3_of(50, 50, 50);
        fixture_look(&s, vec3_of(0, 2, 0.5f), vec3_of(0, 0, 0));
        fixture_open(&s);
        fixture_render(&s);
        CHECK(fixture_pixel(&s, READ_DIRECT, 16, 16).x == 0);
        assert_true(frame_exposure(s.frame, &ev[i]));
        fixture_finish(&s);
    }
    CHECK_NEAR(ev[0], log2(0.02 * 0.5 / PI * 1000 / (1.2 * 0.18)), 1e-3);
    CHECK_NEAR(ev[1], (double)ev[0] + 1, 1e-4);
    CHECK_NEAR(ev[2], log2(50 / (1.2 * 0.18)), 1e-3);
}

TEST_GPU(exposure_of_a_dark_frame_is_zero_and_a_fixed_one_is_kept)
{
    struct frame_fixture s;
    begin(&s, gpu);
    s.input.light_count = 0;
    fixture_open(&s);
    fixture_render(&s);
    float ev = 7;
    CHECK(frame_exposure(s.frame, &ev) && ev == 0);
    s.input.auto_exposure = false;
    s.input.exposure_ev = 3.25f;
    fixture_render(&s);
    CHECK(frame_exposure(s.frame, &ev) && ev == 3.25f);
    fixture_finish(&s);
}

TEST_GPU(display_is_the_tone_mapped_color)
{
    struct frame_fixture s;
    begin(&s, gpu);
    fixture_open(&s);
    fixture_render(&s);
    float *color = fixture_read(&s, READ_COLOR), *display = fixture_read(&s, READ_DISPLAY), ev;
    assert_true(frame_exposure(s.frame, &ev));
    for (size_t i = 0; i < 32 * 32; i++) {
        vec3s exposed = glms_vec3_scale(vec3_of(color[3 * i], color[3 * i + 1], color[3 * i + 2]),
                                        exposure_scale(ev));
        vec3s shown = tonemap_pbr_neutral(exposed);
        for (size_t k = 0; k < 3; k++)
            CHECK_NEAR(srgb_encode(display[3 * i + k]), srgb_encode(fminf(shown.raw[k], 1)),
                       0.6 / 255);
    }
    free(color), free(display);
    fixture_finish(&s);
}

TEST_GPU(frames_of_a_static_scene_are_equal)
{
    struct frame_fixture s;
    begin(&s, gpu);
    fixture_open(&s);
    fixture_render(&s);
    float *first = fixture_read(&s, READ_COLOR);
    fixture_render(&s);
    float *second = fixture_read(&s, READ_COLOR);
    CHECK(memcmp(first, second, 32 * 32 * 3 * sizeof *first) == 0);
    free(first), free(second);
    fixture_finish(&s);
}

TEST_GPU(every_size_renders)
{
    static const uint32_t sizes[][2] = { { 1, 1 }, { 7, 3 }, { 9, 17 }, { 1, 40 }, { 64, 8 } };
    struct frame_fixture s;
    begin(&s, gpu);
    s.indirect.needs = FRAME_NEEDS_MOTION | FRAME_NEEDS_RSM;
    fixture_open(&s);
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        fixture_look(&s, vec3_of(0, 2, 3), vec3_of(0, 0.5f, 0));
        fixture_resize(&s, sizes[i][0], sizes[i][1]);
        fixture_render(&s);
        float *color = fixture_read(&s, READ_COLOR), *display = fixture_read(&s, READ_DISPLAY);
        float *motion = fixture_read(&s, READ_MOTION);
        for (size_t p = 0; p < (size_t)s.width * s.height * 3; p++)
            CHECK(isfinite(color[p]) && isfinite(display[p]) && isfinite(motion[p]));
        // The image centre shows the quad at every size.
        CHECK(color[3 * ((s.height / 2) * s.width + s.width / 2)] > 0);
        free(color), free(display), free(motion);
    }
    fixture_finish(&s);
}

struct changes {
    bool cut, moved, lights;
    float ratio;
    uint64_t index, light;
};

static void store_changes(void *user, struct gpu_cmd *cmd, const struct frame_view *view)
{
    (void)cmd;
    *(struct changes *)user =
        (struct changes){ view->camera_cut,     view->geometry_moved,
                          view->lights_changed, view->constants->previous_scale_ratio,
                          view->index,          view->light_hash };
}

TEST_GPU(changes_are_reported_once)
{
    struct frame_fixture s;
    begin(&s, gpu);
    struct changes c;
    s.indirect = (struct frame_indirect){ .record = store_changes, .user = &c, .needs = 0 };
    fixture_open(&s);
    fixture_render(&s);
    CHECK(c.cut && c.moved && c.lights && c.index == 0 && c.ratio == 1);
    fixture_render(&s);
    CHECK(!c.cut && !c.moved && !c.lights && c.index == 1 && c.ratio == 1);
    s.lights[0].intensity = glms_vec3_scale(s.lights[0].intensity, 8);
    s.lights[1].intensity = glms_vec3_scale(s.lights[1].intensity, 8);
    fixture_render(&s);
    CHECK(!c.cut && !c.moved && c.lights && c.ratio == 0.125f);
    s.pose.world_from_node[s.scene->instances[1].node].raw[3][1] += 0.1f;
    fixture_render(&s);
    CHECK(!c.cut && c.moved && !c.lights && c.ratio == 1);
    s.input.camera_cut = true;
    fixture_render(&s);
    CHECK(c.cut && !c.moved && !c.lights);
    fixture_finish(&s);
}

// A delta that takes over dynamic objects changes the light of the source without them.
TEST_GPU(objects_that_a_delta_takes_over_have_moved)
{
    struct frame_fixture s;
    begin(&s, gpu);
    struct changes c;
    s.scene->instances[1].movable = true;
    s.indirect = (struct frame_indirect){ .record = store_changes, .user = &c, .needs = 0 };
    fixture_open(&s);
    for (int i = 0; i < 6; i++) {
        s.indirect.needs = i / 2 % 2 ? FRAME_LEAVES_DYNAMIC : 0;
        fixture_render(&s);
        CHECK(c.moved == (i % 2 == 0) && c.lights == (i == 0));
    }
    fixture_finish(&s);
}

TEST_GPU(the_hash_of_light_is_of_lights_sky_and_shadow_filter)
{
    struct frame_fixture s;
    begin(&s, gpu);
    struct changes c;
    uint64_t seen[5];
    s.indirect = (struct frame_indirect){ .record = store_changes, .user = &c, .needs = 0 };
    fixture_open(&s);
    for (int i = 0; i < 5; i++) {
        if (i == 2) s.lights[1].position.x += 0.1f;
        if (i == 3) s.input.environment.sky.y = 1;
        s.options.shadow_filter = i == 4 ? 1 : 0;
        assert_true(frame_set_options(s.frame, &s.options));
        fixture_look(&s, vec3_of((float)i, 2, 3), vec3_of(0, 0, 0)); // not of the camera
        fixture_render(&s);
        seen[i] = c.light;
    }
    for (int i = 0; i < 5; i++)
        for (int k = 0; k < i; k++) CHECK((seen[i] == seen[k]) == (i == 1));
    fixture_finish(&s);
}

TEST_GPU(wrong_requests_are_refused_with_a_reason)
{
    struct frame_fixture s;
    begin(&s, gpu);
    struct frame *bare = frame_create(test_host(), gpu, &s.options);
    assert_non_null(bare);
    CHECK(!frame_prepare(bare, &s.input, NULL));
    CHECK_STRING(test_last_message(), "frame: no scene was set");
    frame_destroy(bare);
    fixture_open(&s);
    CHECK(!frame_resize(s.frame, 0, 8) && !frame_resize(s.frame, 8, 16385));
    float pixel[3 * 32 * 32];
    CHECK(!frame_read(s.frame, READ_COLOR, pixel, 3)); // nothing rendered yet
    s.input.light_count = FRAME_MAX_LIGHTS + 1;
    CHECK(!frame_prepare(s.frame, &s.input, NULL));
    s.input.light_count = 1;
    fixture_render(&s);
    CHECK(!frame_read(s.frame, READ_COLOR, pixel, 4));
    CHECK(!frame_read(s.frame, READ_MOTION, pixel, 3));
    CHECK_STRING(test_last_message(), "frame layer motion: it was not requested");
    frame_destroy(NULL);
    fixture_finish(&s);
}

TEST_GPU(memory_estimate_is_a_frames_memory)
{
    struct frame_fixture s;
    begin(&s, gpu);
    s.indirect.needs = FRAME_NEEDS_MOTION | FRAME_NEEDS_RSM;
    s.input.light_count = 1; // the sun
    fixture_open(&s);
    fixture_resize(&s, 256, 128); // the software driver pads rows to 64 bytes: nothing here
    fixture_render(&s);
    struct gpu_memory memory[16];
    int count = gpu_memory_by_owner(gpu, memory, 16);
    uint64_t taken = 0;
    for (int i = 0; i < count; i++)
        if (strcmp(memory[i].owner, "frame") == 0) taken = memory[i].bytes;
    // The light may be a point light, whose reflective shadow map has six faces. A sun's has one.
    const uint64_t without =
                       frame_memory_estimate(&s.options, &s.input, FRAME_NEEDS_MOTION, 256, 128),
                   with = frame_memory_estimate(&s.options, &s.input, s.indirect.needs, 256, 128);
    CHECK(with > without);
    CHECK_RELATIVE(taken, without + (with - without) / 6, 0.01);
    fixture_finish(&s);
}
