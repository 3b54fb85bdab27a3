// Frames in flight: the CPU records a frame while the GPU has not begun the one before. A semaphore
// that the test signals keeps the queue from beginning.
#include "api/renderer_fixture.h"

#include <pthread.h>
#include <stdatomic.h>
#include <string.h>
#include <time.h>

enum { LIMIT_S = 20 };

// A queue that executes nothing from gate_close to gate_open. A watchdog opens the gate, so that a
// call that waits for the GPU ends and the test fails instead of hanging.
struct gate {
    struct own_device *own;
    VkSemaphore semaphore;
    uint64_t value; // that opens the gate
    pthread_t watchdog;
    atomic_bool stop, forced;
};

static void signal_gate(const struct gate *gate)
{
    const VkSemaphoreSignalInfo info = { .sType = VK_STRUCTURE_TYPE_SEMAPHORE_SIGNAL_INFO,
                                         .semaphore = gate->semaphore,
                                         .value = gate->value };
    assert_int_equal(vkSignalSemaphore(gate->own->device, &info), VK_SUCCESS);
}

static void *watch(void *user)
{
    struct gate *gate = user;
    for (int i = 0; i < LIMIT_S * 100 * test_time_factor(); i++) {
        if (atomic_load(&gate->stop)) return NULL;
        test_pause_ms(10);
    }
    atomic_store(&gate->forced, true);
    signal_gate(gate);
    return NULL;
}

static void gate_init(struct gate *gate, struct own_device *own)
{
    *gate = (struct gate){ .own = own };
    const VkSemaphoreTypeCreateInfo timeline = { .sType =
                                                     VK_STRUCTURE_TYPE_SEMAPHORE_TYPE_CREATE_INFO,
                                                 .semaphoreType = VK_SEMAPHORE_TYPE_TIMELINE };
    const VkSemaphoreCreateInfo info = { .sType = VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO,
                                         .pNext = &timeline };
    assert_int_equal(vkCreateSemaphore(own->device, &info, NULL, &gate->semaphore), VK_SUCCESS);
}

static void gate_close(struct gate *gate)
{
    gate->value++;
    const VkPipelineStageFlags stages = VK_PIPELINE_STAGE_ALL_COMMANDS_BIT;
    const VkTimelineSemaphoreSubmitInfo timeline = {
        .sType = VK_STRUCTURE_TYPE_TIMELINE_SEMAPHORE_SUBMIT_INFO,
        .waitSemaphoreValueCount = 1,
        .pWaitSemaphoreValues = &gate->value
    };
    const VkSubmitInfo submit = { .sType = VK_STRUCTURE_TYPE_SUBMIT_INFO,
                                  .pNext = &timeline,
                                  .waitSemaphoreCount = 1,
                                  .pWaitSemaphores = &gate->semaphore,
                                  .pWaitDstStageMask = &stages };
    assert_int_equal(vkQueueSubmit(gate->own->queue, 1, &submit, VK_NULL_HANDLE), VK_SUCCESS);
    assert_int_equal(pthread_create(&gate->watchdog, NULL, watch, gate), 0);
}

// Fails the test if the watchdog had to open the gate.
static void gate_open(struct gate *gate)
{
    atomic_store(&gate->stop, true);
    pthread_join(gate->watchdog, NULL);
    if (atomic_load(&gate->forced)) fail_msg("a call waited for the GPU");
    atomic_store(&gate->stop, false);
    signal_gate(gate);
}

static void gate_finish(struct gate *gate)
{
    vkQueueWaitIdle(gate->own->queue);
    vkDestroySemaphore(gate->own->device, gate->semaphore, NULL);
}

static struct ag_finished_frame finished(struct renderer_fixture *s)
{
    struct ag_finished_frame out;
    assert_int_equal(ag_renderer_finished(s->renderer, &out), AG_OK);
    return out;
}

static bool equal_to_fresh(struct renderer_fixture *s, const char *gi)
{
    struct renderer_fixture fresh = fixture_open(gi, NULL);
    assert_int_equal(ag_renderer_render(fresh.renderer, &fresh.frame), AG_OK);
    struct ag_image *a = fixture_read(s, "color"), *b = fixture_read(&fresh, "color");
    const size_t bytes = sizeof *a->pixels * FIXTURE_WIDTH * FIXTURE_HEIGHT * 3;
    const bool equal = memcmp(a->pixels, b->pixels, bytes) == 0;
    ag_image_destroy(s->context, a);
    ag_image_destroy(fresh.context, b);
    fixture_close(&fresh);
    return equal;
}

