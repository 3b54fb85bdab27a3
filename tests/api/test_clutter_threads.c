// Objects that move while drt renders in two contexts on two threads, each with a thread that makes
// the light of the new pose. The thread sanitizer watches (preset tsan).
#include "api/moving_box.h"

#include <pthread.h>
#include <string.h>

enum { MOVES = 4, MANY_FRAMES = 20000, BYTES = 3 * FIXTURE_WIDTH * FIXTURE_HEIGHT * sizeof(float) };

struct other {
    pthread_t thread;
    bool failed;
};

// Renders until the light of the last move shows. Nothing is asserted on a thread that is not the
// test's.
static bool render_until_lit(struct ag_context *context, struct ag_renderer *renderer,
                             const struct ag_frame_desc *frame)
{
    struct ag_image *before = NULL;
    bool ok = ag_renderer_read(renderer, "irradiance", &before) == AG_OK, changed = false;
    for (int i = 0; ok && !changed && i < MANY_FRAMES; i++) {
        struct ag_image *now = NULL;
        ok = ag_renderer_render(renderer, frame) == AG_OK &&
             ag_renderer_read(renderer, "irradiance", &now) == AG_OK;
        changed = ok && memcmp(before->pixels, now->pixels, BYTES) != 0;
        ag_image_destroy(context, now);
    }
    ag_image_destroy(context, before);
    return changed;
}

static bool render_moving(struct ag_context *context, struct ag_device *device)
{
    struct ag_scene *scene = NULL, *of_bake = NULL;
    struct ag_renderer *renderer = NULL;
    struct ag_bake *bake = moving_box_bake(context, &of_bake);
    const struct ag_bake *one = bake;
    struct ag_renderer_desc desc = fixture_renderer_desc(MOVING_BOX_BACKGROUND);
    struct ag_frame_desc frame;
    desc.bakes = &one;
    desc.bake_count = 1;
    ag_frame_desc_default(&frame);
    bool ok = bake && ag_scene_load(context, MOVING_BOX_SCENE, &scene) == AG_OK &&
              ag_scene_camera(scene, "main", 0, 0, &frame.camera) == AG_OK;
    const int box = ok ? moving_box_add(scene) : -1;
    ok = ok && box >= 0 && ag_renderer_create(device, scene, &desc, &renderer) == AG_OK;
    for (int i = 0; ok && i < MOVES; i++)
        ok = moving_box_place(scene, box, -1.0f + 0.5f * (float)i) == AG_OK &&
             ag_renderer_render(renderer, &frame) == AG_OK && ag_renderer_wait(renderer) == AG_OK;
    ok = ok && render_until_lit(context, renderer, &frame);
    ag_renderer_destroy(renderer);
    ag_bake_destroy(bake);
    ag_scene_destroy(scene);
    ag_scene_destroy(of_bake);
    return ok;
}

static void *run_other(void *user)
{
    struct other *other = user;
    struct ag_context *context = NULL;
    struct ag_device *device = NULL;
    struct ag_device_desc desc;
    ag_device_desc_default(&desc);
    other->failed = ag_context_create(NULL, &context) != AG_OK ||
                    ag_device_create(context, &desc, &device) != AG_OK ||
                    !render_moving(context, device);
    ag_device_destroy(device);
    ag_context_destroy(context);
    return NULL;
}

TEST(objects_move_in_two_contexts_on_two_threads)
{
    struct other other[2] = { 0 };
    test_gpu_require();
    for (int i = 0; i < 2; i++)
        assert_int_equal(pthread_create(&other[i].thread, NULL, run_other, &other[i]), 0);
    for (int i = 0; i < 2; i++) assert_int_equal(pthread_join(other[i].thread, NULL), 0);
    CHECK(!other[0].failed && !other[1].failed);
}
