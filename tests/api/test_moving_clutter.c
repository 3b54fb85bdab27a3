// Objects inside blocks that move while drt renders: their light is made by another thread, and
// changes from one frame to the next, whole.
#include "api/moving_box.h"

#include "api/renderer/state.h"
#include "techniques/gi_state.h"
#include "techniques/mrt/mrt_state.h"

#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

enum { PIXELS = FIXTURE_WIDTH * FIXTURE_HEIGHT, MANY_FRAMES = 20000 };

struct moving {
    struct renderer_fixture s;
    struct ag_scene *of_bake;
    struct ag_bake *bake;
    int box; // an instance
    bool wait;
};

static struct ag_renderer *new_renderer(struct moving *m, const char *gi)
{
    struct ag_renderer *renderer = NULL;
    struct ag_renderer_desc desc = fixture_renderer_desc(gi);
    const struct ag_bake *bake = m->bake;
    desc.bakes = &bake;
    desc.bake_count = 1;
    desc.wait_for_updates = m->wait;
    if (ag_renderer_create(m->s.device, m->s.scene, &desc, &renderer) != AG_OK)
        fail_msg("%s", ag_context_last_error(m->s.context));
    return renderer;
}

static struct moving moving_open(const char *gi)
{
    struct moving m = { .s = fixture_open("none", NULL) };
    m.bake = moving_box_bake(m.s.context, &m.of_bake);
    assert_non_null(m.bake);
    m.box = moving_box_add(m.s.scene);
    assert_true(m.box >= 0);
    // It counts as movable from now on.
    assert_int_equal(moving_box_place(m.s.scene, m.box, -1.0f), AG_OK);
    ag_renderer_destroy(m.s.renderer);
    m.s.renderer = new_renderer(&m, gi);
    fixture_last_warning[0] = 0;
    return m;
}

static void moving_close(struct moving *m)
{
    ag_bake_destroy(m->bake);
    ag_scene_destroy(m->of_bake);
    fixture_close(&m->s);
}

static struct ag_image *frame_of(struct moving *m, struct ag_renderer *renderer)
{
    assert_int_equal(ag_renderer_render(renderer, &m->s.frame), AG_OK);
    return fixture_read_from(&m->s, renderer, "irradiance");
}

static struct ag_image *fresh_frame(struct moving *m)
{
    struct ag_renderer *renderer = new_renderer(m, MOVING_BOX_WAIT);
    struct ag_image *image = frame_of(m, renderer);
    ag_renderer_destroy(renderer);
    return image;
}

static bool same(const struct ag_image *a, const struct ag_image *b)
{
    return memcmp(a->pixels, b->pixels, 3 * PIXELS * sizeof(float)) == 0;
}

// Renders until the light is this; counts the frames that showed other light than that of the one
// before.
static int steps_until(struct moving *m, const struct ag_image *expected)
{
    int steps = 0;
    struct ag_image *last = frame_of(m, m->s.renderer);
    for (int i = 0; i < MANY_FRAMES && !same(last, expected); i++) {
        struct ag_image *now = frame_of(m, m->s.renderer);
        steps += !same(now, last);
        ag_image_destroy(m->s.context, last);
        last = now;
    }
    CHECK(same(last, expected));
    ag_image_destroy(m->s.context, last);
    return steps;
}

TEST(light_of_a_moved_object_changes_in_one_frame)
{
    struct moving m = moving_open(MOVING_BOX_BACKGROUND);
    struct ag_image *before = frame_of(&m, m.s.renderer);
    assert_int_equal(moving_box_place(m.s.scene, m.box, 1.0f), AG_OK);
    struct ag_image *after = fresh_frame(&m);
    CHECK(!same(before, after));
    CHECK(steps_until(&m, after) <= 1);
    assert_string_equal(fixture_last_warning, "");
    ag_image_destroy(m.s.context, before);
    ag_image_destroy(m.s.context, after);
    moving_close(&m);
}

TEST(a_renderer_tells_while_light_is_being_made)
{
    struct moving m = moving_open(MOVING_BOX_BACKGROUND);
    CHECK(!ag_renderer_is_updating(NULL) && !ag_renderer_is_updating(m.s.renderer));
    ag_image_destroy(m.s.context, frame_of(&m, m.s.renderer));
    CHECK(!ag_renderer_is_updating(m.s.renderer));
    assert_int_equal(moving_box_place(m.s.scene, m.box, 1.0f), AG_OK);
    struct ag_image *after = fresh_frame(&m), *last = frame_of(&m, m.s.renderer);
    CHECK(ag_renderer_is_updating(m.s.renderer) && !same(last, after));
    for (int i = 0; i < MANY_FRAMES && ag_renderer_is_updating(m.s.renderer); i++) {
        ag_image_destroy(m.s.context, last);
        last = frame_of(&m, m.s.renderer);
    }
    CHECK(same(last, after));
    ag_image_destroy(m.s.context, last);
    ag_image_destroy(m.s.context, after);
    moving_close(&m);
}

