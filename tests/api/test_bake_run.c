// Bakes by the public functions, with a registry whose technique `sample` bakes.
#include "api/counting_allocator.h"
#include "api/renderer_fixture.h"

#include <math.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

struct opened {
    struct ag_context *context;
    struct ag_scene *scene;
};

static struct opened open_scene(const char *name)
{
    struct opened s = { .context = fixture_context() };
    assert_int_equal(ag_scene_load(s.context, name, &s.scene), AG_OK);
    return s;
}

static void close_scene(struct opened *s)
{
    ag_scene_destroy(s->scene);
    ag_context_destroy(s->context);
}

static struct ag_bake *bake_of(const struct opened *s, const char *gi)
{
    struct ag_bake *bake = NULL;
    if (ag_bake_create(s->scene, gi, NULL, &bake) != AG_OK)
        fail_msg("%s", ag_context_last_error(s->context));
    return bake;
}

static const char *path_of(const char *name)
{
    static char paths[16][300];
    static int next;
    char *path = paths[next++ % 16];
    snprintf(path, sizeof paths[0], "%s", test_path(name));
    return path;
}

TEST(bake_is_created_estimated_run_saved_and_loaded)
{
    struct opened s = open_scene("@cornell");
    struct ag_bake *bake = bake_of(&s, "sample:rows=12"), *again = bake_of(&s, "sample:rows=12");
    struct ag_bake_estimate estimate;
    struct ag_bake_info info;
    const char *path = path_of("api.safetensors"), *report = NULL, *name = NULL;
    char technique[32];
    assert_int_equal(ag_bake_technique(s.context, "sample", 0, &name), AG_OK);
    CHECK_STRING(name, "sample");
    assert_int_equal(ag_bake_technique(s.context, "sample", 1, &name), AG_OK);
    CHECK(name == NULL);
    assert_int_equal(ag_bake_estimate_cost(bake, false, &estimate), AG_OK);
    CHECK(isnan(estimate.seconds) && estimate.rays == 12000.0 && estimate.peak_memory_bytes > 0);
    assert_int_equal(ag_bake_estimate_cost(bake, true, &estimate), AG_OK);
    CHECK(estimate.seconds >= 0.0 && estimate.seconds < 60.0);
    assert_int_equal(ag_bake_report(bake, &report), AG_ERROR_ARGUMENT);
    assert_int_equal(ag_bake_save(bake, path, false), AG_ERROR_ARGUMENT);
    assert_int_equal(ag_bake_run(bake, NULL, NULL), AG_OK);
    assert_int_equal(ag_bake_get_info(bake, &info), AG_OK);
    CHECK(info.complete && info.bytes == 64 && strlen(info.key) == 32);
    CHECK_STRING(info.options, "rows=12,wait_ms=0");
    assert_int_equal(ag_bake_report(bake, &report), AG_OK);
    CHECK(strstr(report, "\"tensors\": 1") && strstr(report, "\"name\": \"gather\""));
    assert_int_equal(ag_bake_save(bake, path, true), AG_OK);
    assert_int_equal(ag_bake_file_technique(s.context, path, technique), AG_OK);
    CHECK_STRING(technique, "sample");
    assert_int_equal(ag_bake_load(again, path), AG_OK);
    assert_int_equal(ag_bake_get_info(again, &info), AG_OK);
    CHECK(info.complete && info.seconds >= 0.0);
    ag_bake_destroy(bake);
    ag_bake_destroy(again);
    close_scene(&s);
}

TEST(bake_holds_the_scene_but_not_its_lights)
{
    struct opened s = open_scene("@cornell:light=point");
    struct ag_bake *bake = bake_of(&s, "sample");
    struct ag_material_desc material;
    int index = 0;
    ag_material_desc_default(&material);
    assert_int_equal(ag_scene_remove_lights(s.scene), AG_OK);
    assert_int_equal(ag_scene_add_material(s.scene, &material, &index), AG_ERROR_ARGUMENT);
    CHECK(strstr(ag_context_last_error(s.context), "in use by a bake"));
    ag_bake_destroy(bake);
    assert_int_equal(ag_scene_add_material(s.scene, &material, &index), AG_OK);
    close_scene(&s);
}

// ---- cancelling and parts

static bool cancel(void *user, const struct ag_bake_progress *progress)
{
    *(int *)user += progress->stopping;
    return false;
}

TEST(bake_is_cancelled_by_its_callback_and_goes_on_from_the_checkpoint)
{
    struct opened s = open_scene("@cornell");
    const char *gi = "sample:rows=6,wait_ms=60", *checkpoint = path_of("api.checkpoint"),
               *path = path_of("cancelled.safetensors");
    int runs = 0, stopping = 0;
    for (enum ag_result result = AG_ERROR_CANCELLED; result != AG_OK; runs++) {
        struct ag_bake *bake = bake_of(&s, gi);
        assert_int_equal(ag_bake_set_checkpoint(bake, checkpoint), AG_OK);
        result = ag_bake_run(bake, runs < 2 ? cancel : NULL, &stopping);
        CHECK(result == (runs < 2 ? AG_ERROR_CANCELLED : AG_OK));
        CHECK((access(checkpoint, F_OK) == 0) == true);
        if (result == AG_OK) assert_int_equal(ag_bake_save(bake, path, false), AG_OK);
        ag_bake_destroy(bake);
    }
    CHECK(stopping >= 2 && access(checkpoint, F_OK) != 0);
    close_scene(&s);
}

