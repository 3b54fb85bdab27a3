// Cameras by matrices: all conventions against the simple camera, jitter and images off the axis
// against shifted ones, orthographic views against telephoto ones.
#include "api/camera_matrices.h"
#include "api/renderer_fixture.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const struct {
    const char *name;
    struct matrix_options options;
} conventions[] = {
    { "reversed, infinite", { .depth = REVERSED_INFINITE } },
    { "reversed, finite", { .depth = REVERSED_FINITE } },
    { "forward, finite", { .depth = FORWARD_FINITE } },
    { "forward, infinite", { .depth = FORWARD_INFINITE } },
    { "y up", { .depth = REVERSED_INFINITE, .y_up = true } },
    { "left-handed", { .depth = FORWARD_FINITE, .left_handed = true, .y_up = true } },
    { "y down in view space", { .depth = REVERSED_FINITE, .opencv = true } },
};

static struct ag_view_matrices matrices(const struct renderer_fixture *s,
                                        const struct matrix_options *options)
{
    return matrices_of(&s->frame.camera, FIXTURE_WIDTH, FIXTURE_HEIGHT, options);
}

static struct ag_image *rendered(struct renderer_fixture *s, const struct ag_view_matrices *m,
                                 const char *layer)
{
    s->frame.matrices = m;
    if (ag_renderer_render(s->renderer, &s->frame) != AG_OK)
        fail_msg("%s", ag_context_last_error(s->context));
    return fixture_read(s, layer);
}

TEST(every_convention_gives_the_picture_of_the_simple_camera)
{
    struct renderer_fixture s = fixture_open_lit("vct:resolution=32,specular=true+hbao");
    s.frame.auto_exposure = false;
    struct ag_image *expected = rendered(&s, NULL, "color");
    struct ag_image *distances = fixture_read(&s, "depth");
    for (size_t i = 0; i < sizeof conventions / sizeof *conventions; i++) {
        struct matrix_options options = matrix_options_default();
        options.depth = conventions[i].options.depth;
        options.y_up = conventions[i].options.y_up;
        options.left_handed = conventions[i].options.left_handed;
        options.opencv = conventions[i].options.opencv;
        const struct ag_view_matrices m = matrices(&s, &options);
        struct ag_image *image = rendered(&s, &m, "color");
        struct ag_image *depth = fixture_read(&s, "depth");
        // Rounding of a matrix and its inverse; a pixel on an edge may see the other surface.
        const double difference = fixture_difference(image, expected);
        print_message("%s: differs by %.2g, depth by %.2g\n", conventions[i].name, difference,
                      fixture_difference(depth, distances));
        CHECK(difference < 1e-3);
        CHECK(fixture_difference(depth, distances) < 1e-4);
        ag_image_destroy(s.context, image);
        ag_image_destroy(s.context, depth);
    }
    ag_image_destroy(s.context, expected);
    ag_image_destroy(s.context, distances);
    fixture_close(&s);
}

// Mean relative difference where `image`, moved by (dx, dy) pixels, shows what `whole` does.
static double shifted_difference(const struct ag_image *image, const struct ag_image *whole, int dx,
                                 int dy)
{
    double sum = 0, mean = 0;
    for (int y = 2; y < image->height - 2; y++)
        for (int x = 2; x < image->width - 2; x++)
            for (int c = 0; c < image->channels; c++) {
                const int from = (y * image->width + x) * image->channels + c;
                const int to = ((y + dy) * whole->width + x + dx) * whole->channels + c;
                sum += fabs((double)image->pixels[from] - (double)whole->pixels[to]);
                mean += fabs((double)whole->pixels[to]);
            }
    return sum / mean;
}

TEST(an_image_off_the_axis_is_shifted)
{
    struct renderer_fixture s = fixture_open_lit("lpv:dim=16+vo");
    s.frame.auto_exposure = false;
    struct ag_image *whole = rendered(&s, NULL, "color");
    static const int shifts[][2] = { { 1, 0 }, { 0, 1 }, { -2, 1 } };
    for (int i = 0; i < 3; i++) {
        struct matrix_options options = matrix_options_default();
        const float dx = 2.0f * (float)shifts[i][0] / FIXTURE_WIDTH;
        const float dy = 2.0f * (float)shifts[i][1] / FIXTURE_HEIGHT;
        options.left += dx;
        options.right += dx;
        options.top -= dy;
        options.bottom -= dy;
        const struct ag_view_matrices m = matrices(&s, &options);
        struct ag_image *image = rendered(&s, &m, "color");
        const double difference = shifted_difference(image, whole, shifts[i][0], shifts[i][1]);
        print_message("%d, %d pixels: differs by %.3g\n", shifts[i][0], shifts[i][1], difference);
        // Patterns of vo follow the pixel, not the surface; without vo the difference is rounding.
        CHECK(difference < 0.02);
        ag_image_destroy(s.context, image);
    }
    ag_image_destroy(s.context, whole);
    fixture_close(&s);
}

