// Instances and triangles of pixels through the public interface: the layer, and picked pixels.
#include "api/renderer_fixture.h"

#include <string.h>

enum { PIXELS = FIXTURE_WIDTH * FIXTURE_HEIGHT };

static struct ag_pick picked(struct renderer_fixture *s)
{
    struct ag_pick out;
    assert_int_equal(ag_renderer_picked(s->renderer, &out), AG_OK);
    return out;
}

static void render(struct renderer_fixture *s, const int *pick)
{
    s->frame.pick = pick;
    if (ag_renderer_render(s->renderer, &s->frame) != AG_OK)
        fail_msg("%s", ag_context_last_error(s->context));
}

// A renderer of four triangles of one mesh, left to right, in front of the camera; those with odd
// indices are of a second instance, which is above. A degenerate triangle stands between them.
static struct renderer_fixture open_strip(bool id_layer)
{
    static const float positions[18] = { -2, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 0, 2, 0, 0, 0, 1, 0 };
    static const uint32_t indices[15] = { 0, 1, 5, 1, 2, 5, 2, 2, 2, 2, 3, 5, 3, 4, 5 };
    const float low[16] = { 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, -1, 0, 1 };
    const float high[16] = { 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0.1f, 0, 1 };
    struct renderer_fixture s = fixture_open("none", NULL);
    ag_renderer_destroy(s.renderer);
    ag_scene_destroy(s.scene);
    assert_int_equal(ag_scene_create(s.context, &s.scene), AG_OK);
    struct ag_material_desc matte;
    ag_material_desc_default(&matte);
    int material, mesh, instance;
    assert_int_equal(ag_scene_add_material(s.scene, &matte, &material), AG_OK);
    const struct ag_mesh_desc desc = { .positions = positions,
                                       .vertex_count = 6,
                                       .indices = indices,
                                       .index_count = 15,
                                       .material = material };
    assert_int_equal(ag_scene_add_mesh(s.scene, &desc, &mesh), AG_OK);
    assert_int_equal(ag_scene_add_instance(s.scene, mesh, low, &instance), AG_OK);
    assert_int_equal(instance, 0);
    assert_int_equal(ag_scene_add_instance(s.scene, mesh, high, &instance), AG_OK);
    assert_int_equal(instance, 1);
    const float eye[3] = { 0, 0, 2 }, target[3] = { 0, 0, 0 };
    assert_int_equal(ag_scene_look_at(s.scene, eye, target, 1.2f, &s.frame.camera), AG_OK);
    struct ag_renderer_desc renderer = fixture_renderer_desc("none");
    renderer.id_layer = id_layer;
    assert_int_equal(ag_renderer_create(s.device, s.scene, &renderer, &s.renderer), AG_OK);
    return s;
}

TEST(picked_triangles_are_numbered_as_the_indices_of_the_mesh)
{
    // Above the middle, at a quarter of the triangles' height.
    static const struct {
        int at[2], instance, triangle;
    } pixels[] = { { { 8, 12 }, 1, 0 },  { { 18, 12 }, 1, 1 }, { { 29, 12 }, 1, 3 },
                   { { 39, 12 }, 1, 4 }, { { 8, 24 }, 0, 0 },  { { 39, 24 }, 0, 4 },
                   { { 0, 0 }, -1, -1 } };
    struct renderer_fixture s = open_strip(false);
    const struct ag_pick none = picked(&s);
    CHECK(none.frame == 0 && none.instance == -1 && none.triangle == -1);
    for (size_t i = 0; i < sizeof pixels / sizeof *pixels; i++) {
        render(&s, pixels[i].at);
        assert_int_equal(ag_renderer_wait(s.renderer), AG_OK);
        const struct ag_pick pick = picked(&s);
        assert_true(pick.frame == i + 1);
        assert_true(pick.x == pixels[i].at[0] && pick.y == pixels[i].at[1]);
        if (pick.instance != pixels[i].instance || pick.triangle != pixels[i].triangle)
            fail_msg("pixel %d, %d: instance %d, triangle %d", pick.x, pick.y, pick.instance,
                     pick.triangle);
    }
    fixture_close(&s);
}

