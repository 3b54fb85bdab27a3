// Several views of a renderer: each shows what a renderer with its camera alone shows, and the
// light is made once.
#include "api/view_fixture.h"

#include "techniques/registry.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

// Grids that follow the first camera have other cells where another one looks: a tolerance of
// irradiance, relative to its mean, for those options; else to the bit. Techniques without a row
// have their defaults.
static const struct {
    const char *technique, *options;
    double tolerance;
} variants[] = {
    { "lpv", ":dim=16,cascades=1", 0 },
    { "lpv", "", 0.005 },
    { "lpv", ":dim=16,cascades=1,geometry=maps", 0.1 }, // surfels of the first camera's view
    { "holpv", ":dim=16,cascades=1", 0 },
    { "holpv", ":dim=16,cascades=2", 0.005 },
    { "dnrt", "", 0.005 }, // on lpv
    { "vct", ":resolution=32", 0 },
    { "vct", ":resolution=32,specular=true,temporal=true", 0 },
    { "vct", ":resolution=32,half_resolution=true", 0 },
    { "vct", ":resolution=32,levels=2", 0.005 },
    { "vctao", ":resolution=32", 0 },
    { "vctao", ":resolution=32,temporal=true", 0 },
    { "vo", "", 0 },
    { "vo", ":temporal=true", 0 },
    { "vo", ":mode=areas", 0 },
};
static const int view_sizes[][2] = { { 40, 24 }, { FIXTURE_WIDTH, FIXTURE_HEIGHT }, { 72, 40 } };

enum { FIRST_OF_CAMERA = 6 };
static const char *const layers[] = { "irradiance", "specular", "visibility", "indirect", "color",
                                      "display",    "direct",   "depth",      "position", "normal",
                                      "albedo",     "emissive", "motion" };

// The layers of a view, or of a renderer's own camera if it is NULL, are those of another renderer.
static void check_layers(struct renderer_fixture *s, const char *what, struct ag_renderer *renderer,
                         struct ag_view *view, struct ag_renderer *alone, double tolerance)
{
    for (size_t i = 0; i < sizeof layers / sizeof *layers; i++) {
        struct ag_image *got = NULL, *expected = fixture_read_from(s, alone, layers[i]);
        const enum ag_result read = view ? ag_view_read(view, layers[i], &got)
                                         : ag_renderer_read(renderer, layers[i], &got);
        if (read != AG_OK) fail_msg("%s: %s", layers[i], ag_context_last_error(s->context));
        assert_int_equal(got->width, expected->width);
        const size_t bytes =
            sizeof *got->pixels * (size_t)got->width * (size_t)got->height * (size_t)got->channels;
        const bool equal = memcmp(got->pixels, expected->pixels, bytes) == 0;
        if (tolerance > 0 && strcmp(layers[i], "irradiance") == 0) {
            const double difference = fixture_difference(got, expected);
            if (getenv("VIEWS_PRINT")) printf("%s: %g\n", what, difference);
            if (!(difference <= tolerance)) fail_msg("%s: differs by %g", what, difference);
        } else if (!equal && (tolerance <= 0 || i >= FIRST_OF_CAMERA))
            fail_msg("%s: %s of the %s differs by %g", what, layers[i],
                     view ? "view" : "renderer's camera", fixture_difference(got, expected));
        ag_image_destroy(s->context, got);
        ag_image_destroy(s->context, expected);
    }
}

// A view that shares its other layers keeps color, display, and `asked`.
static void check_kept(struct renderer_fixture *s, const char *what, struct ag_view *view,
                       const char *asked, struct ag_renderer *alone, double tolerance)
{
    const char *const kept[] = { "color", "display", asked };
    for (size_t i = 0; i < sizeof kept / sizeof *kept; i++) {
        struct ag_image *got = NULL, *expected = fixture_read_from(s, alone, kept[i]);
        if (ag_view_read(view, kept[i], &got) != AG_OK)
            fail_msg("%s: %s", kept[i], ag_context_last_error(s->context));
        const double difference = fixture_difference(got, expected);
        if (difference > (tolerance > 0 ? 0.1 : 0.0))
            fail_msg("%s: %s of the view that shares memory differs by %g", what, kept[i],
                     difference);
        ag_image_destroy(s->context, got);
        ag_image_destroy(s->context, expected);
    }
}