// A static scene under a jitter of a quarter of a pixel: the motion is the jitter, all else stands.
TEST(motion_holds_the_jitter)
{
    struct renderer_fixture s = fixture_open_lit("ambient");
    struct matrix_options options = matrix_options_default();
    const struct ag_view_matrices still = matrices(&s, &options);
    ag_image_destroy(s.context, rendered(&s, &still, "motion"));
    const float jitter = 0.25f * 2.0f / FIXTURE_WIDTH; // the image moves left by a quarter
    options.left += jitter;
    options.right += jitter;
    const struct ag_view_matrices moved = matrices(&s, &options);
    struct ag_image *motion = rendered(&s, &moved, "motion");
    const float *middle = motion->pixels + 3 * (FIXTURE_WIDTH * (FIXTURE_HEIGHT / 2) + 20);
    CHECK_NEAR(middle[0], -0.25 / FIXTURE_WIDTH, 1e-5);
    CHECK_NEAR(middle[1], 0.0, 1e-6);
    CHECK_NEAR(middle[2], 0.0, 1e-5);
    ag_image_destroy(s.context, motion);
    fixture_close(&s);
}

static void look_from(struct ag_camera *camera, float distance_m)
{
    float length = 0;
    for (int i = 0; i < 3; i++) length += powf(camera->target[i] - camera->eye[i], 2);
    for (int i = 0; i < 3; i++)
        camera->eye[i] =
            camera->target[i] + distance_m / sqrtf(length) * (camera->eye[i] - camera->target[i]);
}

enum { TELEPHOTO_M = 200 };

static struct matrix_options flat_options(const struct ag_camera *telephoto)
{
    struct matrix_options options = matrix_options_default();
    options.orthographic_half_m = TELEPHOTO_M * tanf(0.5f * telephoto->vertical_fov_rad);
    options.far_m = TELEPHOTO_M + 10;
    return options;
}

// The middle of the box, from the front, through a telephoto lens: sight lines are parallel to
// 0.3°.
static struct ag_camera telephoto_camera(struct renderer_fixture *s)
{
    struct ag_camera camera = s->frame.camera;
    struct ag_scene_info info;
    assert_int_equal(ag_scene_get_info(s->scene, 0, 0, &info), AG_OK);
    for (int i = 0; i < 3; i++) camera.target[i] = 0.5f * (info.bounds_min[i] + info.bounds_max[i]);
    look_from(&camera, TELEPHOTO_M);
    camera.near_m = TELEPHOTO_M - 10;
    camera.vertical_fov_rad =
        2 * atanf(0.45f * (info.bounds_max[1] - info.bounds_min[1]) / (float)TELEPHOTO_M);
    return camera;
}

static void check_flat(struct renderer_fixture *s, const char *gi, const struct ag_bake *bake)
{
    struct ag_renderer_desc desc = fixture_renderer_desc(gi);
    desc.bakes = &bake;
    desc.bake_count = bake != NULL;
    if (ag_renderer_create(s->device, s->scene, &desc, &s->renderer) != AG_OK)
        fail_msg("%s: %s", gi, ag_context_last_error(s->context));
    struct matrix_options options = flat_options(&s->frame.camera);
    const struct ag_view_matrices m = matrices(s, &options);
    struct ag_image *expected = rendered(s, NULL, "color");
    struct ag_image *image = rendered(s, &m, "color");
    const double difference = fixture_difference(image, expected);
    print_message("%s: differs by %.3g\n", gi, difference);
    if (!(difference < 0.02)) fail_msg("%s: differs by %g", gi, difference);
    ag_image_destroy(s->context, image);
    ag_image_destroy(s->context, expected);
    ag_renderer_destroy(s->renderer);
    s->renderer = NULL;
}

TEST(an_orthographic_view_is_that_through_a_telephoto_lens)
{
    struct renderer_fixture s = fixture_open_lit(NULL);
    s.frame.auto_exposure = false;
    s.frame.camera = telephoto_camera(&s);
    struct ag_technique_info info;
    for (int i = 0; ag_technique_get(i, &info); i++) {
        char base[FIXTURE_SPEC];
        fixture_print_base(i, &info, base);
        struct ag_bake *bake = fixture_bake(&s, base, &info);
        check_flat(&s, base, bake);
        ag_bake_destroy(bake);
    }
    check_flat(&s, "vct:resolution=32,specular=true,temporal=true", NULL);
    check_flat(&s, "ambient+vo:temporal=true", NULL);
    fixture_close(&s);
}

// Visibility of an orthographic view after some frames.
static struct ag_image *flat_visibility(struct renderer_fixture *s, const char *gi, int frames)
{
    struct ag_renderer_desc desc = fixture_renderer_desc(gi);
    if (ag_renderer_create(s->device, s->scene, &desc, &s->renderer) != AG_OK)
        fail_msg("%s: %s", gi, ag_context_last_error(s->context));
    const struct matrix_options options = flat_options(&s->frame.camera);
    const struct ag_view_matrices m = matrices(s, &options);
    for (int i = 1; i < frames; i++) ag_image_destroy(s->context, rendered(s, &m, "visibility"));
    struct ag_image *image = rendered(s, &m, "visibility");
    ag_renderer_destroy(s->renderer);
    s->renderer = NULL;
    return image;
}