TEST(a_second_frame_is_rendered_before_the_gpu_begins_the_first)
{
    struct own_device own;
    struct gate gate;
    test_gpu_require();
    own_device_open(&own, 0);
    gate_init(&gate, &own);
    struct ag_device_adopt adopt = fixture_lend(&own);
    struct renderer_fixture s = fixture_open("lpv", &adopt);
    assert_true(finished(&s).frame == 0);
    for (int i = 0; i < 2; i++) // images and pipelines are made in the first frame
        assert_int_equal(ag_renderer_render(s.renderer, &s.frame), AG_OK);
    assert_int_equal(ag_renderer_wait(s.renderer), AG_OK);
    const struct ag_finished_frame before = finished(&s);
    assert_true(before.frame == 2 && before.exposure_ev != 0 && before.scale > 0);

    struct ag_timing timings[64];
    gate_close(&gate);
    for (int i = 0; i < 2; i++) {
        assert_int_equal(ag_renderer_render(s.renderer, &s.frame), AG_OK);
        assert_true(finished(&s).frame == 2);
        CHECK(ag_renderer_finished_timings(s.renderer, timings, 64) > 3);
        CHECK(ag_renderer_memory(s.renderer, NULL, 0) >= 0);
    }
    gate_open(&gate);
    assert_int_equal(ag_renderer_wait(s.renderer), AG_OK);
    assert_true(finished(&s).frame == 4);
    CHECK(finished(&s).exposure_ev == before.exposure_ev);
    CHECK(equal_to_fresh(&s, "lpv"));
    gate_finish(&gate);
    fixture_close(&s);
    own_device_close(&own);
}

// The result of a pick is that of the newest frame that the GPU has finished, however many are
// submitted.
TEST(a_pick_is_read_while_newer_frames_are_in_flight)
{
    static const int first[2] = { 24, 16 }, second[2] = { 20, 20 };
    struct own_device own;
    struct gate gate;
    struct ag_pick pick;
    struct ag_device_counters before, after;
    test_gpu_require();
    own_device_open(&own, 0);
    gate_init(&gate, &own);
    struct ag_device_adopt adopt = fixture_lend(&own);
    struct renderer_fixture s = fixture_open("none", &adopt);
    s.frame.pick = first;
    for (int i = 0; i < 2; i++) assert_int_equal(ag_renderer_render(s.renderer, &s.frame), AG_OK);
    assert_int_equal(ag_renderer_wait(s.renderer), AG_OK);
    ag_device_get_counters(s.device, &before);
    gate_close(&gate);
    s.frame.pick = second;
    const int locks = own.locks;
    for (int i = 0; i < 2; i++) {
        assert_int_equal(ag_renderer_render(s.renderer, &s.frame), AG_OK);
        assert_int_equal(ag_renderer_picked(s.renderer, &pick), AG_OK);
        assert_true(pick.frame == 2 && pick.x == first[0] && pick.y == first[1]);
        assert_true(pick.instance >= 0 && pick.triangle >= 0);
        assert_int_equal(own.locks, locks + i + 1); // one submission: that of the frame
    }
    ag_device_get_counters(s.device, &after);
    assert_true(after.transfers == before.transfers && after.frames == before.frames + 2);
    gate_open(&gate);
    assert_int_equal(ag_renderer_wait(s.renderer), AG_OK);
    assert_int_equal(ag_renderer_picked(s.renderer, &pick), AG_OK);
    assert_true(pick.frame == 4 && pick.x == second[0] && pick.y == second[1]);
    gate_finish(&gate);
    fixture_close(&s);
    own_device_close(&own);
}

