// Temporal antialiasing: a static image against the mean of jittered frames and the path-traced
// reference; moving objects and changed light against fresh images; views, cuts, sizes, and a
// program's own G-buffer.
#include "api/view_fixture.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { SAMPLES = 64, WIDTH = 96, HEIGHT = 64, LARGE_WIDTH = 320, LARGE_HEIGHT = 180 };
static const char TEMPORAL[] = "antialias=temporal,shadow_size=512",
                  PLAIN[] = "shadow_size=512,antialias=none";

static struct ag_renderer *make(struct renderer_fixture *s, const char *gi, const char *options)
{
    struct ag_renderer *renderer = NULL;
    struct ag_renderer_desc desc = fixture_renderer_desc(gi);
    desc.frame_options = options;
    desc.width = WIDTH;
    desc.height = HEIGHT;
    if (ag_renderer_create(s->device, s->scene, &desc, &renderer) != AG_OK)
        fail_msg("%s: %s", gi, ag_context_last_error(s->context));
    return renderer;
}

static void render(struct renderer_fixture *s, struct ag_renderer *renderer,
                   const struct ag_frame_desc *frame)
{
    if (ag_renderer_render(renderer, frame) != AG_OK)
        fail_msg("%s", ag_context_last_error(s->context));
}

static struct ag_image *read(struct renderer_fixture *s, struct ag_renderer *renderer)
{
    return fixture_read_from(s, renderer, "color");
}

// The mean of N jittered frames; the caller destroys it.
static struct ag_image *mean_of(struct renderer_fixture *s, struct ag_renderer *plain, int samples)
{
    struct ag_image *mean = NULL;
    struct ag_frame_desc frame = s->frame;
    for (int i = 0; i < samples; i++) {
        ag_jitter(i, samples, frame.jitter);
        render(s, plain, &frame);
        struct ag_image *image = read(s, plain);
        for (int k = 0; mean && k < 3 * image->width * image->height; k++)
            image->pixels[k] += mean->pixels[k];
        ag_image_destroy(s->context, mean);
        mean = image;
    }
    for (int k = 0; k < 3 * mean->width * mean->height; k++) mean->pixels[k] /= (float)samples;
    return mean;
}

// ---- static images

static double largest_difference(const struct ag_image *a, const struct ag_image *b)
{
    double most = 0;
    for (int i = 0; i < 3 * a->width * a->height; i++) {
        const double x = (double)a->pixels[i], y = (double)b->pixels[i];
        most = fmax(most, fabs(x - y) / (fabs(x) + fabs(y) + 1e-3));
    }
    return most;
}

TEST(a_static_image_is_the_mean_of_its_jittered_frames)
{
    struct renderer_fixture s = fixture_open("none", NULL);
    struct ag_renderer *temporal = make(&s, "none", TEMPORAL), *plain = make(&s, "none", PLAIN);
    for (int i = 0; i < SAMPLES; i++) render(&s, temporal, &s.frame);
    struct ag_image *image = read(&s, temporal), *mean = mean_of(&s, plain, SAMPLES);
    const double difference = largest_difference(image, mean);
    print_message("largest relative difference of a pixel %.2g\n", difference);
    CHECK(difference < 6e-4); // half floats
    ag_image_destroy(s.context, image);
    ag_image_destroy(s.context, mean);
    ag_renderer_destroy(temporal);
    ag_renderer_destroy(plain);
    fixture_close(&s);
}

static struct ag_image *traced(struct renderer_fixture *s, int samples)
{
    struct ag_reference_desc desc;
    struct ag_reference *reference = NULL;
    struct ag_image *image = NULL;
    ag_reference_desc_default(&desc);
    desc.width = LARGE_WIDTH;
    desc.height = LARGE_HEIGHT;
    desc.camera = s->frame.camera;
    desc.direct_only = desc.antialias = true;
    assert_int_equal(ag_reference_create(s->scene, &desc, &reference), AG_OK);
    assert_int_equal(ag_reference_render(reference, samples, NULL, NULL), AG_OK);
    assert_int_equal(ag_reference_read(reference, "color", &image), AG_OK);
    ag_reference_destroy(reference);
    return image;
}

