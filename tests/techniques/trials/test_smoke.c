// Every technique in the full frame: creation to destruction, with every option at both ends.
#include "frame/frame_fixture.h"
#include "techniques/gi_baked.h"
#include "techniques/gi_fixture.h"
#include "techniques/registry.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// A room with a polished floor, a box, a sun and a point light.
static void room(struct frame_fixture *s, struct gpu *gpu)
{
    struct material polished = material_default();
    polished.metallic = 0;
    polished.roughness = 0.1f;
    fixture_init(s, gpu);
    const int matte = fixture_matte(s, vec3_of(0.7f, 0.6f, 0.5f));
    fixture_floor(s, 3, fixture_material(s, &polished));
    fixture_box(s, vec3_of(-0.5f, 0, -0.5f), vec3_of(0.5f, 1, 0.5f), false, matte);
    fixture_quad(s, vec3_of(-3, 0, -3), vec3_of(3, 0, -3), vec3_of(3, 3, -3), vec3_of(-3, 3, -3),
                 matte);
    fixture_add_sun(s, vec3_of(0.3f, -1, -0.4f), vec3_of(20000, 18000, 15000));
    fixture_add_point(s, vec3_of(1, 2, 1), vec3_of(50, 300, 100));
    fixture_look(s, vec3_of(1, 2, 4), vec3_of(0, 0.5f, 0));
    s->input.environment.sky = vec3_of(10, 20, 30);
    fixture_open(s);
}

static void finite_frames(struct frame_fixture *s, int count)
{
    for (int i = 0; i < count; i++) fixture_render(s);
    float *e = fixture_read(s, READ_IRRADIANCE);
    for (size_t i = 0; i < (size_t)s->width * s->height * 3; i++)
        CHECK(isfinite(e[i]) && e[i] >= 0.0f);
    free(e);
    float *v = fixture_read(s, READ_VISIBILITY);
    for (size_t i = 0; i < (size_t)s->width * s->height; i++) CHECK(v[i] >= 0.0f && v[i] <= 1.0f);
    free(v);
    float *r = fixture_read(s, READ_SPECULAR);
    for (size_t i = 0; i < (size_t)s->width * s->height * 3; i++)
        CHECK(isfinite(r[i]) && r[i] >= 0.0f);
    free(r);
}

// A technique with more options; at its lowest quality, if it has one: bakes take a part of the
// time.
static void print_spec(const struct technique *technique, const char *more, char *text, size_t size)
{
    const char *quality = technique->presets ? ":quality=low" : "";
    snprintf(text, size, "%s%s%s%s", technique->name, quality,
             !more[0]             ? ""
             : technique->presets ? ","
                                  : ":",
             more);
}

TEST_GPU(techniques_survive_frames_resizes_and_debug_views)
{
    struct frame_fixture s;
    room(&s, gpu);
    for (size_t i = 0; techniques[i]; i++) {
        char text[64];
        const bool probes = techniques[i]->capabilities & PUBLISHES_PROBES; // has a debug view
        print_spec(techniques[i], probes ? "probes=true" : "", text, sizeof text);
        struct gi *gi = gi_fixture_light_small(&s, text);
        finite_frames(&s, 3);
        CHECK(gi_resize(gi, 45, 27));
        fixture_resize(&s, 45, 27);
        gi_invalidate(gi, CHANGED_GEOMETRY | CHANGED_LIGHT | CHANGED_CAMERA);
        finite_frames(&s, 1);
        const struct technique_debug_view *view = techniques[i]->debug_views;
        for (; view && view->name; view++) {
            CHECK(gi_set_debug_view(gi, view->name));
            finite_frames(&s, 1);
            float rgb[45 * 27 * 3];
            CHECK(gpu_image_download_float(gpu, gi_debug_image(gi), 0, 0, rgb, 3, 45 * 27 * 3));
            float most = 0.0f;
            for (int k = 0; k < 45 * 27 * 3; k++) {
                CHECK(isfinite(rgb[k]));
                most = fmaxf(most, rgb[k]);
            }
            CHECK(most > 0.0f);
        }
        CHECK(!gi_set_debug_view(gi, "nonesuch"));
        CHECK(strstr(test_last_message(), "nonesuch"));
        CHECK(gi_set_debug_view(gi, NULL));
        CHECK(gi_debug_image(gi).id == 0);
        CHECK(gi_resize(gi, 32, 32));
        fixture_resize(&s, 32, 32);
        gi_destroy(gi);
    }
    fixture_finish(&s);
}