TEST(the_last_of_many_moves_counts)
{
    struct moving m = moving_open(MOVING_BOX_BACKGROUND);
    for (int i = 0; i < 20; i++) {
        assert_int_equal(moving_box_place(m.s.scene, m.box, -1.0f + 0.1f * (float)i), AG_OK);
        assert_int_equal(ag_renderer_render(m.s.renderer, &m.s.frame), AG_OK);
    }
    struct ag_image *after = fresh_frame(&m);
    CHECK(steps_until(&m, after) <= 3); // an update that ran, and the last
    ag_image_destroy(m.s.context, after);
    moving_close(&m);
}

TEST(a_renderer_ends_while_it_updates)
{
    struct moving m = moving_open(MOVING_BOX_BACKGROUND);
    for (int i = 0; i < 3; i++) {
        assert_int_equal(moving_box_place(m.s.scene, m.box, 0.3f * (float)i), AG_OK);
        assert_int_equal(ag_renderer_render(m.s.renderer, &m.s.frame), AG_OK);
        ag_renderer_destroy(m.s.renderer);
        m.s.renderer = new_renderer(&m, MOVING_BOX_BACKGROUND);
    }
    moving_close(&m);
}

TEST(a_program_may_wait_for_the_light)
{
    struct moving m = moving_open(MOVING_BOX_BACKGROUND);
    m.wait = true;
    ag_renderer_destroy(m.s.renderer);
    m.s.renderer = new_renderer(&m, MOVING_BOX_BACKGROUND);
    struct ag_image *before = frame_of(&m, m.s.renderer);
    assert_int_equal(moving_box_place(m.s.scene, m.box, 1.0f), AG_OK);
    struct ag_image *now = frame_of(&m, m.s.renderer), *after = fresh_frame(&m);
    CHECK(same(now, after));
    CHECK(!same(now, before));
    ag_image_destroy(m.s.context, before);
    ag_image_destroy(m.s.context, now);
    ag_image_destroy(m.s.context, after);
    moving_close(&m);
}

TEST(walls_that_move_are_said_once)
{
    struct moving m = moving_open(MOVING_BOX_WAIT);
    const float matrix[16] = { 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0.01f, 0, 1 };
    assert_int_equal(ag_scene_set_instance_transform(m.s.scene, 0, matrix), AG_OK);
    ag_image_destroy(m.s.context, frame_of(&m, m.s.renderer));
    CHECK(strstr(fixture_last_warning, "drt: walls changed"));
    fixture_last_warning[0] = 0;
    assert_int_equal(ag_scene_remove_instance(m.s.scene, 0), AG_OK);
    ag_image_destroy(m.s.context, frame_of(&m, m.s.renderer));
    assert_string_equal(fixture_last_warning, "");
    moving_close(&m);
}

// ---- Without memory

static atomic_int allocations_left;

static void *refuse(void *user, void *old, size_t bytes)
{
    (void)user;
    if (bytes == 0) {
        free(old);
        return NULL;
    }
    return atomic_fetch_sub(&allocations_left, 1) > 0 ? realloc(old, bytes) : NULL;
}

TEST(without_memory_the_old_light_stays)
{
    struct moving m = moving_open(MOVING_BOX_WAIT);
    struct mrt *mrt = m.s.renderer->gi->state[0];
    assert_int_equal(moving_box_place(m.s.scene, m.box, 1.0f), AG_OK);
    struct ag_image *after = fresh_frame(&m), *old = NULL;
    mrt->update.host.reallocate = refuse;
    int failures = 0;
    for (int most = 0, ok = 0; !ok; most += 1 + most / 3) {
        // Another place each time: one that was tried is not tried again.
        assert_int_equal(moving_box_place(m.s.scene, m.box, 1.0f + 1e-4f * (float)(1 + failures)),
                         AG_OK);
        atomic_store(&allocations_left, most);
        fixture_last_warning[0] = 0;
        struct ag_image *now = frame_of(&m, m.s.renderer);
        ok = atomic_load(&allocations_left) > 0;
        CHECK(ok || (fixture_last_warning[0] != 0) == (failures == 0)); // said once
        failures += !ok;
        if (!old) old = now;
        if (old != now) ag_image_destroy(m.s.context, now);
    }
    CHECK(failures > 5);
    mrt->update.host.reallocate = NULL;
    assert_int_equal(moving_box_place(m.s.scene, m.box, 1.0f), AG_OK);
    struct ag_image *now = frame_of(&m, m.s.renderer);
    CHECK(same(now, after));
    CHECK(!same(old, after));
    ag_image_destroy(m.s.context, after);
    ag_image_destroy(m.s.context, old);
    ag_image_destroy(m.s.context, now);
    moving_close(&m);
}