static double flip_of(struct renderer_fixture *s, const struct ag_image *a,
                      const struct ag_image *b)
{
    struct ag_compare_desc desc;
    struct ag_metrics metrics;
    ag_compare_desc_default(&desc);
    desc.radiance = true;
    desc.ev = ag_image_auto_exposure(b);
    assert_int_equal(ag_image_metrics(s->context, a, b, &desc, &metrics), AG_OK);
    return metrics.flip;
}

// The error left is that of the mean of the jittered frames, by shadow maps and filtered textures:
// none of it is due to the blending of frames.
static void check_flip(const char *scene)
{
    struct renderer_fixture s = fixture_open("none", NULL);
    const float black[3] = { 0 };
    ag_renderer_destroy(s.renderer);
    ag_scene_destroy(s.scene);
    s.renderer = NULL;
    assert_int_equal(ag_scene_load(s.context, scene, &s.scene), AG_OK);
    assert_int_equal(ag_scene_set_sky(s.scene, black), AG_OK); // a frame's direct light has none
    assert_int_equal(ag_scene_default_camera(s.scene, 0, 0, &s.frame.camera, NULL), AG_OK);
    struct ag_renderer *temporal = make(&s, "none", "antialias=temporal"),
                       *plain = make(&s, "none", "antialias=none");
    assert_int_equal(ag_renderer_resize(temporal, LARGE_WIDTH, LARGE_HEIGHT), AG_OK);
    assert_int_equal(ag_renderer_resize(plain, LARGE_WIDTH, LARGE_HEIGHT), AG_OK);
    struct ag_image *reference = traced(&s, 256), *mean = mean_of(&s, plain, SAMPLES);
    const double least = flip_of(&s, mean, reference);
    render(&s, temporal, &s.frame);
    struct ag_image *image = read(&s, temporal);
    const double first = flip_of(&s, image, reference);
    ag_image_destroy(s.context, image);
    for (int i = 1; i < SAMPLES; i++) render(&s, temporal, &s.frame);
    image = read(&s, temporal);
    const double last = flip_of(&s, image, reference);
    print_message("%s: FLIP %.4f, after %d frames %.4f, of their mean %.4f\n", scene, first,
                  SAMPLES, last, least);
    if (!(last < least + 0.001 && last < 0.7 * first))
        fail_msg("%s: FLIP %.4f, of the mean %.4f, at first %.4f", scene, last, least, first);
    ag_image_destroy(s.context, image);
    ag_image_destroy(s.context, mean);
    ag_image_destroy(s.context, reference);
    ag_renderer_destroy(temporal);
    ag_renderer_destroy(plain);
    fixture_close(&s);
}

TEST(a_static_image_converges_to_the_reference)
{
    check_flip("@cornell:light=point");
    check_flip("@atrium");
    check_flip("@maze:light=point");
}

// ---- changes

// Differences count outside of edges: where the fresh image varies by less than a tenth of its mean
// radiance within two pixels. Relative to the mean.
static double smooth_difference(const struct ag_image *a, const struct ag_image *fresh,
                                int *counted)
{
    const int w = fresh->width, h = fresh->height;
    double mean = 0, most = 0;
    for (int i = 0; i < 3 * w * h; i++) mean += (double)fresh->pixels[i] / (3.0 * w * h);
    *counted = 0;
    for (int y = 2; y < h - 2; y++)
        for (int x = 2; x < w - 2; x++) {
            double range = 0, difference = 0;
            for (int k = 0; k < 25 * 3; k++) {
                const int c = k % 3, at = 3 * ((y + k / 3 / 5 - 2) * w + x + k / 3 % 5 - 2) + c;
                range = fmax(range, fabs((double)fresh->pixels[at] -
                                         (double)fresh->pixels[3 * (y * w + x) + c]));
            }
            if (range > 0.1 * mean) continue;
            for (int c = 0; c < 3; c++) {
                const int at = 3 * (y * w + x) + c;
                difference =
                    fmax(difference, fabs((double)a->pixels[at] - (double)fresh->pixels[at]));
            }
            most = fmax(most, difference / mean);
            ++*counted;
        }
    return most;
}

