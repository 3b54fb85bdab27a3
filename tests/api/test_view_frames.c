// Further views with a sun, with a program's own G-buffer, in recorded frames, and after a cut.
#include "api/view_fixture.h"

#include <math.h>
#include <string.h>

static const char *const seen[] = { "irradiance", "visibility", "direct", "color", "display" };
enum { SEEN = sizeof seen / sizeof *seen };

static void check_seen(struct renderer_fixture *s, struct ag_renderer *renderer,
                       struct ag_view *view, struct ag_renderer *alone)
{
    for (int i = 0; i < SEEN; i++) view_check_layer(s, seen[i], renderer, view, alone);
}

// ---- A sun

// The only light: through the open front of the room, from above and from the side.
static void add_sun(struct renderer_fixture *s)
{
    struct ag_light_desc sun;
    const float direction[3] = { 0.3f, -0.6f, -1.0f };
    ag_light_desc_default(&sun, AG_LIGHT_SUN);
    memcpy(sun.direction, direction, sizeof direction);
    for (int i = 0; i < 3; i++) sun.intensity[i] = 20000.0f;
    assert_int_equal(ag_scene_remove_lights(s->scene), AG_OK);
    assert_int_equal(ag_scene_add_light(s->scene, &sun, NULL), AG_OK);
}

// Mean over the view of |got - expected|, relative to the mean of expected.
static double difference(struct renderer_fixture *s, const char *layer, struct ag_view *view,
                         struct ag_renderer *alone)
{
    struct ag_image *got = view_read_layer(s, NULL, view, layer);
    struct ag_image *expected = fixture_read_from(s, alone, layer);
    const double found = fixture_difference(got, expected);
    ag_image_destroy(s->context, got);
    ag_image_destroy(s->context, expected);
    return found;
}

// Cascades fit the first camera: a view from there has the same shadows to the bit; from elsewhere
// it has those of the coarser cascades, whose texels are at most four times as wide.
TEST(a_sun_lights_several_views)
{
    struct renderer_fixture s = fixture_open("none", NULL);
    add_sun(&s);
    struct ag_camera here = s.frame.camera, there = view_other_camera(&here);
    struct ag_renderer *both = view_make_renderer(&s, "lpv:dim=16,cascades=1", 48, 32, NULL);
    struct ag_renderer *first = view_make_renderer(&s, "lpv:dim=16,cascades=1", 48, 32, NULL);
    struct ag_renderer *second = view_make_renderer(&s, "lpv:dim=16,cascades=1", 48, 32, NULL);
    struct ag_view *same = view_make(&s, both, 48, 32), *other = view_make(&s, both, 48, 32);
    for (int i = 0; i < 2; i++) {
        const struct ag_view_frame further[] = { view_in_frame(same, &here),
                                                 view_in_frame(other, &there) };
        view_render(&s, both, &here, further, 2);
        view_render(&s, first, &here, NULL, 0);
        view_render(&s, second, &there, NULL, 0);
    }
    check_seen(&s, both, NULL, first);
    check_seen(&s, both, same, first);
    CHECK(difference(&s, "direct", other, second) < 0.01);
    struct ag_image *lit = view_read_layer(&s, NULL, other, "direct");
    int sunny = 0;
    for (int i = 0; i < 48 * 32; i++) sunny += lit->pixels[3 * i] > 0.0f;
    CHECK(sunny > 100 && sunny < 48 * 32 - 100);
    ag_image_destroy(s.context, lit);
    ag_view_destroy(same);
    ag_view_destroy(other);
    ag_renderer_destroy(both);
    ag_renderer_destroy(first);
    ag_renderer_destroy(second);
    fixture_close(&s);
}

// ---- A program's own G-buffer

static struct ag_gbuffer gbuffer_of(struct renderer_fixture *s, struct ag_renderer *renderer)
{
    return (struct ag_gbuffer){ .depth = fixture_layer(s, renderer, "depth"),
                                .normal = fixture_layer(s, renderer, "normal"),
                                .albedo = fixture_layer(s, renderer, "albedo"),
                                .emissive = fixture_layer(s, renderer, "emissive"),
                                .motion = fixture_layer(s, renderer, "motion") };
}