TEST(bake_in_parts_is_joined_with_what_the_parts_say)
{
    struct opened s = open_scene("@cornell:light=point");
    struct ag_bake_origin origin;
    const char *parts[2] = { path_of("part-0"), path_of("part-1") };
    struct ag_bake_desc desc;
    struct ag_bake *bake = NULL;
    ag_bake_desc_default(&desc);
    desc.seed = 77;
    desc.shard_count = 2;
    for (desc.shard = 0; desc.shard < 2; desc.shard++) {
        assert_int_equal(ag_bake_create(s.scene, "sample:rows=7", &desc, &bake), AG_OK);
        assert_int_equal(ag_bake_run(bake, NULL, NULL), AG_OK);
        assert_int_equal(ag_bake_save_partial(bake, parts[desc.shard]), AG_OK);
        ag_bake_destroy(bake);
    }
    assert_int_equal(ag_bake_partial_origin(s.context, parts[0], &origin), AG_OK);
    CHECK_STRING(origin.scene_name, "@cornell:light=point");
    CHECK(strncmp(origin.gi, "sample:rows=7", 13) == 0 && origin.seed == 77);
    ag_bake_desc_default(&desc);
    desc.seed = origin.seed;
    assert_int_equal(ag_bake_create(s.scene, origin.gi, &desc, &bake), AG_OK);
    for (int i = 0; i < 2; i++) assert_int_equal(ag_bake_merge(bake, parts[i]), AG_OK);
    assert_int_equal(ag_bake_run(bake, NULL, NULL), AG_OK);
    ag_bake_destroy(bake);
    close_scene(&s);
}

// ---- renderers

struct stage {
    struct opened opened;
    struct ag_device *device;
};

static struct stage open_stage(void)
{
    test_gpu_require();
    struct stage stage = { .opened = open_scene("@cornell:light=point") };
    struct ag_device_desc desc;
    ag_device_desc_default(&desc);
    assert_int_equal(ag_device_create(stage.opened.context, &desc, &stage.device), AG_OK);
    return stage;
}

static void close_stage(struct stage *stage)
{
    ag_scene_destroy(stage->opened.scene);
    ag_device_destroy(stage->device);
    ag_context_destroy(stage->opened.context);
}

static enum ag_result create_with(struct stage *stage, const char *gi, const struct ag_bake *bake,
                                  const char *folder)
{
    struct ag_renderer_desc desc = fixture_renderer_desc(gi);
    struct ag_renderer *renderer = NULL;
    const struct ag_bake *const bakes[] = { bake };
    desc.bakes = bakes;
    desc.bake_count = bake ? 1 : 0;
    desc.bake_folder = folder;
    enum ag_result result =
        ag_renderer_create(stage->device, stage->opened.scene, &desc, &renderer);
    CHECK((result == AG_OK) == (renderer != NULL));
    ag_renderer_destroy(renderer);
    return result;
}

static void check_refused(struct stage *stage, const char *gi, const struct ag_bake *bake,
                          const char *folder, const char *why)
{
    assert_int_equal(create_with(stage, gi, bake, folder), AG_ERROR_ARGUMENT);
    if (!strstr(ag_context_last_error(stage->opened.context), why))
        fail_msg("%s", ag_context_last_error(stage->opened.context));
}

TEST(renderer_takes_a_bake_or_finds_it_in_a_folder)
{
    struct stage stage = open_stage();
    struct ag_bake *bake = bake_of(&stage.opened, "sample");
    struct ag_bake_info info;
    char folder[300], file[400];
    check_refused(&stage, "sample", NULL, NULL, "cannot use sample: it needs a bake");
    check_refused(&stage, "sample", bake, NULL, "it is incomplete");
    assert_int_equal(ag_bake_run(bake, NULL, NULL), AG_OK);
    assert_int_equal(create_with(&stage, "sample", bake, NULL), AG_OK);
    check_refused(&stage, "sample:rows=9", bake, NULL, "of other options");
    snprintf(folder, sizeof folder, "%s", test_path("."));
    check_refused(&stage, "sample", NULL, folder, "has no bake for these options and scene");
    ag_bake_get_info(bake, &info);
    snprintf(file, sizeof file, "%s/%s.safetensors", folder, info.key);
    assert_int_equal(ag_bake_save(bake, file, false), AG_OK);
    assert_int_equal(create_with(&stage, "sample", NULL, folder), AG_OK);
    ag_bake_destroy(bake);
    close_stage(&stage);
}

