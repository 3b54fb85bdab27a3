// Sub-pixel jitter of a frame and of a view, against matrices with the same shift.
#include "api/camera_matrices.h"
#include "api/view_fixture.h"

#include <math.h>
#include <string.h>

static void render(struct renderer_fixture *s, struct ag_renderer *renderer,
                   const struct ag_frame_desc *frame)
{
    if (ag_renderer_render(renderer, frame) != AG_OK)
        fail_msg("%s", ag_context_last_error(s->context));
}

static struct ag_renderer *make(struct renderer_fixture *s, const char *gi)
{
    struct ag_renderer *renderer = NULL;
    const struct ag_renderer_desc desc = fixture_renderer_desc(gi);
    if (ag_renderer_create(s->device, s->scene, &desc, &renderer) != AG_OK)
        fail_msg("%s: %s", gi, ag_context_last_error(s->context));
    return renderer;
}

// The camera with its image moved by (dx, dy) pixels.
static struct ag_view_matrices moved(const struct ag_camera *camera, float dx, float dy)
{
    struct matrix_options options = matrix_options_default();
    options.left += 2.0f * dx / FIXTURE_WIDTH;
    options.right += 2.0f * dx / FIXTURE_WIDTH;
    options.top -= 2.0f * dy / FIXTURE_HEIGHT;
    options.bottom -= 2.0f * dy / FIXTURE_HEIGHT;
    return matrices_of(camera, FIXTURE_WIDTH, FIXTURE_HEIGHT, &options);
}

// Frames by a jitter, in the second renderer by matrices.
static void check_technique(struct renderer_fixture *s, const char *gi, int frames)
{
    static const char *const layers[] = { "color", "depth", "position" };
    struct ag_renderer *jittered = make(s, gi), *shifted = make(s, gi);
    for (int i = 0; i < frames; i++) {
        struct ag_frame_desc a = s->frame, b = s->frame;
        if (frames == 1)
            a.jitter[0] = 0.25f, a.jitter[1] = -0.25f;
        else
            ag_jitter(i, frames, a.jitter);
        const struct ag_view_matrices m = moved(&b.camera, a.jitter[0], a.jitter[1]);
        b.matrices = &m;
        render(s, jittered, &a);
        render(s, shifted, &b);
    }
    for (size_t i = 0; i < sizeof layers / sizeof *layers; i++) {
        struct ag_image *a = fixture_read_from(s, jittered, layers[i]);
        struct ag_image *b = fixture_read_from(s, shifted, layers[i]);
        const double difference = fixture_difference(a, b);
        print_message("%s, %d frames, %s: differs by %.2g\n", gi, frames, layers[i], difference);
        // Rounding of a matrix and its inverse; a pixel on an edge may see the other surface.
        CHECK(difference < 1e-3);
        ag_image_destroy(s->context, a);
        ag_image_destroy(s->context, b);
    }
    ag_renderer_destroy(jittered);
    ag_renderer_destroy(shifted);
}

TEST(a_jittered_frame_is_that_of_shifted_matrices)
{
    struct renderer_fixture s = fixture_open_lit(NULL);
    s.frame.auto_exposure = false;
    check_technique(&s, "none", 1);
    check_technique(&s, "lpv:dim=16+vo", 1);
    check_technique(&s, "vct:resolution=32,specular=true+gtao", 1);
    fixture_close(&s);
}

// Histories are looked up where the last frame sampled a surface.
TEST(histories_follow_the_jitter_as_that_of_matrices)
{
    struct renderer_fixture s = fixture_open_lit(NULL);
    s.frame.auto_exposure = false;
    check_technique(&s, "vct:resolution=32,temporal=true", 6);
    check_technique(&s, "ambient+vo:temporal=true", 6);
    check_technique(&s, "ambient+gtao:temporal=true,half_resolution=true", 6);
    fixture_close(&s);
}

TEST(a_sun_has_its_shadows_under_jitter)
{
    struct renderer_fixture s = fixture_open_lit(NULL);
    s.frame.auto_exposure = false;
    struct ag_light_desc sun;
    ag_light_desc_default(&sun, AG_LIGHT_SUN);
    sun.direction[0] = 0.3f, sun.direction[1] = -1.0f, sun.direction[2] = -0.8f;
    for (int c = 0; c < 3; c++) sun.intensity[c] = 50;
    assert_int_equal(ag_scene_remove_lights(s.scene), AG_OK);
    assert_int_equal(ag_scene_add_light(s.scene, &sun, NULL), AG_OK);
    check_technique(&s, "none", 1);
    fixture_close(&s);
}

static float largest(const struct ag_image *image)
{
    float most = 0;
    for (int i = 0; i < image->channels * image->width * image->height; i++)
        most = fmaxf(most, fabsf(image->pixels[i]));
    return most;
}

static float largest_motion(struct renderer_fixture *s)
{
    struct ag_image *motion = fixture_read(s, "motion");
    const float most = largest(motion);
    ag_image_destroy(s->context, motion);
    return most;
}