// Three frames of two moving cameras, in one renderer and in two.
static void check_equal(struct renderer_fixture *s, const char *gi, const struct ag_bake *bake,
                        int width, int height, double tolerance)
{
    struct ag_renderer *both = view_make_renderer(s, gi, FIXTURE_WIDTH, FIXTURE_HEIGHT, bake);
    struct ag_renderer *first = view_make_renderer(s, gi, FIXTURE_WIDTH, FIXTURE_HEIGHT, bake);
    struct ag_renderer *second = view_make_renderer(s, gi, width, height, bake);
    struct ag_view *view = view_make(s, both, width, height);
    struct ag_view *lean = view_make_lean(s, both, width, height);
    struct ag_camera camera = s->frame.camera, other = view_other_camera(&camera);
    struct ag_layer_handle handle;
    const char *asked = strstr(gi, "ambient+") ? "visibility" : "irradiance";
    assert_int_equal(ag_view_layer_handle(lean, asked, &handle), AG_OK);
    for (int i = 0; i < 3; i++) {
        camera.eye[0] += 0.01f;
        other.eye[1] += 0.01f;
        const struct ag_view_frame further[] = { view_in_frame(view, &other),
                                                 view_in_frame(lean, &other) };
        view_render(s, both, &camera, further, 2);
        view_render(s, first, &camera, NULL, 0);
        view_render(s, second, &other, NULL, 0);
    }
    check_layers(s, gi, both, NULL, first, 0.0);
    check_layers(s, gi, both, view, second, tolerance);
    check_kept(s, gi, lean, asked, second, tolerance);
    float ev[2];
    assert_int_equal(ag_view_exposure(view, &ev[0]), AG_OK);
    assert_int_equal(ag_renderer_exposure(second, &ev[1]), AG_OK);
    CHECK(tolerance > 0 ? fabsf(ev[0] - ev[1]) < 0.1f : ev[0] == ev[1]);
    ag_view_destroy(view);
    ag_view_destroy(lean);
    ag_renderer_destroy(both);
    ag_renderer_destroy(first);
    ag_renderer_destroy(second);
}

TEST(each_view_equals_that_of_a_renderer_alone_to_the_bit)
{
    struct renderer_fixture s = fixture_open_lit("none");
    struct ag_technique_info info;
    for (int i = 0; ag_technique_get(i, &info); i++) {
        char base[FIXTURE_SPEC], longer[2 * FIXTURE_SPEC];
        fixture_print_base(i, &info, base);
        struct ag_bake *bake = fixture_bake(&s, base, &info);
        int checked = 0;
        for (size_t v = 0; v < sizeof variants / sizeof *variants; v++) {
            if (strcmp(variants[v].technique, info.name) != 0) continue;
            snprintf(longer, sizeof longer, "%s%s", base, variants[v].options);
            const int *size = view_sizes[checked++ % 3];
            check_equal(&s, longer, bake, size[0], size[1], variants[v].tolerance);
        }
        for (int k = 0; !checked && fixture_print_variant(i, &info, k, base); k++)
            check_equal(&s, base, bake, view_sizes[(i + k) % 3][0], view_sizes[(i + k) % 3][1],
                        0.0);
        ag_bake_destroy(bake);
    }
    fixture_close(&s);
}

// Passes of the frame, and of techniques: all where views share nothing; else those that look light
// up for pixels.
static bool is_of_view(const char *pass)
{
    static const char *const of_views[] = {
        "gbuffer",     "direct",      "exposure",     "composite", "ambient.fill", "ort.replace",
        "vct.edges",   "vct.cones",   "vct.gather",   "vct.blur",  "vct.temporal", "vct.denoise",
        "vctao.edges", "vctao.cones", "vctao.gather", "vctao.blur"
    };
    const char *dot = strchr(pass, '.');
    for (size_t i = 0; i < sizeof of_views / sizeof *of_views; i++)
        if (strcmp(pass, of_views[i]) == 0) return true;
    for (size_t i = 0; dot && techniques[i]; i++)
        if (!techniques[i]->update && strlen(techniques[i]->name) == (size_t)(dot - pass) &&
            strncmp(pass, techniques[i]->name, (size_t)(dot - pass)) == 0)
            return true;
    return dot && strcmp(dot, ".apply") == 0;
}

// Passes of the newest frame whose names are those of a view.
static int passes_of_view(struct ag_renderer *renderer)
{
    struct ag_timing timings[128];
    const int count = ag_renderer_timings(renderer, timings, 128);
    int found = 0;
    for (int i = 0; i < count; i++) found += is_of_view(timings[i].name);
    return found;
}

// Passes of a frame with some views.
static int passes(struct renderer_fixture *s, struct ag_renderer *renderer,
                  const struct ag_view_frame *views, int count)
{
    struct ag_device_counters before, after;
    ag_device_get_counters(s->device, &before);
    view_render(s, renderer, &s->frame.camera, views, count);
    ag_device_get_counters(s->device, &after);
    return (int)(after.passes - before.passes);
}