TEST(picks_show_instances_that_move_come_and_go)
{
    static const int at[2] = { 8, 12 };
    const float away[16] = { 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 50, 0, 1 };
    const float back[16] = { 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0.1f, 0, 1 };
    struct renderer_fixture s = open_strip(false);
    int expected[] = { 1, -1, 1, -1, 1 }, added;
    for (int step = 0; step < 5; step++) {
        if (step == 1 || step == 2)
            assert_int_equal(ag_scene_set_instance_transform(s.scene, 1, step == 1 ? away : back),
                             AG_OK);
        if (step == 3) assert_int_equal(ag_scene_remove_instance(s.scene, 1), AG_OK);
        if (step == 4) assert_int_equal(ag_scene_add_instance(s.scene, 0, back, &added), AG_OK);
        render(&s, at);
        assert_int_equal(ag_renderer_wait(s.renderer), AG_OK);
        assert_int_equal(picked(&s).instance, expected[step]);
    }
    assert_int_equal(added, 1);
    fixture_close(&s);
}

TEST(picking_submits_and_creates_nothing_besides_the_frame)
{
    enum { FRAMES = 12 };
    static const int at[2] = { 8, 12 };
    struct renderer_fixture s = open_strip(false);
    struct ag_device_counters before, after;
    render(&s, NULL);
    ag_device_get_counters(s.device, &before);
    for (int i = 0; i < FRAMES; i++) render(&s, NULL);
    ag_device_get_counters(s.device, &after);
    assert_true(after.images == before.images && after.pipelines == before.pipelines);
    render(&s, at); // creates the image
    ag_device_get_counters(s.device, &after);
    assert_true(after.images == before.images + 1 && after.pipelines == before.pipelines + 1);
    assert_int_equal(ag_renderer_wait(s.renderer), AG_OK);
    before = after;
    for (int i = 0; i < FRAMES; i++) {
        render(&s, i % 3 ? at : NULL);
        (void)picked(&s);
    }
    ag_device_get_counters(s.device, &after);
    assert_true(after.frames == before.frames + FRAMES);
    before.frames = after.frames;
    before.passes = after.passes;
    CHECK(memcmp(&before, &after, sizeof before) == 0);
    fixture_close(&s);
}

TEST(a_frame_without_ids_has_no_image_of_them)
{
    struct renderer_fixture s = open_strip(false);
    struct ag_image *image;
    struct ag_layer_handle handle;
    render(&s, NULL);
    assert_int_equal(ag_renderer_read(s.renderer, "id", &image), AG_ERROR_ARGUMENT);
    CHECK(strstr(ag_context_last_error(s.context), "id_layer"));
    assert_int_equal(ag_renderer_layer_handle(s.renderer, "id", &handle), AG_ERROR_ARGUMENT);
    assert_int_equal(ag_renderer_set_display(s.renderer, "id"), AG_ERROR_ARGUMENT);
    uint64_t without = 0, with = 0;
    struct ag_memory owners[64];
    for (int i = 0, n = ag_renderer_memory(s.renderer, owners, 64); i < n; i++)
        without += owners[i].bytes;
    fixture_close(&s);
    s = open_strip(true);
    render(&s, NULL);
    for (int i = 0, n = ag_renderer_memory(s.renderer, owners, 64); i < n; i++)
        with += owners[i].bytes;
    CHECK(with >= without + 8 * PIXELS);
    fixture_close(&s);
}

TEST(the_layer_has_the_picked_ids_also_after_a_resize)
{
    struct renderer_fixture s = open_strip(true);
    for (int size = 0; size < 2; size++) {
        if (size) assert_int_equal(ag_renderer_resize(s.renderer, 37, 50), AG_OK);
        render(&s, NULL);
        struct ag_image *ids = fixture_read(&s, "id");
        assert_int_equal(ids->channels, 2);
        for (int i = 0; i < ids->width * ids->height; i += 53) {
            const int at[2] = { i % ids->width, i / ids->width };
            render(&s, at);
            assert_int_equal(ag_renderer_wait(s.renderer), AG_OK);
            const struct ag_pick pick = picked(&s);
            CHECK((float)pick.instance == ids->pixels[2 * i]);
            CHECK((float)pick.triangle == ids->pixels[2 * i + 1]);
        }
        ag_image_destroy(s.context, ids);
    }
    fixture_close(&s);
}

TEST(pixels_outside_the_image_are_refused)
{
    static const int outside[][2] = {
        { -1, 0 }, { 0, -1 }, { FIXTURE_WIDTH, 0 }, { 0, FIXTURE_HEIGHT }
    };
    struct renderer_fixture s = open_strip(false);
    for (size_t i = 0; i < sizeof outside / sizeof *outside; i++) {
        s.frame.pick = outside[i];
        assert_int_equal(ag_renderer_render(s.renderer, &s.frame), AG_ERROR_ARGUMENT);
        CHECK(strstr(ag_context_last_error(s.context), "pick"));
    }
    assert_int_equal(ag_renderer_picked(s.renderer, NULL), AG_ERROR_ARGUMENT);
    fixture_close(&s);
}
