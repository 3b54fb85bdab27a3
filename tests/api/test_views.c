// Several views of a renderer: each shows what a renderer with its camera alone shows, and the
// light is made once.
#include "api/renderer_fixture.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

// Grids that follow the first camera have other cells where another one looks: a tolerance of
// irradiance, relative to its mean, for those options; else to the bit.
static const struct {
    const char *technique, *options;
    double tolerance;
} variants[] = {
    { "none", "", 0 },
    { "ambient", "", 0 },
    { "lpv", ":dim=16,cascades=1", 0 },
    { "lpv", "", 0.005 },
    { "holpv", ":dim=16,cascades=1", 0 },
    { "holpv", ":dim=16,cascades=2", 0.005 },
    { "mrt", "", 0 },
    { "drt", "", 0 },
    { "vct", ":resolution=32", 0 },
    { "vct", ":resolution=32,specular=true,temporal=true", 0 },
    { "vct", ":resolution=32,half_resolution=true", 0 },
    { "vct", ":resolution=32,levels=2", 0.005 },
    { "vctao", ":resolution=32", 0 },
    { "vctao", ":resolution=32,temporal=true", 0 },
    { "vo", "", 0 },
    { "vo", ":temporal=true", 0 },
    { "vo", ":mode=areas", 0 },
    { "ssao", "", 0 },
    { "hbao", "", 0 },
};

// From the other side of the room.
static struct ag_camera other_camera(const struct ag_camera *camera)
{
    struct ag_camera other = *camera;
    for (int i = 0; i < 3; i++)
        other.eye[i] += 0.3f * (camera->target[i] - camera->eye[i]) + (i == 0 ? 0.4f : 0.1f);
    other.vertical_fov_rad *= 1.2f;
    return other;
}

static struct ag_renderer *make(struct renderer_fixture *s, const char *gi, int width, int height,
                                const struct ag_bake *bake)
{
    struct ag_renderer *renderer = NULL;
    struct ag_renderer_desc desc = fixture_renderer_desc(gi);
    desc.width = width;
    desc.height = height;
    desc.bakes = &bake;
    desc.bake_count = bake != NULL;
    if (ag_renderer_create(s->device, s->scene, &desc, &renderer) != AG_OK)
        fail_msg("%s: %s", gi, ag_context_last_error(s->context));
    return renderer;
}

static struct ag_view *make_view(struct renderer_fixture *s, struct ag_renderer *renderer,
                                 int width, int height)
{
    struct ag_view *view = NULL;
    struct ag_view_desc desc;
    ag_view_desc_default(&desc);
    desc.width = width;
    desc.height = height;
    desc.indirect_layer = desc.motion_layer = true;
    if (ag_view_create(renderer, &desc, &view) != AG_OK)
        fail_msg("%s", ag_context_last_error(s->context));
    return view;
}

static void render(struct renderer_fixture *s, struct ag_renderer *renderer,
                   const struct ag_camera *camera, const struct ag_view_frame *views, int count)
{
    struct ag_frame_desc frame = s->frame;
    frame.camera = *camera;
    frame.views = views;
    frame.view_count = count;
    if (ag_renderer_render(renderer, &frame) != AG_OK)
        fail_msg("%s: %s", ag_renderer_gi(renderer), ag_context_last_error(s->context));
}

static struct ag_view_frame in_frame(struct ag_view *view, const struct ag_camera *camera)
{
    struct ag_view_frame frame;
    ag_view_frame_default(&frame);
    frame.view = view;
    frame.camera = *camera;
    return frame;
}

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

// Three frames of two moving cameras, in one renderer and in two.
static void check_equal(struct renderer_fixture *s, const char *gi, const struct ag_bake *bake,
                        int width, int height, double tolerance)
{
    struct ag_renderer *both = make(s, gi, FIXTURE_WIDTH, FIXTURE_HEIGHT, bake);
    struct ag_renderer *first = make(s, gi, FIXTURE_WIDTH, FIXTURE_HEIGHT, bake);
    struct ag_renderer *second = make(s, gi, width, height, bake);
    struct ag_view *view = make_view(s, both, width, height);
    struct ag_camera camera = s->frame.camera, other = other_camera(&camera);
    for (int i = 0; i < 3; i++) {
        camera.eye[0] += 0.01f;
        other.eye[1] += 0.01f;
        const struct ag_view_frame further = in_frame(view, &other);
        render(s, both, &camera, &further, 1);
        render(s, first, &camera, NULL, 0);
        render(s, second, &other, NULL, 0);
    }
    check_layers(s, gi, both, NULL, first, 0.0);
    check_layers(s, gi, both, view, second, tolerance);
    float ev[2];
    assert_int_equal(ag_view_exposure(view, &ev[0]), AG_OK);
    assert_int_equal(ag_renderer_exposure(second, &ev[1]), AG_OK);
    CHECK(tolerance > 0 ? fabsf(ev[0] - ev[1]) < 0.1f : ev[0] == ev[1]);
    ag_view_destroy(view);
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
            const bool smaller = checked++ == 0;
            check_equal(&s, longer, bake, smaller ? 40 : FIXTURE_WIDTH,
                        smaller ? 24 : FIXTURE_HEIGHT, variants[v].tolerance);
        }
        if (!checked) fail_msg("%s is in no row of variants", info.name);
        ag_bake_destroy(bake);
    }
    fixture_close(&s);
}