TEST(renderer_refuses_the_bake_of_another_scene)
{
    struct stage stage = open_stage();
    struct ag_scene *other = NULL;
    struct ag_bake *bake = NULL;
    assert_int_equal(ag_scene_load(stage.opened.context, "@diagonal", &other), AG_OK);
    assert_int_equal(ag_bake_create(other, "sample", NULL, &bake), AG_OK);
    assert_int_equal(ag_bake_run(bake, NULL, NULL), AG_OK);
    check_refused(&stage, "sample", bake, NULL, "another scene");
    ag_bake_destroy(bake);
    ag_scene_destroy(other);
    close_stage(&stage);
}

// ---- the program's callbacks

struct guarded {
    atomic_int inside;
    int overlaps; // the allocator of a context need not be thread-safe
    int messages;
    pthread_t thread;
    bool other_thread; // a message came on another thread
};

static void *guarded_reallocate(void *user, void *old, size_t bytes)
{
    struct guarded *guarded = user;
    if (atomic_fetch_add(&guarded->inside, 1) != 0) guarded->overlaps++;
    void *block = bytes > 0 ? realloc(old, bytes) : NULL;
    if (bytes == 0) free(old);
    usleep(50);
    atomic_fetch_sub(&guarded->inside, 1);
    return block;
}

static void guarded_log(void *user, enum ag_log_level level, const char *message)
{
    struct guarded *guarded = user;
    guarded->messages += level == AG_LOG_DEBUG && strncmp(message, "row ", 4) == 0;
    guarded->other_thread |= !pthread_equal(pthread_self(), guarded->thread);
}

static bool go_on(void *user, const struct ag_bake_progress *progress)
{
    struct guarded *guarded = user;
    guarded->other_thread |= !pthread_equal(pthread_self(), guarded->thread);
    return progress->done <= 1.0;
}

TEST(bake_calls_the_callbacks_of_a_program_one_at_a_time)
{
    static struct guarded guarded;
    struct ag_context_desc desc;
    struct opened s = { NULL, NULL };
    guarded.thread = pthread_self();
    ag_context_desc_default(&desc);
    desc.log = guarded_log;
    desc.log_up_to = AG_LOG_DEBUG;
    desc.reallocate = guarded_reallocate;
    desc.user = &guarded;
    assert_int_equal(ag_context_create(&desc, &s.context), AG_OK);
    assert_int_equal(ag_scene_load(s.context, "@cornell", &s.scene), AG_OK);
    struct ag_bake_desc bake_desc;
    struct ag_bake *bake = NULL;
    ag_bake_desc_default(&bake_desc);
    bake_desc.threads = 4;
    bake_desc.checkpoint_every_s = 0.01;
    assert_int_equal(ag_bake_create(s.scene, "sample:rows=300", &bake_desc, &bake), AG_OK);
    assert_int_equal(ag_bake_set_checkpoint(bake, path_of("guarded.checkpoint")), AG_OK);
    assert_int_equal(ag_bake_run(bake, go_on, &guarded), AG_OK);
    ag_bake_destroy(bake);
    close_scene(&s);
    CHECK(guarded.overlaps == 0 && !guarded.other_thread && guarded.messages > 0);
}

static enum ag_result bake_with(struct ag_scene *scene, const char *checkpoint, const char *path)
{
    struct ag_bake_desc desc;
    struct ag_bake *bake = NULL;
    struct ag_bake_estimate estimate;
    const char *report;
    ag_bake_desc_default(&desc);
    desc.threads = 2;
    enum ag_result result = ag_bake_create(scene, "sample:rows=3", &desc, &bake);
    if (result == AG_OK) result = ag_bake_set_checkpoint(bake, checkpoint);
    if (result == AG_OK) result = ag_bake_estimate_cost(bake, true, &estimate);
    if (result == AG_OK) result = ag_bake_run(bake, NULL, NULL);
    if (result == AG_OK) result = ag_bake_report(bake, &report);
    if (result == AG_OK) result = ag_bake_save(bake, path, false);
    if (result == AG_OK) result = ag_bake_load(bake, path);
    ag_bake_destroy(bake);
    return result;
}

TEST(bake_fails_cleanly_at_each_allocation)
{
    struct counting_allocator allocator = { 0 };
    struct ag_context_desc desc;
    struct opened s = { NULL, NULL };
    const char *checkpoint = path_of("scarce.checkpoint"), *path = path_of("scarce.safetensors");
    ag_context_desc_default(&desc);
    desc.reallocate = counting_reallocate;
    desc.user = &allocator;
    assert_int_equal(ag_context_create(&desc, &s.context), AG_OK);
    assert_int_equal(ag_scene_load(s.context, "@diagonal", &s.scene), AG_OK);
    const long before = allocator.blocks;
    long failed = 0;
    do {
        allocator.asked = 0;
        allocator.refuse_at++;
        const enum ag_result result = bake_with(s.scene, checkpoint, path);
        failed += result != AG_OK;
        CHECK(result == AG_OK || result == AG_ERROR_MEMORY);
        CHECK(allocator.blocks == before);
    } while (allocator.asked >= allocator.refuse_at); // until nothing was refused
    CHECK(failed > 30);
    allocator.refuse_at = 0;
    close_scene(&s);
    CHECK(allocator.blocks == 0);
}