static void enlarge(struct ag_renderer *a, struct ag_renderer *b)
{
    assert_int_equal(ag_renderer_resize(a, 2 * WIDTH, 2 * HEIGHT), AG_OK);
    assert_int_equal(ag_renderer_resize(b, 2 * WIDTH, 2 * HEIGHT), AG_OK);
}

// Against the mean of 16 jittered frames of the same moment.
static double difference_to_fresh(struct renderer_fixture *s, struct ag_renderer *temporal,
                                  struct ag_renderer *plain)
{
    int counted;
    struct ag_image *image = read(s, temporal), *fresh = mean_of(s, plain, 16);
    const double difference = smooth_difference(image, fresh, &counted);
    CHECK(counted > WIDTH * HEIGHT / 4);
    ag_image_destroy(s->context, image);
    ag_image_destroy(s->context, fresh);
    return difference;
}

// A red box of 1 m before the white back wall, on which it casts a shadow.
static int add_box(struct renderer_fixture *s)
{
    static const float corners[24] = { -1, -1, -1, 1, -1, -1, 1, 1, -1, -1, 1, -1,
                                       -1, -1, 1,  1, -1, 1,  1, 1, 1,  -1, 1, 1 };
    static const uint32_t faces[36] = { 0, 2, 1, 0, 3, 2, 4, 5, 6, 4, 6, 7, 0, 1, 5, 0, 5, 4,
                                        3, 6, 2, 3, 7, 6, 0, 4, 7, 0, 7, 3, 1, 2, 6, 1, 6, 5 };
    const struct ag_mesh_desc desc = {
        .positions = corners, .vertex_count = 8, .indices = faces, .index_count = 36, .material = 1
    };
    int mesh, box;
    assert_int_equal(ag_scene_add_mesh(s->scene, &desc, &mesh), AG_OK);
    assert_int_equal(ag_scene_add_instance(s->scene, mesh, NULL, &box), AG_OK);
    return box;
}

static void place_box(struct renderer_fixture *s, int box, float x)
{
    const float matrix[16] = { 0.5f, 0, 0, 0, 0, 0.5f, 0, 0, 0, 0, 0.5f, 0, x, 4.0f, -1.8f, 1 };
    assert_int_equal(ag_scene_set_instance_transform(s->scene, box, matrix), AG_OK);
}

TEST(a_moving_object_leaves_no_trail)
{
    struct renderer_fixture s = fixture_open("none", NULL);
    const int box = add_box(&s);
    struct ag_renderer *temporal = make(&s, "none", TEMPORAL), *plain = make(&s, "none", PLAIN);
    enlarge(temporal, plain);
    place_box(&s, box, -1.6f);
    for (int i = 0; i < 8; i++) render(&s, temporal, &s.frame);
    double most = 0;
    for (int i = 0; i < 30; i++) {
        place_box(&s, box, -1.5f + 0.1f * (float)i);
        render(&s, temporal, &s.frame);
        const double difference = difference_to_fresh(&s, temporal, plain);
        print_message("%d: %.3f\n", i, difference);
        most = fmax(most, difference);
    }
    print_message("largest difference outside of edges %.3f of the mean radiance\n", most);
    CHECK(most < 0.1);
    ag_renderer_destroy(temporal);
    ag_renderer_destroy(plain);
    fixture_close(&s);
}

