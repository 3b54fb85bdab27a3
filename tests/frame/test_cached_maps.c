// Reused shadow maps and reflective shadow maps are identical to rendered ones.
#include "frame/frame_fixture.h"
#include "scene/scene_edit.h"

#include <stdlib.h>
#include <string.h>

struct map_counter {
    struct frame_fixture fixture;
    int drawn, box;
};

static void record(void *user, struct gpu_cmd *cmd, const struct frame_view *view)
{
    (void)cmd;
    *(int *)user = view->maps_drawn;
}

// A box over a floor with a sun (2 maps), a point light (6) and a spot (1) at the floor's far end.
static void open(struct map_counter *w, struct gpu *gpu, bool keep, uint32_t needs)
{
    struct frame_fixture *s = &w->fixture;
    fixture_init(s, gpu);
    const int white = fixture_matte(s, vec3_of(0.8f, 0.8f, 0.8f));
    fixture_floor(s, 6, white);
    w->box = s->scene->instance_count;
    fixture_box(s, vec3_of(-0.5f, 0.2f, -0.5f), vec3_of(0.5f, 1.2f, 0.5f), false, white);
    fixture_add_sun(s, vec3_of(0.3f, -1, 0.2f), vec3_of(50, 50, 50));
    fixture_add_point(s, vec3_of(2, 3, 2), vec3_of(400, 300, 200));
    fixture_add_spot(s, vec3_of(-5, 2, -5), vec3_of(0, -1, 0), 0.3f, 0.4f, vec3_of(500, 500, 900));
    fixture_look(s, vec3_of(0, 3, 3), vec3_of(0, 0, 0)); // both cascades have maps
    s->options.keep_maps = keep;
    s->indirect = (struct frame_indirect){ .record = record, .user = &w->drawn, .needs = needs };
    fixture_open(s);
    fixture_render(s);
}

static void move_box(struct map_counter *w, float by)
{
    struct frame_fixture *s = &w->fixture;
    s->pose.world_from_node[s->scene->instances[w->box].node].raw[3][0] += by;
}

static void check_same_image(struct map_counter *a, struct map_counter *b)
{
    const size_t bytes = (size_t)3 * a->fixture.width * a->fixture.height * sizeof(float);
    float *p = fixture_read(&a->fixture, READ_DIRECT), *q = fixture_read(&b->fixture, READ_DIRECT);
    CHECK(memcmp(p, q, bytes) == 0);
    free(p);
    free(q);
}

enum { SHADOWS = 2 + 6 + 1, RSMS = 1 + 6 + 1 };

TEST_GPU(a_static_scene_renders_each_map_once)
{
    struct map_counter w;
    open(&w, gpu, true, FRAME_NEEDS_RSM);
    assert_int_equal(w.drawn, SHADOWS + RSMS);
    fixture_render(&w.fixture);
    assert_int_equal(w.drawn, 0);
    // Maps do not depend on intensity.
    w.fixture.lights[0].intensity = vec3_of(5, 5, 5);
    fixture_render(&w.fixture);
    assert_int_equal(w.drawn, 0);
    fixture_finish(&w.fixture);
}

TEST_GPU(changed_maps_are_rendered_again)
{
    struct map_counter reused, rendered;
    open(&reused, gpu, true, FRAME_NEEDS_RSM);
    open(&rendered, gpu, false, FRAME_NEEDS_RSM);
    for (int frame = 0; frame < 6; frame++) {
        struct map_counter *both[] = { &reused, &rendered };
        for (int i = 0; i < 2; i++) {
            struct frame_fixture *s = &both[i]->fixture;
            if (frame == 1) move_box(both[i], 0.7f);
            if (frame == 2) s->lights[1].position.x -= 0.5f;
            if (frame == 3) s->lights[2].direction = glms_vec3_normalize(vec3_of(0.5f, -1, 0.5f));
            if (frame == 4) fixture_look(s, vec3_of(2, 3, 3), vec3_of(2, 0, 0)); // cascades follow
            fixture_render(s);
        }
        assert_int_equal(rendered.drawn, SHADOWS + RSMS);
        check_same_image(&reused, &rendered);
        // The box is outside the spot's map, inside the sun's maps and at least some of the
        // point's.
        if (frame == 1) CHECK(reused.drawn >= 2 + 1 + 2 && reused.drawn <= SHADOWS + RSMS - 2);
        if (frame == 2) assert_int_equal(reused.drawn, 6 + 6);
        if (frame == 3) assert_int_equal(reused.drawn, 1 + 1);
        if (frame == 4) CHECK(reused.drawn >= 1 && reused.drawn <= 3);
        if (frame == 0 || frame == 5) assert_int_equal(reused.drawn, 0);
    }
    fixture_finish(&reused.fixture);
    fixture_finish(&rendered.fixture);
}