static struct ag_renderer *make_hosted(struct renderer_fixture *s, const char *gi)
{
    struct ag_renderer *renderer = NULL;
    struct ag_renderer_desc desc = fixture_renderer_desc(gi);
    desc.host_gbuffer = true;
    if (ag_renderer_create(s->device, s->scene, &desc, &renderer) != AG_OK)
        fail_msg("%s", ag_context_last_error(s->context));
    return renderer;
}

// Either camera, or both, with a program's G-buffer: that of a renderer with this camera alone.
static void check_hosted(struct renderer_fixture *s, const char *gi, bool first_is_hosted,
                         bool view_is_hosted)
{
    const int w = FIXTURE_WIDTH, h = FIXTURE_HEIGHT;
    struct ag_camera here = s->frame.camera, there = view_other_camera(&here);
    struct ag_renderer *both =
        first_is_hosted ? make_hosted(s, gi) : view_make_renderer(s, gi, w, h, NULL);
    struct ag_renderer *first = view_make_renderer(s, gi, w, h, NULL);
    struct ag_renderer *second = view_make_renderer(s, gi, w, h, NULL);
    struct ag_view_desc desc;
    ag_view_desc_default(&desc);
    desc.width = w;
    desc.height = h;
    desc.all_layers = true;
    desc.host_gbuffer = view_is_hosted;
    struct ag_view *view = view_create(s, both, &desc);
    for (int i = 0; i < 3; i++) {
        here.eye[0] += 0.01f;
        there.eye[1] += 0.01f;
        view_render(s, first, &here, NULL, 0);
        view_render(s, second, &there, NULL, 0);
        const struct ag_gbuffer of_first = gbuffer_of(s, first), of_second = gbuffer_of(s, second);
        struct ag_view_frame further = view_in_frame(view, &there);
        struct ag_frame_desc frame = s->frame;
        frame.camera = here;
        frame.views = &further;
        frame.view_count = 1;
        if (first_is_hosted) frame.gbuffer = &of_first;
        if (view_is_hosted) further.gbuffer = &of_second;
        if (ag_renderer_render(both, &frame) != AG_OK)
            fail_msg("%s: %s", gi, ag_context_last_error(s->context));
    }
    check_seen(s, both, NULL, first);
    check_seen(s, both, view, second);
    ag_view_destroy(view);
    ag_renderer_destroy(both);
    ag_renderer_destroy(first);
    ag_renderer_destroy(second);
}

TEST(each_view_may_have_a_programs_gbuffer)
{
    static const char *const specs[] = { "lpv:dim=16,cascades=1+vo:temporal=true",
                                         "vct:resolution=32,specular=true,temporal=true" };
    struct renderer_fixture s = fixture_open_lit(NULL);
    for (int i = 0; i < 2; i++)
        for (int hosted = 1; hosted < 4; hosted++)
            check_hosted(&s, specs[i], hosted & 1, hosted & 2);
    fixture_close(&s);
}

// ---- Recorded frames