TEST(a_moving_camera_leaves_no_trail)
{
    struct renderer_fixture s = fixture_open("none", NULL);
    const int box = add_box(&s);
    place_box(&s, box, 0);
    struct ag_renderer *temporal = make(&s, "none", TEMPORAL), *plain = make(&s, "none", PLAIN);
    enlarge(temporal, plain);
    double most = 0;
    for (int i = 0; i < 20; i++) {
        s.frame.camera.eye[0] += 0.02f;
        render(&s, temporal, &s.frame);
        most = fmax(most, difference_to_fresh(&s, temporal, plain));
    }
    print_message("largest difference outside of edges %.3f of the mean radiance\n", most);
    CHECK(most < 0.15);
    ag_renderer_destroy(temporal);
    ag_renderer_destroy(plain);
    fixture_close(&s);
}

TEST(changed_light_is_followed_at_once)
{
    struct renderer_fixture s = fixture_open("none", NULL);
    struct ag_renderer *temporal = make(&s, "none", TEMPORAL), *plain = make(&s, "none", PLAIN);
    for (int i = 0; i < 20; i++) render(&s, temporal, &s.frame);
    struct ag_light_info info;
    assert_int_equal(ag_scene_get_light(s.scene, 0, 0, 0, &info), AG_OK);
    struct ag_light_desc light = info.light;
    static const float factors[] = { 0.2f, 10.0f, 0.5f };
    for (int i = 0; i < 3; i++) {
        for (int c = 0; c < 3; c++) light.intensity[c] *= factors[i];
        light.position[0] += 0.3f; // shadows move
        assert_int_equal(ag_scene_set_light(s.scene, 0, &light), AG_OK);
        render(&s, temporal, &s.frame);
        const double difference = difference_to_fresh(&s, temporal, plain);
        print_message("times %g: %.3f\n", (double)factors[i], difference);
        CHECK(difference < 0.15);
        render(&s, temporal, &s.frame);
    }
    ag_renderer_destroy(temporal);
    ag_renderer_destroy(plain);
    fixture_close(&s);
}

static void check_same(struct renderer_fixture *s, struct ag_renderer *a, struct ag_renderer *b,
                       const char *layer)
{
    struct ag_image *x = fixture_read_from(s, a, layer), *y = fixture_read_from(s, b, layer);
    const size_t values = (size_t)x->width * (size_t)x->height * (size_t)x->channels;
    assert_int_equal(x->width, y->width);
    if (memcmp(x->pixels, y->pixels, sizeof(float) * values) != 0)
        fail_msg("%s differs by %g", layer, fixture_difference(x, y));
    ag_image_destroy(s->context, x);
    ag_image_destroy(s->context, y);
}

// After a cut and after a resize, the first frame is that of a renderer without antialiasing.
TEST(a_cut_and_a_resize_begin_again)
{
    struct renderer_fixture s = fixture_open("none", NULL);
    struct ag_renderer *temporal = make(&s, "none", TEMPORAL), *plain = make(&s, "none", PLAIN);
    struct ag_frame_desc frame = s.frame;
    frame.jitter[0] = 0.125f, frame.jitter[1] = -0.25f; // the program's own
    for (int i = 0; i < 5; i++) render(&s, temporal, &frame);
    frame.camera = view_other_camera(&s.frame.camera);
    frame.camera_cut = true;
    render(&s, temporal, &frame);
    render(&s, plain, &frame);
    check_same(&s, temporal, plain, "color");
    check_same(&s, temporal, plain, "display");
    frame.camera_cut = false;
    for (int i = 0; i < 3; i++) render(&s, temporal, &frame);
    assert_int_equal(ag_renderer_resize(temporal, 40, 24), AG_OK);
    assert_int_equal(ag_renderer_resize(plain, 40, 24), AG_OK);
    render(&s, temporal, &frame);
    render(&s, plain, &frame);
    check_same(&s, temporal, plain, "color");
    ag_renderer_destroy(temporal);
    ag_renderer_destroy(plain);
    fixture_close(&s);
}

static bool has_pass(struct ag_renderer *renderer, const char *name)
{
    struct ag_timing timings[64];
    const int count = ag_renderer_timings(renderer, timings, 64);
    for (int i = 0; i < count && i < 64; i++)
        if (strstr(timings[i].name, name)) return true;
    return false;
}