static uint64_t memory_of(struct ag_renderer *renderer)
{
    struct ag_memory owners[64];
    const int count = ag_renderer_memory(renderer, owners, 64);
    uint64_t bytes = 0;
    for (int i = 0; i < count; i++) bytes += owners[i].bytes;
    return bytes;
}

// keep_maps=false: the light is made in every frame.
static void check_shared(struct renderer_fixture *s, const char *gi, const struct ag_bake *bake)
{
    struct ag_renderer *renderer = view_make_renderer(s, gi, FIXTURE_WIDTH, FIXTURE_HEIGHT, bake);
    assert_int_equal(
        ag_renderer_set_frame_options(renderer, "shadow_size=256,rsm_size=64,keep_maps=false"),
        AG_OK);
    for (int i = 0; i < 3; i++) view_render(s, renderer, &s->frame.camera, NULL, 0);
    const int alone = passes(s, renderer, NULL, 0), of_view = passes_of_view(renderer);
    const uint64_t bytes = memory_of(renderer);
    struct ag_view *view = view_make(s, renderer, FIXTURE_WIDTH, FIXTURE_HEIGHT);
    const struct ag_camera other = view_other_camera(&s->frame.camera);
    const struct ag_view_frame further = view_in_frame(view, &other);
    for (int i = 0; i < 3; i++) view_render(s, renderer, &s->frame.camera, &further, 1);
    const int together = passes(s, renderer, &further, 1);
    const uint64_t both = memory_of(renderer);
    if (getenv("VIEWS_PRINT"))
        printf("%s: passes of light %d, of a view %d; %.2f and %.2f MB, ratio %.3f\n", gi,
               alone - of_view, of_view, (double)bytes * 1e-6, (double)both * 1e-6,
               (double)both / (double)bytes);
    CHECK(of_view >= 5 && alone > of_view);
    if (together != alone + of_view)
        fail_msg("%s: %d passes alone, %d of them of the view, %d with two", gi, alone, of_view,
                 together);
    CHECK((double)both < 1.4 * (double)bytes);
    ag_view_destroy(view);
    ag_renderer_destroy(renderer);
}

TEST(two_views_share_every_light_pass_and_cost_less_than_two_fifths_more_memory)
{
    struct renderer_fixture s = fixture_open_lit("none");
    struct ag_technique_info info;
    for (int i = 0; ag_technique_get(i, &info); i++) {
        char base[FIXTURE_SPEC];
        fixture_print_base(i, &info, base);
        struct ag_bake *bake = fixture_bake(&s, base, &info);
        check_shared(&s, base, bake);
        ag_bake_destroy(bake);
    }
    fixture_close(&s);
}

static double memory_ratio(struct renderer_fixture *s, const char *gi, bool all_layers)
{
    struct ag_view_desc desc;
    ag_view_desc_default(&desc);
    desc.width = 512;
    desc.height = 288;
    desc.all_layers = all_layers;
    struct ag_renderer *renderer = view_make_renderer(s, gi, desc.width, desc.height, NULL);
    assert_int_equal(ag_renderer_set_frame_options(renderer, "shadow_size=128,rsm_size=32"), AG_OK);
    view_render(s, renderer, &s->frame.camera, NULL, 0);
    const uint64_t one = memory_of(renderer);
    struct ag_view *view = view_create(s, renderer, &desc);
    const struct ag_view_frame further = view_in_frame(view, &s->frame.camera);
    view_render(s, renderer, &s->frame.camera, &further, 1);
    const uint64_t both = memory_of(renderer);
    if (getenv("VIEWS_PRINT"))
        printf("%-28s %7.2f MB, with a second view %7.2f MB: %.3f\n", gi, (double)one * 1e-6,
               (double)both * 1e-6, (double)both / (double)one);
    ag_view_destroy(view);
    ag_renderer_destroy(renderer);
    return (double)both / (double)one;
}

static void check_ratio(struct renderer_fixture *s, const char *gi)
{
    const double ratio = memory_ratio(s, gi, false);
    if (!(ratio < 1.4)) fail_msg("%s: %.3f", gi, ratio);
}

