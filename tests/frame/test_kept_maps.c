// Maps of lights that are kept are those that would be drawn.
#include "frame/studio.h"

#include <stdlib.h>
#include <string.h>

struct watched {
    struct studio studio;
    int drawn, box;
};

static void record(void *user, struct gpu_cmd *cmd, const struct frame_view *view)
{
    (void)cmd;
    *(int *)user = view->maps_drawn;
}

// A box over a floor, in the light of a sun (3 maps), a point (6) and a spot (1) that looks at the
// floor's far end.
static void open(struct watched *w, struct gpu *gpu, bool keep, uint32_t needs)
{
    struct studio *s = &w->studio;
    studio_init(s, gpu);
    const int white = studio_matte(s, vec3_of(0.8f, 0.8f, 0.8f));
    studio_floor(s, 6, white);
    w->box = s->scene->instance_count;
    studio_box(s, vec3_of(-0.5f, 0.2f, -0.5f), vec3_of(0.5f, 1.2f, 0.5f), false, white);
    studio_add_sun(s, vec3_of(0.3f, -1, 0.2f), vec3_of(50, 50, 50));
    studio_add_point(s, vec3_of(2, 3, 2), vec3_of(400, 300, 200));
    studio_add_spot(s, vec3_of(-5, 2, -5), vec3_of(0, -1, 0), 0.3f, 0.4f, vec3_of(500, 500, 900));
    studio_look(s, vec3_of(0, 6, 7), vec3_of(0, 0, 0));
    s->options.keep_maps = keep;
    s->indirect = (struct frame_indirect){ .record = record, .user = &w->drawn, .needs = needs };
    studio_open(s);
    studio_render(s);
}

static void move_box(struct watched *w, float by)
{
    struct studio *s = &w->studio;
    s->pose.world_from_node[s->scene->instances[w->box].node].raw[3][0] += by;
}

static void check_same_picture(struct watched *a, struct watched *b)
{
    const size_t bytes = (size_t)3 * a->studio.width * a->studio.height * sizeof(float);
    float *p = studio_read(&a->studio, READ_DIRECT), *q = studio_read(&b->studio, READ_DIRECT);
    CHECK(memcmp(p, q, bytes) == 0);
    free(p);
    free(q);
}

enum { SHADOWS = 3 + 6 + 1, RSMS = 1 + 6 + 1 };

TEST_GPU(what_stands_still_is_drawn_once)
{
    struct watched w;
    open(&w, gpu, true, FRAME_NEEDS_RSM);
    assert_int_equal(w.drawn, SHADOWS + RSMS);
    studio_render(&w.studio);
    assert_int_equal(w.drawn, 0);
    // How strong a light is does not show in its maps.
    w.studio.lights[0].intensity = vec3_of(5, 5, 5);
    studio_render(&w.studio);
    assert_int_equal(w.drawn, 0);
    studio_finish(&w.studio);
}

TEST_GPU(what_has_changed_is_drawn_again)
{
    struct watched kept, anew;
    open(&kept, gpu, true, FRAME_NEEDS_RSM);
    open(&anew, gpu, false, FRAME_NEEDS_RSM);
    for (int frame = 0; frame < 6; frame++) {
        struct watched *both[] = { &kept, &anew };
        for (int i = 0; i < 2; i++) {
            struct studio *s = &both[i]->studio;
            if (frame == 1) move_box(both[i], 0.7f);
            if (frame == 2) s->lights[1].position.x -= 0.5f;
            if (frame == 3) s->lights[2].direction = glms_vec3_normalize(vec3_of(0.5f, -1, 0.5f));
            if (frame == 4) studio_look(s, vec3_of(1, 5, 6), vec3_of(0, 0, 0)); // cascades follow
            studio_render(s);
        }
        assert_int_equal(anew.drawn, SHADOWS + RSMS);
        check_same_picture(&kept, &anew);
        // The spot looks past the box; the sun and four or more faces of the point do not.
        if (frame == 1) CHECK(kept.drawn >= 3 + 1 + 2 && kept.drawn <= SHADOWS + RSMS - 2);
        if (frame == 2) assert_int_equal(kept.drawn, 6 + 6);
        if (frame == 3) assert_int_equal(kept.drawn, 1 + 1);
        if (frame == 4) CHECK(kept.drawn >= 1 && kept.drawn <= 3);
        if (frame == 0 || frame == 5) assert_int_equal(kept.drawn, 0);
    }
    studio_finish(&kept.studio);
    studio_finish(&anew.studio);
}

// What moves out of a map leaves it.
TEST_GPU(what_has_left_a_map_is_no_longer_in_it)
{
    struct watched kept, anew;
    open(&kept, gpu, true, 0);
    open(&anew, gpu, false, 0);
    for (int i = 0; i < 2; i++) {
        struct watched *w = i == 0 ? &kept : &anew;
        move_box(w, 30);
        studio_render(&w->studio);
    }
    CHECK(kept.drawn > 0);
    check_same_picture(&kept, &anew);
    studio_finish(&kept.studio);
    studio_finish(&anew.studio);
}

// Reflective shadow maps that nobody asked for while something moved are not those of last time.
TEST_GPU(a_map_that_was_left_out_is_drawn_again)
{
    struct watched w;
    open(&w, gpu, true, FRAME_NEEDS_RSM);
    w.studio.indirect.needs = FRAME_NEEDS_MOTION;
    move_box(&w, 1);
    studio_render(&w.studio);
    studio_render(&w.studio);
    assert_int_equal(w.drawn, 0);
    w.studio.indirect.needs = FRAME_NEEDS_RSM;
    studio_render(&w.studio);
    assert_int_equal(w.drawn, RSMS);
    studio_finish(&w.studio);
}