TEST(without_the_option_there_is_no_pass_and_it_can_be_switched)
{
    struct renderer_fixture s = fixture_open("none", NULL);
    struct ag_renderer *switched = make(&s, "none", PLAIN), *plain = make(&s, "none", PLAIN);
    render(&s, switched, &s.frame);
    CHECK(!has_pass(switched, "antialias"));
    assert_int_equal(ag_renderer_set_frame_options(switched, TEMPORAL), AG_OK);
    for (int i = 0; i < 3; i++) render(&s, switched, &s.frame);
    CHECK(has_pass(switched, "antialias"));
    assert_int_equal(ag_renderer_set_frame_options(switched, PLAIN), AG_OK);
    render(&s, switched, &s.frame);
    render(&s, plain, &s.frame);
    CHECK(!has_pass(switched, "antialias"));
    check_same(&s, switched, plain, "color");
    check_same(&s, switched, plain, "display");
    ag_renderer_destroy(switched);
    ag_renderer_destroy(plain);
    fixture_close(&s);
}

// The mean over the image of relative differences to the mean of jittered frames, without
// histories.
static void check_technique(struct renderer_fixture *s, const char *gi, const char *plain_gi)
{
    struct ag_renderer *temporal = make(s, gi, TEMPORAL), *plain = make(s, plain_gi, PLAIN);
    float low = INFINITY, high = -INFINITY;
    for (int i = 0; i < 16 + 2 * SAMPLES; i++) {
        float ev;
        render(s, temporal, &s->frame);
        assert_int_equal(ag_renderer_exposure(temporal, &ev), AG_OK);
        if (i >= 16 + SAMPLES) low = fminf(low, ev), high = fmaxf(high, ev);
    }
    struct ag_image *image = read(s, temporal), *mean = mean_of(s, plain, SAMPLES);
    const double difference = fixture_difference(image, mean);
    print_message("%s: differs by %.4f, exposure by %.4f EV\n", gi, difference,
                  (double)(high - low));
    CHECK(difference < 0.02);
    CHECK(high - low < 0.005f); // the mean of the frames' EVs
    ag_image_destroy(s->context, image);
    ag_image_destroy(s->context, mean);
    ag_renderer_destroy(temporal);
    ag_renderer_destroy(plain);
}

TEST(techniques_and_their_histories_converge_under_jitter)
{
    struct renderer_fixture s = fixture_open_lit(NULL);
    check_technique(&s, "lpv:dim=16", "lpv:dim=16");
    check_technique(&s, "ambient+vo:temporal=true", "ambient+vo");
    check_technique(&s, "ambient+gtao:temporal=true", "ambient+gtao");
    check_technique(&s, "vct:resolution=32,temporal=true", "vct:resolution=32");
    fixture_close(&s);
}

// ---- layers, views, a program's own G-buffer

TEST(display_shows_the_antialiased_color)
{
    struct renderer_fixture s = fixture_open("none", NULL);
    struct ag_renderer *temporal = make(&s, "none", TEMPORAL);
    for (int i = 0; i < 6; i++) {
        if (i == 5) s.frame.camera.eye[0] += 0.02f; // the other variant
        render(&s, temporal, &s.frame);
        if (i < 4) continue;
        float ev;
        assert_int_equal(ag_renderer_exposure(temporal, &ev), AG_OK);
        struct ag_image *color = read(&s, temporal), *shown = NULL;
        struct ag_image *display = fixture_read_from(&s, temporal, "display");
        assert_int_equal(ag_image_tonemap(s.context, color, ev, &shown), AG_OK);
        for (int k = 0; k < 3 * WIDTH * HEIGHT; k++)
            CHECK_NEAR(display->pixels[k], shown->pixels[k], 0.01);
        ag_image_destroy(s.context, color);
        ag_image_destroy(s.context, shown);
        ag_image_destroy(s.context, display);
    }
    ag_renderer_destroy(temporal);
    fixture_close(&s);
}