// "technique:option=value" with the smallest or the largest value.
static void print_end(const struct technique *technique, const struct option_row *row, bool largest,
                      char *text, size_t size)
{
    struct gi_spec spec;
    CHECK(gi_spec_parse(&spec, test_host(), technique->name));
    char value[OPTION_VALUE_SIZE];
    void *options = spec.options[spec.count - 1]; // a default source may precede it
    const double end = largest ? row->max : row->min;
    if (row->type == OPTION_TYPE_float32)
        *(float *)((char *)options + row->offset) = (float)end;
    else if (row->type == OPTION_TYPE_bool8)
        *(bool *)((char *)options + row->offset) = largest;
    else
        *(int32_t *)((char *)options + row->offset) = (int32_t)end;
    option_print(row, options, value, sizeof value);
    char more[OPTION_VALUE_SIZE + 64];
    snprintf(more, sizeof more, "%s=%s", row->name, value);
    print_spec(technique, more, text, size);
    gi_spec_finish(&spec);
}

// Live options change in `running`; others create a new stack.
static void run_with(struct frame_fixture *s, struct gi *running, const char *text)
{
    struct gi_spec spec;
    gi_fixture_parse(&spec, text);
    const bool live = gi_set_options(running, &spec);
    gi_spec_finish(&spec);
    struct gi *gi = live ? running : gi_fixture_light_small(s, text);
    s->indirect = gi_hook(gi);
    finite_frames(s, 1);
    if (!live) gi_destroy(gi);
}

TEST_GPU(techniques_run_with_every_option_at_both_ends)
{
    struct frame_fixture s;
    room(&s, gpu);
    for (size_t i = 0; techniques[i]; i++) {
        char text[OPTION_VALUE_SIZE + 128];
        print_spec(techniques[i], "", text, sizeof text);
        struct gi *running = gi_fixture_light_small(&s, text);
        for (size_t k = 0; k < techniques[i]->options.count; k++)
            for (int end = 0; end < 2; end++) {
                // The largest bakes take hours. Texts have no ends.
                if (techniques[i]->options.rows[k].effect == REBAKE ||
                    techniques[i]->options.rows[k].type == OPTION_TYPE_text)
                    continue;
                print_end(techniques[i], &techniques[i]->options.rows[k], end != 0, text,
                          sizeof text);
                run_with(&s, running, text);
            }
        gi_destroy(running);
    }
    fixture_finish(&s);
}

TEST_GPU(techniques_survive_empty_scenes)
{
    struct frame_fixture s;
    fixture_init(&s, gpu);
    fixture_add_sun(&s, vec3_of(0, -1, 0), vec3_of(1, 1, 1));
    fixture_open(&s);
    for (size_t i = 0; techniques[i]; i++) {
        struct gi *gi = gi_fixture_light_small(&s, techniques[i]->name);
        finite_frames(&s, 2);
        gi_destroy(gi);
    }
    fixture_finish(&s);
}

// Bytes of a spec's techniques: those of visibility and reflection alone stand on another.
static uint64_t memory_of(struct gpu *gpu, const struct gi_spec *spec)
{
    struct gpu_memory owners[32];
    uint64_t taken = 0;
    const int count = gpu_memory_by_owner(gpu, owners, 32);
    for (int k = 0; k < count && k < 32; k++)
        for (int t = 0; t < spec->count; t++)
            if (strcmp(owners[k].owner, spec->technique[t]->name) == 0) taken += owners[k].bytes;
    return taken;
}

TEST_GPU(techniques_estimate_their_memory)
{
    struct frame_fixture s;
    room(&s, gpu);
    for (size_t i = 0; techniques[i]; i++) {
        struct gi_spec spec;
        gi_fixture_parse(&spec, techniques[i]->name);
        const uint64_t estimate = gi_memory_estimate(&spec, s.width, s.height);
        struct gi *gi = gi_fixture_light_small(&s, techniques[i]->name);
        const uint64_t taken = memory_of(gpu, &spec);
        gi_spec_finish(&spec);
        print_message("%s: %llu bytes estimated, %llu allocated\n", techniques[i]->name,
                      (unsigned long long)estimate, (unsigned long long)taken);
        // The device may round up each object. What is loaded of a bake depends on the scene.
        if (techniques[i]->bake_version == 0)
            CHECK(taken >= estimate && (double)taken <= 1.02 * (double)estimate + 4096);
        else
            CHECK(taken >= estimate / 2 && taken <= 4 * estimate);
        gi_destroy(gi);
    }
    fixture_finish(&s);
}