TEST(a_second_view_costs_less_than_two_fifths_of_a_renderer_where_images_dominate)
{
    static const char *const specs[] = { "none",
                                         "ambient",
                                         "lpv:dim=16,cascades=1",
                                         "lpv:dim=16,cascades=1,geometry=maps",
                                         "holpv:dim=8,cascades=1",
                                         "vct:resolution=32",
                                         "vct:resolution=32,temporal=true",
                                         "ambient+vo:temporal=true",
                                         "ambient+vo:mode=areas",
                                         "ambient+ssao:half_resolution=true",
                                         "ambient+vctao:resolution=32" };
    struct renderer_fixture s = fixture_open_lit(NULL);
    for (size_t i = 0; i < sizeof specs / sizeof *specs; i++) check_ratio(&s, specs[i]);
    for (size_t i = 0; techniques[i]; i++) {
        char gi[FIXTURE_SPEC];
        snprintf(gi, sizeof gi, "ambient+%s", techniques[i]->name);
        const bool screen = techniques[i]->role >= ROLE_VISIBILITY && !techniques[i]->update;
        if (screen) check_ratio(&s, gi);
    }
    CHECK(memory_ratio(&s, "none", true) > 1.7); // nothing shared
    fixture_close(&s);
}

// Compares memory with that of new renderers and views of both sizes, after frames of these sizes.
TEST(memory_follows_the_sizes_of_a_renderer_and_its_view)
{
    static const int sizes[][2] = { { 512, 288 }, { 128, 72 }, { 512, 288 } };
    struct renderer_fixture s = fixture_open_lit(NULL);
    struct ag_renderer *renderer = view_make_renderer(&s, "ambient+vo", 512, 288, NULL);
    struct ag_view *view = view_make_lean(&s, renderer, 512, 288);
    uint64_t bytes[3];
    for (int i = 0; i < 3; i++) {
        assert_int_equal(ag_renderer_resize(renderer, sizes[i][0], sizes[i][1]), AG_OK);
        assert_int_equal(ag_view_resize(view, sizes[i][0], sizes[i][1]), AG_OK);
        const struct ag_view_frame further = view_in_frame(view, &s.frame.camera);
        view_render(&s, renderer, &s.frame.camera, &further, 1);
        assert_int_equal(ag_renderer_wait(renderer), AG_OK);
        bytes[i] = memory_of(renderer);
    }
    CHECK(bytes[2] == bytes[0]);
    // 79 bytes per pixel: 66 of the renderer, 12 of the view
    CHECK(bytes[0] - bytes[1] > (uint64_t)70 * (512 * 288 - 128 * 72));
    ag_view_destroy(view);
    ag_renderer_destroy(renderer);
    fixture_close(&s);
}

TEST(a_layer_is_read_from_a_view_only_if_it_keeps_it)
{
    struct renderer_fixture s = fixture_open_lit("lpv:dim=16");
    struct ag_view *view = view_make_lean(&s, s.renderer, 40, 24);
    const struct ag_view_frame further = view_in_frame(view, &s.frame.camera);
    struct ag_layer_handle handle;
    struct ag_image *image = NULL;
    view_render(&s, s.renderer, &s.frame.camera, &further, 1);
    static const char *const shared[] = { "irradiance", "position", "normal", "direct" };
    for (size_t i = 0; i < sizeof shared / sizeof *shared; i++) {
        assert_int_equal(ag_view_read(view, shared[i], &image), AG_ERROR_ARGUMENT);
        CHECK(strstr(ag_context_last_error(s.context), "all_layers") != NULL);
    }
    // From the next frame on.
    assert_int_equal(ag_view_layer_handle(view, "depth", &handle), AG_OK);
    assert_int_equal(ag_view_read(view, "depth", &image), AG_ERROR_ARGUMENT);
    view_render(&s, s.renderer, &s.frame.camera, &further, 1);
    for (int i = 0; i < 2; i++) {
        assert_int_equal(ag_view_read(view, i ? "position" : "depth", &image), AG_OK);
        ag_image_destroy(s.context, image);
    }
    assert_int_equal(ag_view_read(view, "normal", &image), AG_ERROR_ARGUMENT);
    ag_view_destroy(view);
    fixture_close(&s);
}