TEST(motion_excludes_the_jitter)
{
    struct renderer_fixture s = fixture_open_lit("ambient");
    for (int by_matrices = 0; by_matrices < 2; by_matrices++) {
        const struct ag_view_matrices m = moved(&s.frame.camera, 0.1f, 0.2f);
        if (by_matrices) s.frame.matrices = &m;
        s.frame.camera_cut = by_matrices;
        for (int i = 0; i < 4; i++) {
            ag_jitter(i, 4, s.frame.jitter);
            render(&s, s.renderer, &s.frame);
            CHECK(largest_motion(&s) == 0.0f);
            s.frame.camera_cut = false;
        }
    }
    s.frame.matrices = NULL;
    fixture_close(&s);
}

// Its motion is that without jitter, at the point that the jitter samples.
TEST(motion_of_a_moving_camera_excludes_the_jitter)
{
    struct renderer_fixture s = fixture_open_lit("ambient");
    struct ag_image *motion[2];
    for (int i = 0; i < 2; i++) {
        struct ag_frame_desc frame = s.frame;
        frame.camera_cut = true;
        if (i == 1) frame.jitter[0] = 0.4f, frame.jitter[1] = 0.4f;
        render(&s, s.renderer, &frame);
        frame.camera_cut = false;
        for (int k = 0; k < 3; k++) frame.camera.eye[k] += k == 0 ? 0.05f : 0.0f;
        if (i == 1) frame.jitter[0] = -0.4f, frame.jitter[1] = -0.4f;
        render(&s, s.renderer, &frame);
        motion[i] = fixture_read(&s, "motion");
    }
    const int at = 3 * (FIXTURE_WIDTH * (FIXTURE_HEIGHT / 2) + 20); // the back wall
    CHECK(fabsf(motion[0]->pixels[at]) * FIXTURE_WIDTH > 0.1f);
    for (int k = 0; k < 2; k++)
        CHECK_NEAR(motion[0]->pixels[at + k], motion[1]->pixels[at + k], 0.02 / FIXTURE_WIDTH);
    for (int i = 0; i < 2; i++) ag_image_destroy(s.context, motion[i]);
    fixture_close(&s);
}

TEST(jitter_is_added_to_that_of_matrices)
{
    struct renderer_fixture s = fixture_open_lit("ambient");
    s.frame.auto_exposure = false;
    struct ag_image *image[2];
    for (int i = 0; i < 2; i++) {
        const struct ag_view_matrices m =
            moved(&s.frame.camera, i ? 0.1f : 0.4f, i ? -0.2f : -0.4f);
        s.frame.matrices = &m;
        s.frame.jitter[0] = i ? 0.3f : 0.0f;
        s.frame.jitter[1] = i ? -0.2f : 0.0f;
        render(&s, s.renderer, &s.frame);
        image[i] = fixture_read(&s, "color");
    }
    const double difference = fixture_difference(image[0], image[1]);
    print_message("differs by %.2g\n", difference);
    CHECK(difference < 1e-3);
    for (int i = 0; i < 2; i++) ag_image_destroy(s.context, image[i]);
    s.frame.matrices = NULL;
    fixture_close(&s);
}

TEST(a_view_has_a_jitter_of_its_own)
{
    struct renderer_fixture s = fixture_open_lit("ambient+vo:temporal=true");
    struct ag_renderer *alone = make(&s, "ambient+vo:temporal=true");
    struct ag_view *view = view_make(&s, s.renderer, FIXTURE_WIDTH, FIXTURE_HEIGHT);
    const struct ag_camera other = view_other_camera(&s.frame.camera);
    for (int i = 0; i < 4; i++) {
        struct ag_view_frame further = view_in_frame(view, &other);
        struct ag_frame_desc frame = s.frame, single = s.frame;
        ag_jitter(i, 8, further.jitter);
        ag_jitter(i + 3, 8, frame.jitter);
        frame.views = &further;
        frame.view_count = 1;
        single.camera = other;
        memcpy(single.jitter, further.jitter, sizeof single.jitter);
        render(&s, s.renderer, &frame);
        render(&s, alone, &single);
    }
    view_check_layer(&s, "color", s.renderer, view, alone);
    view_check_layer(&s, "depth", s.renderer, view, alone);
    ag_view_destroy(view);
    ag_renderer_destroy(alone);
    fixture_close(&s);
}

TEST(a_jitter_of_more_than_half_a_pixel_is_refused)
{
    struct renderer_fixture s = fixture_open_lit("none");
    static const float wrong[] = { 0.51f, -0.6f, NAN, INFINITY };
    for (int i = 0; i < 4; i++) {
        s.frame.jitter[i % 2] = wrong[i];
        assert_int_equal(ag_renderer_render(s.renderer, &s.frame), AG_ERROR_ARGUMENT);
        CHECK(strstr(ag_context_last_error(s.context), "jitter["));
        s.frame.jitter[i % 2] = 0;
    }
    s.frame.jitter[0] = 0.5f, s.frame.jitter[1] = -0.5f;
    assert_int_equal(ag_renderer_render(s.renderer, &s.frame), AG_OK);
    fixture_close(&s);
}