TEST(recorded_frames_are_in_flight_until_each_is_reported_done)
{
    enum { MOST = 8 };
    struct own_device own;
    struct gate gate;
    test_gpu_require();
    own_device_open(&own, OWN_DEVICE_VALIDATION);
    gate_init(&gate, &own);
    struct ag_device_adopt adopt = fixture_lend(&own);
    struct renderer_fixture s = fixture_open("lpv", &adopt);
    uint64_t numbers[MOST + 1] = { 0 };
    gate_close(&gate);
    for (int i = 0; i < MOST; i++) {
        VkCommandBuffer commands = own_device_begin(&own);
        assert_int_equal(ag_renderer_record(s.renderer, &s.frame, commands, &numbers[i]), AG_OK);
        assert_true(numbers[i] == (uint64_t)i + 1);
        own_device_submit(&own, commands);
        assert_true(finished(&s).frame == 0);
    }
    VkCommandBuffer surplus = own_device_begin(&own);
    assert_int_equal(ag_renderer_record(s.renderer, &s.frame, surplus, &numbers[MOST]),
                     AG_ERROR_ARGUMENT);
    assert_true(numbers[MOST] == 0);
    assert_int_equal(vkEndCommandBuffer(surplus), VK_SUCCESS);
    gate_open(&gate);
    vkQueueWaitIdle(own.queue);
    assert_true(finished(&s).frame == 0); // not reported
    assert_int_equal(ag_renderer_recorded_done(s.renderer, numbers[4]), AG_OK);
    assert_true(finished(&s).frame == numbers[4]);
    assert_int_equal(ag_renderer_recorded_done(s.renderer, numbers[2]), AG_ERROR_ARGUMENT);
    assert_int_equal(ag_renderer_wait(s.renderer), AG_ERROR_ARGUMENT);
    assert_int_equal(ag_renderer_recorded_done(s.renderer, numbers[MOST - 1]), AG_OK);
    assert_true(finished(&s).frame == numbers[MOST - 1]);
    CHECK(equal_to_fresh(&s, "lpv"));
    gate_finish(&gate);
    fixture_close(&s);
    own_device_close(&own);
}

TEST(memory_and_times_of_two_renderers_of_a_device_are_their_own)
{
    struct renderer_fixture s = fixture_open("lpv", NULL);
    struct ag_renderer_desc desc = fixture_renderer_desc("ambient");
    struct ag_renderer *second = NULL;
    assert_int_equal(ag_renderer_create(s.device, s.scene, &desc, &second), AG_OK);
    assert_int_equal(ag_renderer_render(s.renderer, &s.frame), AG_OK);
    assert_int_equal(ag_renderer_render(second, &s.frame), AG_OK);
    struct ag_memory owners[64];
    uint64_t sum = 0, whole = 0, gpu = 0;
    for (int i = 0, n = ag_renderer_memory(s.renderer, owners, 64); i < n; i++) {
        CHECK(strcmp(owners[i].owner, "ambient") != 0);
        sum += owners[i].bytes;
    }
    for (int i = 0, n = ag_renderer_memory(second, owners, 64); i < n; i++) {
        CHECK(strcmp(owners[i].owner, "lpv") != 0);
        sum += owners[i].bytes;
    }
    for (int i = 0, n = ag_device_memory(s.device, owners, 64); i < n; i++) {
        whole += owners[i].bytes;
        if (strcmp(owners[i].owner, "gpu") == 0) gpu = owners[i].bytes;
    }
    CHECK(gpu > 0 && sum + gpu == whole);

    struct ag_timing timings[64];
    const int count = ag_renderer_timings(s.renderer, timings, 64);
    bool has_lpv = false;
    for (int i = 0; i < count; i++) {
        has_lpv |= strncmp(timings[i].name, "lpv.", 4) == 0;
        CHECK(strncmp(timings[i].name, "ambient.", 8) != 0);
    }
    CHECK(has_lpv);
    ag_renderer_destroy(second);
    fixture_close(&s);
}

TEST(renderers_made_and_destroyed_in_turn_leave_no_memory)
{
    enum { CYCLES = 4 };
    struct renderer_fixture s = fixture_open("lpv", NULL);
    struct ag_renderer_desc desc = fixture_renderer_desc("lpv");
    struct ag_memory owners[64];
    struct ag_device_counters before, counters;
    uint64_t bytes[CYCLES] = { 0 };
    ag_device_get_counters(s.device, &before);
    for (int i = 0; i < CYCLES; i++) {
        ag_renderer_destroy(s.renderer);
        assert_int_equal(ag_renderer_create(s.device, s.scene, &desc, &s.renderer), AG_OK);
        for (int k = 0; k < 2; k++) // each frame in flight has a buffer
            assert_int_equal(ag_renderer_render(s.renderer, &s.frame), AG_OK);
        assert_int_equal(ag_renderer_wait(s.renderer), AG_OK);
        for (int k = 0, n = ag_device_memory(s.device, owners, 64); k < n; k++)
            bytes[i] += owners[k].bytes;
        CHECK(bytes[i] == bytes[0]);
    }
    ag_device_get_counters(s.device, &counters);
    CHECK(counters.compiled > 0 && counters.compiled < counters.pipelines);
    CHECK(counters.images > 0 && counters.buffers > 0 && counters.transfers > 0);
    assert_true(counters.frames == before.frames + 2 * CYCLES);
    fixture_close(&s);
}