TEST(views_come_and_go_are_left_out_and_follow_changes_of_the_spec)
{
    static const char *const specs[] = { "vct:resolution=32,temporal=true+vo:temporal=true",
                                         "lpv:dim=16+ssao", "lpv:dim=16+vo:samples=5", "none" };
    struct renderer_fixture s = fixture_open_lit("lpv:dim=16");
    const struct ag_camera other = view_other_camera(&s.frame.camera);
    struct ag_view *views[2] = { view_make(&s, s.renderer, 40, 24),
                                 view_make(&s, s.renderer, FIXTURE_WIDTH, FIXTURE_HEIGHT) };
    for (size_t i = 0; i < sizeof specs / sizeof *specs; i++) {
        assert_int_equal(ag_renderer_set_gi(s.renderer, specs[i], NULL, 0), AG_OK);
        const struct ag_view_frame all[2] = { view_in_frame(views[0], &other),
                                              view_in_frame(views[1], &s.frame.camera) };
        view_render(&s, s.renderer, &s.frame.camera, all, 2);
        view_render(&s, s.renderer, &s.frame.camera, NULL, 0);
        view_render(&s, s.renderer, &s.frame.camera, all + 1, 1);
        assert_int_equal(ag_view_resize(views[0], 20 + (int)i, 10), AG_OK);
        assert_int_equal(ag_renderer_resize(s.renderer, 30 + (int)i, 20), AG_OK);
        view_render(&s, s.renderer, &s.frame.camera, all, 2);
        ag_view_destroy(views[1]);
        views[1] = view_make(&s, s.renderer, 50, 30);
        // From the start: the same as a renderer alone.
        struct ag_renderer *alone = view_make_renderer(&s, specs[i], 50, 30, NULL);
        struct ag_frame_desc frame = s.frame;
        const struct ag_view_frame newest = view_in_frame(views[1], &other);
        frame.camera_cut = true;
        frame.views = &newest;
        frame.view_count = 1;
        assert_int_equal(ag_renderer_resize(s.renderer, 50, 30), AG_OK);
        assert_int_equal(ag_renderer_render(s.renderer, &frame), AG_OK);
        view_render(&s, alone, &other, NULL, 0);
        struct ag_image *got = NULL, *expected = fixture_read_from(&s, alone, "visibility");
        assert_int_equal(ag_view_read(views[1], "visibility", &got), AG_OK);
        CHECK(fixture_difference(got, expected) == 0.0);
        ag_image_destroy(s.context, got);
        ag_image_destroy(s.context, expected);
        ag_renderer_destroy(alone);
    }
    for (int i = 0; i < 2; i++) ag_view_destroy(views[i]);
    fixture_close(&s);
}

TEST(wrong_views_are_refused)
{
    struct renderer_fixture s = fixture_open_lit("none");
    struct ag_view *views[8] = { NULL };
    for (int i = 0; i < 7; i++) views[i] = view_make(&s, s.renderer, 8, 8);
    assert_int_equal(ag_view_create(s.renderer, NULL, &views[7]), AG_ERROR_ARGUMENT);
    assert_null(views[7]);
    for (int i = 1; i < 7; i++) ag_view_destroy(views[i]);
    struct ag_renderer *stranger = view_make_renderer(&s, "none", 8, 8, NULL);
    struct ag_view *strange = view_make(&s, stranger, 8, 8);
    struct ag_view_frame list[2] = { view_in_frame(views[0], &s.frame.camera),
                                     view_in_frame(views[0], &s.frame.camera) };
    struct ag_frame_desc frame = s.frame;
    frame.views = list;
    frame.view_count = 2;
    assert_int_equal(ag_renderer_render(s.renderer, &frame), AG_ERROR_ARGUMENT);
    frame.view_count = -1;
    assert_int_equal(ag_renderer_render(s.renderer, &frame), AG_ERROR_ARGUMENT);
    frame.view_count = 1;
    frame.views = NULL;
    assert_int_equal(ag_renderer_render(s.renderer, &frame), AG_ERROR_ARGUMENT);
    frame.views = list;
    list[0].view = strange;
    assert_int_equal(ag_renderer_render(s.renderer, &frame), AG_ERROR_ARGUMENT);
    list[0].view = NULL;
    assert_int_equal(ag_renderer_render(s.renderer, &frame), AG_ERROR_ARGUMENT);
    list[0] = view_in_frame(views[0], &s.frame.camera);
    list[0].reserved[1] = 1;
    assert_int_equal(ag_renderer_render(s.renderer, &frame), AG_ERROR_ARGUMENT);
    list[0].reserved[1] = 0;
    list[0].camera.near_m = -1;
    assert_int_equal(ag_renderer_render(s.renderer, &frame), AG_ERROR_ARGUMENT);
    struct ag_image *image = NULL;
    assert_int_equal(ag_view_read(views[0], "color", &image), AG_ERROR_ARGUMENT);
    list[0] = view_in_frame(views[0], &s.frame.camera);
    assert_int_equal(ag_renderer_render(s.renderer, &frame), AG_OK);
    assert_int_equal(ag_view_read(views[0], "debug", &image), AG_ERROR_ARGUMENT);
    ag_view_destroy(strange);
    ag_renderer_destroy(stranger);
    ag_view_destroy(views[0]);
    fixture_close(&s);
}