// Exposure of a static image is a mean; it begins with the first frame that is metered.
TEST(automatic_exposure_begins_at_once_after_a_fixed_one)
{
    struct renderer_fixture s = fixture_open("none", NULL);
    struct ag_renderer *temporal = make(&s, "none", TEMPORAL), *plain = make(&s, "none", PLAIN);
    float ev, expected;
    s.frame.auto_exposure = false;
    s.frame.exposure_ev = 15;
    for (int i = 0; i < 4; i++) render(&s, temporal, &s.frame);
    assert_int_equal(ag_renderer_exposure(temporal, &ev), AG_OK);
    CHECK_NEAR(ev, 15.0, 1e-6);
    s.frame.auto_exposure = true;
    render(&s, temporal, &s.frame);
    render(&s, plain, &s.frame);
    assert_int_equal(ag_renderer_exposure(temporal, &ev), AG_OK);
    assert_int_equal(ag_renderer_exposure(plain, &expected), AG_OK);
    CHECK_NEAR(ev, expected, 0.1);
    ag_renderer_destroy(temporal);
    ag_renderer_destroy(plain);
    fixture_close(&s);
}

TEST(a_view_has_a_history_of_its_own)
{
    struct renderer_fixture s = fixture_open("none", NULL);
    struct ag_renderer *both = make(&s, "ambient+vo", TEMPORAL),
                       *alone = make(&s, "ambient+vo", TEMPORAL);
    struct ag_view *view = view_make_lean(&s, both, WIDTH, HEIGHT);
    const struct ag_camera other = view_other_camera(&s.frame.camera);
    for (int i = 0; i < 6; i++) {
        struct ag_view_frame further = view_in_frame(view, &other);
        struct ag_frame_desc frame = s.frame, single = s.frame;
        frame.camera.eye[0] += 0.01f * (float)i; // the first view moves, the other does not
        frame.views = &further;
        frame.view_count = 1;
        single.camera = other;
        render(&s, both, &frame);
        render(&s, alone, &single);
    }
    view_check_layer(&s, "color", both, view, alone);
    view_check_layer(&s, "display", both, view, alone);
    ag_view_destroy(view);
    ag_renderer_destroy(both);
    ag_renderer_destroy(alone);
    fixture_close(&s);
}

TEST(a_programs_gbuffer_has_the_jitter_of_the_program)
{
    struct renderer_fixture s = fixture_open("none", NULL);
    struct ag_renderer_desc desc = fixture_renderer_desc("none");
    struct ag_renderer *own = make(&s, "none", TEMPORAL), *source = make(&s, "none", PLAIN),
                       *hosted = NULL;
    desc.width = WIDTH;
    desc.height = HEIGHT;
    desc.frame_options = TEMPORAL;
    desc.motion_layer = false; // antialiasing needs the image
    desc.host_gbuffer = true;
    assert_int_equal(ag_renderer_create(s.device, s.scene, &desc, &hosted), AG_OK);
    for (int i = 0; i < 6; i++) {
        struct ag_frame_desc frame = s.frame;
        if (i > 3) frame.camera.eye[0] += 0.02f * (float)i;
        ag_jitter(i + 1, 16, frame.jitter);
        render(&s, source, &frame);
        render(&s, own, &frame);
        struct ag_gbuffer gbuffer = { .depth = fixture_layer(&s, source, "depth"),
                                      .normal = fixture_layer(&s, source, "normal"),
                                      .albedo = fixture_layer(&s, source, "albedo"),
                                      .emissive = fixture_layer(&s, source, "emissive"),
                                      .motion = fixture_layer(&s, source, "motion") };
        frame.gbuffer = &gbuffer;
        render(&s, hosted, &frame);
        check_same(&s, hosted, own, "color");
        gbuffer.motion = (struct ag_layer_handle){ 0 };
        assert_int_equal(ag_renderer_render(hosted, &frame), AG_ERROR_ARGUMENT);
        CHECK(strstr(ag_context_last_error(s.context), "motion"));
    }
    ag_renderer_destroy(own);
    ag_renderer_destroy(source);
    ag_renderer_destroy(hosted);
    fixture_close(&s);
}