TEST_GPU(gi_changes_live_options_in_place_and_refuses_others)
{
    struct frame_fixture s;
    room(&s, gpu);
    struct gi *gi = gi_fixture_light_small(&s, "ambient");
    fixture_render(&s);
    const float before = fixture_pixel(&s, READ_IRRADIANCE, 16, 20).y;
    struct gi_spec spec;
    CHECK(gi_spec_parse(&spec, test_host(), "ambient:strength=2"));
    CHECK(gi_set_options(gi, &spec));
    gi_spec_finish(&spec);
    fixture_render(&s);
    CHECK(before > 0.0f);
    CHECK_RELATIVE((double)fixture_pixel(&s, READ_IRRADIANCE, 16, 20).y, 2.0 * (double)before,
                   1e-3);
    CHECK(gi_spec_parse(&spec, test_host(), "lpv"));
    CHECK(!gi_set_options(gi, &spec));
    gi_spec_finish(&spec);
    gi_destroy(gi);

    gi = gi_fixture_light_small(&s, "lpv:dim=16");
    CHECK(gi_spec_parse(&spec, test_host(), "lpv:dim=16,steps=2,gain=3"));
    CHECK(gi_set_options(gi, &spec));
    gi_spec_finish(&spec);
    CHECK(gi_spec_parse(&spec, test_host(), "lpv:dim=24,steps=2,gain=3"));
    CHECK(!gi_set_options(gi, &spec));
    gi_spec_finish(&spec);
    gi_destroy(gi);
    fixture_finish(&s);
}

static bool fake_create(void *state, const struct technique_create *how)
{
    return state && how;
}

static void fake_record(void *state, struct gpu_cmd *cmd, const struct frame_view *view)
{
    (void)state, (void)cmd, (void)view;
}

static void fake_debug_view(void *state, struct gpu_cmd *cmd, const struct frame_view *view,
                            const char *name, gpu_image out)
{
    (void)state, (void)view;
    CHECK_STRING(name, "overflow");
    gpu_clear_image(cmd, out, (const float[4]){ 1, 1, 1, 1 });
}

static void fake_destroy(void *state)
{
    (void)state;
}

static const struct technique_debug_view fake_views[] = {
    { "overflow", "voxels that did not fit", "room" }, { NULL, NULL, NULL }
};
static const struct technique fake = { .name = "fake",
                                       .role = ROLE_SOURCE,
                                       .state_size = 1,
                                       .debug_views = fake_views,
                                       .create = fake_create,
                                       .record = fake_record,
                                       .debug_view = fake_debug_view,
                                       .destroy = fake_destroy };

TEST_GPU(gi_accepts_the_old_name_of_a_debug_view)
{
    struct frame_fixture s;
    room(&s, gpu);
    const struct gi_spec spec = {
        .host = test_host(), .count = 1, .technique = { &fake }, .options = { NULL }
    };
    struct gi *gi = gi_create(test_host(), gpu, &spec, &s.pose, s.width, s.height);
    assert_non_null(gi);
    s.indirect = gi_hook(gi);
    static const char *const names[] = { "room", "fake.room" };
    for (int i = 0; i < 2; i++) {
        CHECK(gi_set_debug_view(gi, names[i]));
        CHECK_STRING(test_last_message(), "fake: debug view room is now overflow; the old name "
                                          "will be removed in the next release");
        fixture_render(&s);
        test_forget_messages();
    }
    CHECK(gi_set_debug_view(gi, "overflow") && gi_set_debug_view(gi, "fake.overflow"));
    CHECK_STRING(test_last_message(), "");
    gi_destroy(gi);
    fixture_finish(&s);
}

TEST_GPU(lpv_refuses_a_dimension_that_does_not_fit_its_workgroups)
{
    struct frame_fixture s;
    room(&s, gpu);
    struct gi_spec spec;
    CHECK(gi_spec_parse(&spec, test_host(), "lpv:dim=20"));
    CHECK(gi_create(test_host(), gpu, &spec, &s.pose, 32, 32) == NULL);
    CHECK(strstr(test_last_message(), "dim=20 is not a multiple of 8"));
    gi_spec_finish(&spec);
    fixture_finish(&s);
}