// Two of them in flight: a view's images are written again before the program has read them.
TEST(views_are_recorded_into_the_programs_command_buffers)
{
    static const char gi[] = "vct:resolution=32,temporal=true+vo:temporal=true";
    enum { FRAMES = 4 };
    struct own_device own;
    test_gpu_require();
    own_device_open(&own, OWN_DEVICE_VALIDATION);
    struct ag_device_adopt adopt = fixture_lend(&own);
    struct renderer_fixture s = fixture_open("none", &adopt);
    const int w = FIXTURE_WIDTH, h = FIXTURE_HEIGHT;
    struct ag_renderer *both = view_make_renderer(&s, gi, w, h, NULL);
    struct ag_renderer *first = view_make_renderer(&s, gi, w, h, NULL);
    struct ag_renderer *second = view_make_renderer(&s, gi, w, h, NULL);
    struct ag_view *view = view_make_lean(&s, both, w, h);
    struct ag_camera here = s.frame.camera, there = view_other_camera(&here);
    struct ag_layer_handle handle;
    assert_int_equal(ag_view_layer_handle(view, "irradiance", &handle), AG_OK);
    uint64_t numbers[FRAMES] = { 0 };
    VkCommandBuffer commands[FRAMES];
    for (int i = 0; i < FRAMES; i++) {
        here.eye[0] += 0.01f;
        there.eye[1] += 0.01f;
        const struct ag_view_frame further = view_in_frame(view, &there);
        struct ag_frame_desc frame = s.frame;
        frame.camera = here;
        frame.views = &further;
        frame.view_count = 1;
        commands[i] = own_device_begin(&own);
        if (ag_renderer_record(both, &frame, commands[i], &numbers[i]) != AG_OK)
            fail_msg("%s", ag_context_last_error(s.context));
        own_device_submit(&own, commands[i]);
        view_render(&s, first, &here, NULL, 0);
        view_render(&s, second, &there, NULL, 0);
    }
    vkQueueWaitIdle(own.queue);
    assert_int_equal(ag_renderer_recorded_done(both, numbers[FRAMES - 1]), AG_OK);
    for (int i = 0; i < SEEN; i++) view_check_layer(&s, seen[i], both, NULL, first);
    view_check_layer(&s, "irradiance", both, view, second);
    view_check_layer(&s, "color", both, view, second);
    view_check_layer(&s, "display", both, view, second);
    ag_view_destroy(view);
    ag_renderer_destroy(both);
    ag_renderer_destroy(first);
    ag_renderer_destroy(second);
    fixture_close(&s);
    own_device_close(&own);
}

// ---- A cut

// A view's cut leaves the motion of objects: it is that of a camera that stays. A cut of the frame
// is one of all views, without motion.
TEST(a_cut_of_a_view_keeps_the_motion_of_objects)
{
    struct renderer_fixture s = fixture_open("none", NULL);
    const int w = FIXTURE_WIDTH, h = FIXTURE_HEIGHT;
    const struct ag_camera here = s.frame.camera, there = view_other_camera(&here);
    struct ag_view *cut = view_make(&s, s.renderer, w, h), *stays = view_make(&s, s.renderer, w, h);
    struct ag_scene_info scene;
    struct ag_instance_info box;
    assert_int_equal(ag_scene_get_info(s.scene, 0, 0.0, &scene), AG_OK);
    const int moved = scene.instances - 1;
    assert_int_equal(ag_scene_get_instance(s.scene, moved, 0, 0.0, &box), AG_OK);
    for (int i = 0; i < 3; i++) {
        struct ag_view_frame further[2] = { view_in_frame(cut, i == 1 ? &there : &here),
                                            view_in_frame(stays, &there) };
        further[0].camera_cut = i == 1;
        struct ag_frame_desc frame = s.frame;
        frame.views = further;
        frame.view_count = 2;
        frame.camera_cut = i == 2;
        box.world_from_mesh[12] += 0.05f;
        if (i > 0)
            assert_int_equal(ag_scene_set_instance_transform(s.scene, moved, box.world_from_mesh),
                             AG_OK);
        assert_int_equal(ag_renderer_render(s.renderer, &frame), AG_OK);
        if (i == 0) continue;
        struct ag_image *of_cut = view_read_layer(&s, NULL, cut, "motion");
        struct ag_image *of_other = view_read_layer(&s, NULL, stays, "motion");
        int moving = 0;
        for (int p = 0; p < w * h; p++) moving += fabsf(of_cut->pixels[3 * p]) > 1e-3f;
        if (i == 1) {
            CHECK(moving > 20 && moving < w * h / 2);
            CHECK(fixture_difference(of_cut, of_other) == 0.0);
        } else
            CHECK(moving == 0);
        ag_image_destroy(s.context, of_cut);
        ag_image_destroy(s.context, of_other);
    }
    ag_view_destroy(cut);
    ag_view_destroy(stays);
    fixture_close(&s);
}
