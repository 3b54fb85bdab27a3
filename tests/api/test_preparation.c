// Preparations: another thread compiles what a change of the GI spec needs, beside frames.
#include "api/renderer_fixture.h"

#include <pthread.h>
#include <stdlib.h>
#include <string.h>

struct worker {
    struct ag_preparation *preparation;
    enum ag_result result;
    double last;
};

static bool note_progress(void *user, double done)
{
    struct worker *worker = user;
    CHECK(done >= worker->last && done <= 1.0);
    worker->last = done;
    return true;
}

static void *run(void *user)
{
    struct worker *worker = user;
    struct ag_context *context = fixture_context();
    worker->result = ag_preparation_run(worker->preparation, context, note_progress, worker);
    ag_context_destroy(context);
    return NULL;
}

// Frames go on meanwhile.
static void prepare(struct renderer_fixture *s, struct ag_renderer *renderer,
                    const struct ag_frame_desc *frame, const char *gi)
{
    struct worker worker = { .result = AG_ERROR_DEVICE };
    pthread_t thread;
    if (ag_preparation_create(renderer, gi, &worker.preparation) != AG_OK)
        fail_msg("%s: %s", gi, ag_context_last_error(s->context));
    assert_int_equal(pthread_create(&thread, NULL, run, &worker), 0);
    for (int i = 0; i < 5; i++) assert_int_equal(ag_renderer_render(renderer, frame), AG_OK);
    assert_int_equal(pthread_join(thread, NULL), 0);
    assert_int_equal(worker.result, AG_OK);
    CHECK(worker.last == 1.0);
    CHECK(ag_preparation_pipelines(worker.preparation) > 0);
    ag_preparation_destroy(worker.preparation);
}

static uint64_t compiled(const struct renderer_fixture *s)
{
    struct ag_device_counters counters;
    ag_device_get_counters(s->device, &counters);
    return counters.compiled;
}

static void check_prepared_of(struct renderer_fixture *s, struct ag_renderer *renderer,
                              const struct ag_frame_desc *frame, const char *gi)
{
    prepare(s, renderer, frame, gi);
    const uint64_t before = compiled(s);
    if (ag_renderer_set_gi(renderer, gi, NULL, 0) != AG_OK)
        fail_msg("%s: %s", gi, ag_context_last_error(s->context));
    assert_int_equal(ag_renderer_render(renderer, frame), AG_OK);
    if (compiled(s) != before)
        fail_msg("%s: %d pipelines were compiled after the preparation", gi,
                 (int)(compiled(s) - before));
}

static void check_prepared(struct renderer_fixture *s, const char *gi)
{
    check_prepared_of(s, s->renderer, &s->frame, gi);
}

TEST(a_prepared_switch_compiles_nothing)
{
    struct renderer_fixture s = fixture_open_lit("none");
    assert_int_equal(ag_renderer_render(s.renderer, &s.frame), AG_OK);
    struct ag_technique_info info;
    check_prepared(&s, "lpv:dim=16+vo");
    check_prepared(&s, "vct:resolution=32,specular=true,temporal=true+hbao");
    for (int i = 0; ag_technique_get(i, &info); i++) {
        char base[FIXTURE_SPEC];
        fixture_print_base(i, &info, base);
        if (!info.needs_bake) check_prepared(&s, base);
    }
    fixture_close(&s);
}

static struct ag_layer_handle layer(struct renderer_fixture *s, const char *name)
{
    struct ag_layer_handle handle;
    assert_int_equal(ag_renderer_layer_handle(s->renderer, name, &handle), AG_OK);
    return handle;
}

// A history needs the motion of a G-buffer that was converted without it before.
TEST(a_prepared_switch_with_a_converted_gbuffer_compiles_nothing)
{
    struct renderer_fixture s = fixture_open_lit("none");
    struct ag_renderer_desc desc = fixture_renderer_desc("lpv:dim=16");
    struct ag_gbuffer_layout layout;
    struct ag_renderer *hosted = NULL;
    ag_gbuffer_layout_default(&layout);
    desc.motion_layer = false;
    desc.host_gbuffer = true;
    desc.gbuffer_layout = &layout;
    assert_int_equal(ag_renderer_create(s.device, s.scene, &desc, &hosted), AG_OK);
    assert_int_equal(ag_renderer_render(s.renderer, &s.frame), AG_OK);
    const struct ag_gbuffer gbuffer = { .depth = layer(&s, "depth"),
                                        .normal = layer(&s, "normal"),
                                        .albedo = layer(&s, "albedo"),
                                        .emissive = layer(&s, "emissive"),
                                        .motion = layer(&s, "motion") };
    struct ag_frame_desc frame = s.frame;
    frame.gbuffer = &gbuffer;
    assert_int_equal(ag_renderer_render(hosted, &frame), AG_OK);
    check_prepared_of(&s, hosted, &frame, "vct:resolution=32,temporal=true");
    ag_renderer_destroy(hosted);
    fixture_close(&s);
}