// From afar both cascades are the whole scene and share a map; close up the finer one has its own.
TEST_GPU(cascades_of_the_whole_scene_share_a_map)
{
    struct map_counter reused, rendered;
    open(&reused, gpu, true, 0);
    open(&rendered, gpu, false, 0);
    const int others = SHADOWS - 2;
    for (int frame = 0; frame < 4; frame++) {
        struct map_counter *both[] = { &reused, &rendered };
        const bool far = frame % 2 == 0;
        for (int i = 0; i < 2; i++) {
            struct frame_fixture *s = &both[i]->fixture;
            fixture_look(s, far ? vec3_of(0, 60, 70) : vec3_of(0, 3, 3), vec3_of(0, 0, 0));
            fixture_render(s);
        }
        assert_int_equal(rendered.drawn, others + (far ? 1 : 2));
        CHECK(reused.drawn <= (far ? 0 : 1));
        check_same_image(&reused, &rendered);
    }
    fixture_finish(&reused.fixture);
    fixture_finish(&rendered.fixture);
}

TEST_GPU(geometry_that_left_a_map_is_not_in_it)
{
    struct map_counter reused, rendered;
    open(&reused, gpu, true, 0);
    open(&rendered, gpu, false, 0);
    for (int i = 0; i < 2; i++) {
        struct map_counter *w = i == 0 ? &reused : &rendered;
        move_box(w, 30);
        fixture_render(&w->fixture);
    }
    CHECK(reused.drawn > 0);
    check_same_image(&reused, &rendered);
    fixture_finish(&reused.fixture);
    fixture_finish(&rendered.fixture);
}

// Reflective shadow maps that were not requested during a movement are invalid.
TEST_GPU(a_skipped_map_is_rendered_again)
{
    struct map_counter w;
    open(&w, gpu, true, FRAME_NEEDS_RSM);
    w.fixture.indirect.needs = FRAME_NEEDS_MOTION;
    move_box(&w, 1);
    fixture_render(&w.fixture);
    fixture_render(&w.fixture);
    assert_int_equal(w.drawn, 0);
    w.fixture.indirect.needs = FRAME_NEEDS_RSM;
    fixture_render(&w.fixture);
    assert_int_equal(w.drawn, RSMS);
    fixture_finish(&w.fixture);
}

static void follow(struct frame_fixture *s)
{
    assert_true(pose_follow(&s->pose));
    pose_update(&s->pose, -1, 0.0f);
}

static void place_box(struct frame_fixture *s, int box)
{
    const mat4s matrix = glms_translate(glms_mat4_identity(), vec3_of(0.5f, 0, 0));
    assert_true(scene_set_instance_transform(s->scene, box, matrix));
}

static void recolor_box(struct frame_fixture *s, int box)
{
    struct material material = s->scene->materials[scene_mesh_of(s->scene, box)->material];
    material.base_color.x = 0.2f;
    assert_true(scene_set_material(s->scene, scene_mesh_of(s->scene, box)->material, &material));
}

static void reshape_box(struct frame_fixture *s, int box)
{
    const struct mesh *mesh = scene_mesh_of(s->scene, box);
    vec3s positions[64];
    assert_true(!mesh->source && mesh->vertex_count <= 64);
    for (uint32_t v = 0; v < mesh->vertex_count; v++)
        positions[v] = glms_vec3_scale(mesh->positions[v], 0.8f);
    assert_true(scene_update_mesh(s->scene, s->scene->instances[box].mesh, positions, NULL));
}

static void remove_box(struct frame_fixture *s, int box)
{
    scene_remove_instance(s->scene, box);
}

// The box is outside the spot's maps, inside the sun's and at least some of the point's.
static const struct scene_change {
    void (*apply)(struct frame_fixture *s, int box);
    int least, most; // maps that are rendered again
} scene_changes[] = {
    { place_box, 2 + 1 + 2, SHADOWS + RSMS - 2 },
    { recolor_box, RSMS - 2, RSMS }, // the floor has the same material
    { reshape_box, 2 + 1 + 2, SHADOWS + RSMS - 2 },
    { remove_box, 2 + 1 + 2, SHADOWS + RSMS - 2 },
};

TEST_GPU(changes_of_the_scene_render_the_maps_that_show_them)
{
    struct map_counter reused, rendered;
    open(&reused, gpu, true, FRAME_NEEDS_RSM);
    open(&rendered, gpu, false, FRAME_NEEDS_RSM);
    for (size_t i = 0; i < sizeof scene_changes / sizeof *scene_changes; i++) {
        struct map_counter *both[] = { &reused, &rendered };
        for (int k = 0; k < 2; k++) {
            scene_changes[i].apply(&both[k]->fixture, both[k]->box);
            follow(&both[k]->fixture);
            fixture_render(&both[k]->fixture);
        }
        CHECK(reused.drawn >= scene_changes[i].least && reused.drawn <= scene_changes[i].most);
        check_same_image(&reused, &rendered);
        fixture_render(&reused.fixture);
        assert_int_equal(reused.drawn, 0);
        fixture_render(&rendered.fixture);
    }
    fixture_finish(&reused.fixture);
    fixture_finish(&rendered.fixture);
}