// Frame passes, and those of techniques that look light up for pixels.
static bool is_of_view(const char *pass)
{
    static const char *const of_views[] = {
        "gbuffer",    "direct",      "exposure",    "composite",   "none.clear",   "ambient.fill",
        "lpv.apply",  "holpv.apply", "mrt.apply",   "drt.apply",   "vct.edges",    "vct.cones",
        "vct.gather", "vct.blur",    "vctao.edges", "vctao.cones", "vctao.gather", "vctao.blur"
    };
    for (size_t i = 0; i < sizeof of_views / sizeof *of_views; i++)
        if (strcmp(pass, of_views[i]) == 0) return true;
    return strncmp(pass, "vo.", 3) == 0 || strncmp(pass, "ssao.", 5) == 0 ||
           strncmp(pass, "hbao.", 5) == 0;
}

// Of the newest frame: those whose name says that they are of a view.
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
    render(s, renderer, &s->frame.camera, views, count);
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
    struct ag_renderer *renderer = make(s, gi, FIXTURE_WIDTH, FIXTURE_HEIGHT, bake);
    assert_int_equal(
        ag_renderer_set_frame_options(renderer, "shadow_size=256,rsm_size=64,keep_maps=false"),
        AG_OK);
    for (int i = 0; i < 3; i++) render(s, renderer, &s->frame.camera, NULL, 0);
    const int alone = passes(s, renderer, NULL, 0), of_view = passes_of_view(renderer);
    const uint64_t bytes = memory_of(renderer);
    struct ag_view *view = make_view(s, renderer, FIXTURE_WIDTH, FIXTURE_HEIGHT);
    const struct ag_camera other = other_camera(&s->frame.camera);
    const struct ag_view_frame further = in_frame(view, &other);
    for (int i = 0; i < 3; i++) render(s, renderer, &s->frame.camera, &further, 1);
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

TEST(views_come_and_go_are_left_out_and_follow_changes_of_the_spec)
{
    static const char *const specs[] = { "vct:resolution=32,temporal=true+vo:temporal=true",
                                         "lpv:dim=16+ssao", "lpv:dim=16+vo:samples=5", "none" };
    struct renderer_fixture s = fixture_open_lit("lpv:dim=16");
    const struct ag_camera other = other_camera(&s.frame.camera);
    struct ag_view *views[2] = { make_view(&s, s.renderer, 40, 24),
                                 make_view(&s, s.renderer, FIXTURE_WIDTH, FIXTURE_HEIGHT) };
    for (size_t i = 0; i < sizeof specs / sizeof *specs; i++) {
        assert_int_equal(ag_renderer_set_gi(s.renderer, specs[i], NULL, 0), AG_OK);
        const struct ag_view_frame all[2] = { in_frame(views[0], &other),
                                              in_frame(views[1], &s.frame.camera) };
        render(&s, s.renderer, &s.frame.camera, all, 2);
        render(&s, s.renderer, &s.frame.camera, NULL, 0);
        render(&s, s.renderer, &s.frame.camera, all + 1, 1);
        assert_int_equal(ag_view_resize(views[0], 20 + (int)i, 10), AG_OK);
        assert_int_equal(ag_renderer_resize(s.renderer, 30 + (int)i, 20), AG_OK);
        render(&s, s.renderer, &s.frame.camera, all, 2);
        ag_view_destroy(views[1]);
        views[1] = make_view(&s, s.renderer, 50, 30);
        // From the start: the same as a renderer alone.
        struct ag_renderer *alone = make(&s, specs[i], 50, 30, NULL);
        struct ag_frame_desc frame = s.frame;
        const struct ag_view_frame newest = in_frame(views[1], &other);
        frame.camera_cut = true;
        frame.views = &newest;
        frame.view_count = 1;
        assert_int_equal(ag_renderer_resize(s.renderer, 50, 30), AG_OK);
        assert_int_equal(ag_renderer_render(s.renderer, &frame), AG_OK);
        render(&s, alone, &other, NULL, 0);
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
    for (int i = 0; i < 7; i++) views[i] = make_view(&s, s.renderer, 8, 8);
    assert_int_equal(ag_view_create(s.renderer, NULL, &views[7]), AG_ERROR_ARGUMENT);
    assert_null(views[7]);
    for (int i = 1; i < 7; i++) ag_view_destroy(views[i]);
    struct ag_renderer *stranger = make(&s, "none", 8, 8, NULL);
    struct ag_view *strange = make_view(&s, stranger, 8, 8);
    struct ag_view_frame list[2] = { in_frame(views[0], &s.frame.camera),
                                     in_frame(views[0], &s.frame.camera) };
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
    list[0] = in_frame(views[0], &s.frame.camera);
    list[0].reserved[3] = 1;
    assert_int_equal(ag_renderer_render(s.renderer, &frame), AG_ERROR_ARGUMENT);
    list[0].reserved[3] = 0;
    list[0].camera.near_m = -1;
    assert_int_equal(ag_renderer_render(s.renderer, &frame), AG_ERROR_ARGUMENT);
    struct ag_image *image = NULL;
    assert_int_equal(ag_view_read(views[0], "color", &image), AG_ERROR_ARGUMENT);
    list[0] = in_frame(views[0], &s.frame.camera);
    assert_int_equal(ag_renderer_render(s.renderer, &frame), AG_OK);
    assert_int_equal(ag_view_read(views[0], "debug", &image), AG_ERROR_ARGUMENT);
    ag_view_destroy(strange);
    ag_renderer_destroy(stranger);
    ag_view_destroy(views[0]);
    fixture_close(&s);
}