// Depths of the history are compared: where they were another view's, it would be rejected.
TEST(an_orthographic_view_has_a_history)
{
    struct renderer_fixture s = fixture_open_lit(NULL);
    s.frame.camera = telephoto_camera(&s);
    static const char exact_spec[] = "ambient+vo:samples=33,radius=2",
                      spec[] = "ambient+vo:samples=5,radius=2,blur=false,temporal=true";
    struct ag_image *exact = flat_visibility(&s, exact_spec, 1);
    struct ag_image *one = flat_visibility(&s, spec, 1), *many = flat_visibility(&s, spec, 17);
    const double first = fixture_difference(one, exact), last = fixture_difference(many, exact);
    print_message("one frame %.4f, 17 frames %.4f\n", first, last);
    CHECK(last < 0.8 * first);
    ag_image_destroy(s.context, exact);
    ag_image_destroy(s.context, one);
    ag_image_destroy(s.context, many);
    fixture_close(&s);
}

TEST(motion_of_an_orthographic_view)
{
    struct renderer_fixture s = fixture_open_lit("ambient");
    s.frame.camera = telephoto_camera(&s);
    const struct matrix_options options = flat_options(&s.frame.camera);
    struct ag_view_matrices m = matrices(&s, &options);
    ag_image_destroy(s.context, rendered(&s, &m, "motion"));
    struct ag_image *depth = fixture_read(&s, "depth");
    const float per_pixel_m = 2 * options.orthographic_half_m / FIXTURE_HEIGHT;
    m.view_from_world[12] -= per_pixel_m; // the camera moves right by a pixel,
    m.view_from_world[14] += 0.5f;        // and forward by half a metre
    struct ag_image *motion = rendered(&s, &m, "motion");
    const int at = FIXTURE_WIDTH * (FIXTURE_HEIGHT / 2) + FIXTURE_WIDTH / 2;
    CHECK_NEAR(motion->pixels[3 * at], -1.0 / FIXTURE_WIDTH, 1e-5);
    CHECK_NEAR(motion->pixels[3 * at + 1], 0.0, 1e-5);
    // The library moves the position to the near plane: the sign of the change is known.
    CHECK(motion->pixels[3 * at + 2] > 0.0f);
    CHECK(depth->pixels[at] > 0.0f);
    ag_image_destroy(s.context, motion);
    ag_image_destroy(s.context, depth);
    fixture_close(&s);
}

static void check_refused(struct renderer_fixture *s, const struct ag_view_matrices *m,
                          const char *expected)
{
    s->frame.matrices = m;
    assert_int_equal(ag_renderer_render(s->renderer, &s->frame), AG_ERROR_ARGUMENT);
    if (!strstr(ag_context_last_error(s->context), expected))
        fail_msg("%s is not in: %s", expected, ag_context_last_error(s->context));
}

TEST(matrices_of_no_camera_are_refused_by_a_sentence)
{
    struct renderer_fixture s = fixture_open_lit("none");
    const struct matrix_options options = matrix_options_default();
    const struct ag_view_matrices good = matrices(&s, &options);
    struct ag_view_matrices bad = good;
    bad.clip_from_view[0] = NAN;
    check_refused(&s, &bad, "not finite");
    bad = good;
    bad.view_from_world[0] *= 2; // a scale
    check_refused(&s, &bad, "view_from_world is not a rotation");
    bad = good;
    for (int r = 0; r < 4; r++) // row by row
        for (int c = 0; c < 4; c++)
            bad.view_from_world[4 * r + c] = good.view_from_world[4 * c + r];
    check_refused(&s, &bad, "view_from_world is not a rotation");
    bad = good;
    for (int r = 0; r < 4; r++)
        for (int c = 0; c < 4; c++) bad.clip_from_view[4 * r + c] = good.clip_from_view[4 * c + r];
    check_refused(&s, &bad, "row by row");
    bad = good;
    bad.y_up = true;
    check_refused(&s, &bad, "mirrors the image");
    bad = good;
    bad.clip_from_view[2] = 0.1f;
    check_refused(&s, &bad, "oblique near plane");
    bad = good;
    bad.clip_from_view[14] = 0;
    check_refused(&s, &bad, "near and a far plane");
    bad.clip_from_view[14] = 1e-45f; // a near plane that a float cannot hold
    check_refused(&s, &bad, "near and a far plane");
    struct matrix_options flat = options;
    flat.orthographic_half_m = 1;
    flat.far_m = 1e30f; // the near plane is where its 1 % is
    bad = matrices(&s, &flat);
    check_refused(&s, &bad, "the near plane of clip_from_view is not within");
    memset(&bad, 0, sizeof bad);
    check_refused(&s, &bad, "view_from_world");
    bad = good;
    bad.reserved[0] = 1;
    check_refused(&s, &bad, "reserved");
    s.frame.matrices = &good;
    assert_int_equal(ag_renderer_render(s.renderer, &s.frame), AG_OK);
    fixture_close(&s);
}