static void *own_reallocate(void *user, void *old, size_t bytes)
{
    (void)user;
    if (bytes > 0) return realloc(old, bytes);
    free(old);
    return NULL;
}

TEST(a_context_with_another_allocator_is_refused)
{
    struct renderer_fixture s = fixture_open_lit("none");
    struct ag_preparation *preparation = NULL;
    struct ag_context_desc desc;
    struct ag_context *other = NULL;
    ag_context_desc_default(&desc);
    desc.reallocate = own_reallocate;
    assert_int_equal(ag_context_create(&desc, &other), AG_OK);
    assert_int_equal(ag_preparation_create(s.renderer, "ambient", &preparation), AG_OK);
    assert_int_equal(ag_preparation_run(preparation, other, NULL, NULL), AG_ERROR_ARGUMENT);
    CHECK(strstr(ag_context_last_error(other), "different allocators"));
    ag_preparation_destroy(preparation);
    ag_context_destroy(other);
    fixture_close(&s);
}

// The image is that without a preparation.
TEST(a_prepared_switch_gives_the_same_picture)
{
    static const char gi[] = "vct:resolution=32,temporal=false+vo";
    struct renderer_fixture s = fixture_open_lit("none"), other = fixture_open_lit("none");
    assert_int_equal(ag_renderer_render(s.renderer, &s.frame), AG_OK);
    assert_int_equal(ag_renderer_render(other.renderer, &other.frame), AG_OK);
    check_prepared(&s, gi);
    assert_int_equal(ag_renderer_set_gi(other.renderer, gi, NULL, 0), AG_OK);
    for (int i = 0; i < 5; i++)
        assert_int_equal(ag_renderer_render(other.renderer, &other.frame), AG_OK);
    struct ag_image *image = fixture_read(&s, "color"), *expected = fixture_read(&other, "color");
    CHECK(fixture_difference(image, expected) == 0.0);
    ag_image_destroy(s.context, image);
    ag_image_destroy(other.context, expected);
    fixture_close(&other);
    fixture_close(&s);
}

static bool refuse(void *user, double done)
{
    (void)user;
    (void)done;
    return false;
}

TEST(preparations_end_in_any_order)
{
    struct renderer_fixture s = fixture_open_lit("none");
    struct ag_preparation *preparation = NULL, *late = NULL;
    assert_int_equal(ag_preparation_create(s.renderer, "nonsense", &preparation),
                     AG_ERROR_ARGUMENT);
    CHECK(!preparation);
    assert_int_equal(ag_preparation_create(NULL, "lpv", &preparation), AG_ERROR_ARGUMENT);
    assert_int_equal(ag_preparation_run(NULL, s.context, NULL, NULL), AG_ERROR_ARGUMENT);
    assert_int_equal(ag_preparation_pipelines(NULL), 0);
    ag_preparation_destroy(NULL);
    assert_int_equal(ag_preparation_create(s.renderer, "ambient+ssao", &preparation), AG_OK);
    assert_int_equal(ag_preparation_run(preparation, NULL, refuse, NULL), AG_ERROR_CANCELLED);
    assert_int_equal(ag_preparation_run(preparation, NULL, NULL, NULL), AG_OK); // and on
    ag_preparation_destroy(preparation);
    assert_int_equal(ag_preparation_create(s.renderer, "ambient+ssao", &late), AG_OK);
    ag_renderer_destroy(s.renderer);
    s.renderer = NULL;
    assert_int_equal(ag_preparation_run(late, NULL, NULL, NULL), AG_OK);
    ag_preparation_destroy(late);
    fixture_close(&s);
}
