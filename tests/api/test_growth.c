// Memory in a long run: objects made and destroyed, frames with moved instances. Nothing grows.
#include "api/renderer_fixture.h"

#include <malloc.h>
#include <math.h>
#include <stdatomic.h>
#include <string.h>
#include <time.h>

static const char SMALL_GI[] = "lpv:dim=8,cascades=1";

// ---- Host memory

struct counted {
    atomic_long blocks, bytes; // drivers have threads of their own
};

// Each block is preceded by its size.
enum { HEADER = 64 };

static void *counted_new(struct counted *c, size_t bytes)
{
    char *block = aligned_alloc(HEADER, (HEADER + bytes + HEADER - 1) / HEADER * HEADER);
    assert_non_null(block);
    memcpy(block, &bytes, sizeof bytes);
    atomic_fetch_add(&c->blocks, 1);
    atomic_fetch_add(&c->bytes, (long)bytes);
    return block + HEADER;
}

static size_t counted_size(const void *block)
{
    size_t bytes;
    memcpy(&bytes, (const char *)block - HEADER, sizeof bytes);
    return bytes;
}

static void counted_free(struct counted *c, void *block)
{
    if (!block) return;
    atomic_fetch_sub(&c->blocks, 1);
    atomic_fetch_sub(&c->bytes, (long)counted_size(block));
    free((char *)block - HEADER);
}

static void *counted_reallocate(void *user, void *old, size_t bytes)
{
    void *block = bytes ? counted_new(user, bytes) : NULL;
    if (block && old) memcpy(block, old, bytes < counted_size(old) ? bytes : counted_size(old));
    counted_free(user, old);
    return block;
}

static void *VKAPI_PTR vulkan_allocate(void *user, size_t size, size_t alignment,
                                       VkSystemAllocationScope scope)
{
    (void)scope;
    assert_true(alignment <= HEADER);
    return counted_new(user, size);
}

static void *VKAPI_PTR vulkan_reallocate(void *user, void *old, size_t size, size_t alignment,
                                         VkSystemAllocationScope scope)
{
    (void)scope;
    assert_true(alignment <= HEADER);
    return counted_reallocate(user, old, size);
}

static void VKAPI_PTR vulkan_free(void *user, void *block)
{
    counted_free(user, block);
}

// ---- What a program holds

struct program {
    struct own_device own;
    struct counted library, vulkan;
    struct ag_context *context;
    struct ag_device *device;
};

static void program_open(struct program *p)
{
    *p = (struct program){ 0 };
    test_gpu_require();
    own_device_open(&p->own, 0);
    struct ag_context_desc context;
    ag_context_desc_default(&context);
    context.reallocate = counted_reallocate;
    context.user = &p->library;
    assert_int_equal(ag_context_create(&context, &p->context), AG_OK);
    const VkAllocationCallbacks callbacks = { .pUserData = &p->vulkan,
                                              .pfnAllocation = vulkan_allocate,
                                              .pfnReallocation = vulkan_reallocate,
                                              .pfnFree = vulkan_free };
    struct ag_device_adopt adopt = fixture_lend(&p->own);
    adopt.vk_allocation_callbacks = &callbacks;
    struct ag_device_desc device;
    ag_device_desc_default(&device);
    device.adopt = &adopt;
    assert_int_equal(ag_device_create(p->context, &device, &p->device), AG_OK);
}

static void program_close(struct program *p)
{
    ag_device_destroy(p->device);
    ag_context_destroy(p->context);
    assert_true(p->library.blocks == 0 && p->vulkan.blocks == 0);
    own_device_close(&p->own);
}

struct held {
    long library_blocks, library_bytes, vulkan_blocks;
    uint64_t gpu_bytes;
    size_t process_bytes;
};

static struct held held_by(struct program *p)
{
    struct ag_memory owners[64];
    struct held out = { .library_blocks = p->library.blocks,
                        .library_bytes = p->library.bytes,
                        .vulkan_blocks = p->vulkan.blocks,
                        .process_bytes = mallinfo2().uordblks };
    for (int i = 0, n = ag_device_memory(p->device, owners, 64); i < n; i++)
        out.gpu_bytes += owners[i].bytes;
    return out;
}

static void check_same(const struct held *before, const struct held *now, int step)
{
    if (now->library_blocks != before->library_blocks ||
        now->library_bytes != before->library_bytes || now->gpu_bytes != before->gpu_bytes ||
        now->vulkan_blocks != before->vulkan_blocks)
        fail_msg("step %d: library %ld blocks, %ld bytes, Vulkan %ld blocks, GPU %llu bytes; "
                 "before %ld, %ld, %ld, %llu",
                 step, now->library_blocks, now->library_bytes, now->vulkan_blocks,
                 (unsigned long long)now->gpu_bytes, before->library_blocks, before->library_bytes,
                 before->vulkan_blocks, (unsigned long long)before->gpu_bytes);
}

// Memory of the driver is not counted exactly: it has caches.
static void check_process(const struct held *before, const struct held *now)
{
    const double grown = (double)now->process_bytes - (double)before->process_bytes;
    if (grown > 256e3) fail_msg("the process has %g more bytes", grown);
}

static struct ag_renderer *open_renderer(struct program *p, struct ag_scene *scene, const char *gi)
{
    struct ag_renderer *renderer = NULL;
    const struct ag_renderer_desc desc = fixture_renderer_desc(gi);
    if (ag_renderer_create(p->device, scene, &desc, &renderer) != AG_OK)
        fail_msg("%s", ag_context_last_error(p->context));
    return renderer;
}

static struct ag_scene *open_scene(struct program *p, struct ag_frame_desc *frame)
{
    struct ag_scene *scene = NULL;
    assert_int_equal(ag_scene_load(p->context, "@cornell:light=point", &scene), AG_OK);
    ag_frame_desc_default(frame);
    assert_int_equal(ag_scene_camera(scene, "main", 0, 0, &frame->camera), AG_OK);
    return scene;
}

// The least readings of successive windows of ten cycles. What leaks adds to each window. Drivers
// hold a destroyed renderer's blocks until a later cycle, and caches grow once: they add to some
// windows.
enum { WINDOW = 10 };
static void check_windows(const double *least, int count)
{
    double grown = INFINITY;
    for (int i = 1; i < count; i++) grown = fmin(grown, least[i] - least[i - 1]);
    if (grown > 88e3) fail_msg("the process has %g more bytes after each ten cycles", grown);
}

TEST(fifty_cycles_of_creation_and_destruction_leave_nothing)
{
    enum { CYCLES = 50, WARM = 10, WINDOWS = (CYCLES - WARM) / WINDOW };
    double least[WINDOWS] = { INFINITY, INFINITY, INFINITY, INFINITY };
    struct program p;
    struct held warm = { 0 };
    program_open(&p);
    for (int i = 0; i < CYCLES; i++) {
        struct ag_frame_desc frame;
        struct ag_scene *scene = open_scene(&p, &frame);
        struct ag_renderer *renderer = open_renderer(&p, scene, SMALL_GI);
        for (int k = 0; k < 2; k++) assert_int_equal(ag_renderer_render(renderer, &frame), AG_OK);
        assert_int_equal(ag_renderer_wait(renderer), AG_OK);
        ag_renderer_destroy(renderer);
        ag_scene_destroy(scene);
        const struct held now = held_by(&p);
        if (i == WARM) warm = now;
        if (i < WARM) continue;
        check_same(&warm, &now, i);
        double *window = &least[(i - WARM) / WINDOW];
        *window = fmin(*window, (double)now.process_bytes);
    }
    check_windows(least, WINDOWS);
    program_close(&p);
}

// ---- Moved instances

// The same places again after PERIOD steps: what is drawn depends on them.
enum { PERIOD = 10 };
static void place(struct ag_scene *scene, int instance, int step)
{
    const float angle = 0.1f * (float)(step % PERIOD), c = cosf(angle), s = sinf(angle);
    const float matrix[16] = { c, 0, -s, 0, 0, 1, 0, 0, s, 0, c, 0, 0, 0.1f, 0, 1 };
    assert_int_equal(ag_scene_set_instance_transform(scene, instance, matrix), AG_OK);
}

TEST(a_thousand_frames_with_a_moved_instance_create_nothing)
{
    enum { FRAMES = 1001, WARM = PERIOD, CHECKED = 33 * PERIOD };
    struct program p;
    struct ag_frame_desc frame;
    struct held warm = { 0 };
    struct ag_device_counters before = { 0 }, after;
    program_open(&p);
    struct ag_scene *scene = open_scene(&p, &frame);
    struct ag_renderer *renderer = open_renderer(&p, scene, SMALL_GI);
    for (int i = 0; i < FRAMES; i++) {
        place(scene, 1, i);
        assert_int_equal(ag_renderer_render(renderer, &frame), AG_OK);
        if (i % CHECKED != WARM) continue;
        assert_int_equal(ag_renderer_wait(renderer), AG_OK);
        const struct held now = held_by(&p);
        if (i == WARM) warm = now;
        if (i == WARM) ag_device_get_counters(p.device, &before);
        check_same(&warm, &now, i);
        if (i == FRAMES - 1) check_process(&warm, &now);
    }
    ag_device_get_counters(p.device, &after);
    assert_true(after.frames == before.frames + FRAMES - 1 - WARM);
    assert_true(after.passes > before.passes);
    before.frames = after.frames;
    before.passes = after.passes;
    CHECK(memcmp(&before, &after, sizeof before) == 0);
    ag_renderer_destroy(renderer);
    ag_scene_destroy(scene);
    program_close(&p);
}

static double thread_s(void)
{
    struct timespec now;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

// Processor time of this thread for a frame, the least of many: other load only adds to it.
static double frame_s(struct ag_renderer *renderer, const struct ag_frame_desc *frame,
                      struct ag_scene *scene, int step)
{
    const double begun = thread_s();
    if (scene) place(scene, 1, step);
    assert_int_equal(ag_renderer_render(renderer, frame), AG_OK);
    const double s = thread_s() - begun;
    assert_int_equal(ag_renderer_wait(renderer), AG_OK);
    return s;
}

// Without lights: shadow maps in which an instance has moved are drawn once more. bench/moving has
// the times in milliseconds.
TEST(a_moved_instance_among_many_costs_little_beside_the_frame)
{
    enum { INSTANCES = 300, FRAMES = 60 };
    struct program p;
    struct ag_frame_desc frame;
    program_open(&p);
    struct ag_scene *scene = open_scene(&p, &frame);
    assert_int_equal(ag_scene_remove_lights(scene), AG_OK);
    for (int i = 0; i < INSTANCES; i++) {
        const float x = 0.01f * (float)(i % 20), z = 0.01f * (float)(i / 20);
        const float matrix[16] = { 0.1f, 0, 0, 0, 0, 0.1f, 0, 0, 0, 0, 0.1f, 0, x, 1, z, 1 };
        assert_int_equal(ag_scene_add_instance(scene, i % 5, matrix, NULL), AG_OK);
    }
    struct ag_renderer *renderer = open_renderer(&p, scene, "none");
    double still = INFINITY, moved = INFINITY;
    for (int i = 0; i < 4; i++) (void)frame_s(renderer, &frame, scene, i);
    for (int i = 0; i < FRAMES; i++) {
        still = fmin(still, frame_s(renderer, &frame, NULL, 0));
        moved = fmin(moved, frame_s(renderer, &frame, scene, i));
    }
    if (moved > 1.5 * still) fail_msg("%g ms with, %g ms without", 1e3 * moved, 1e3 * still);
    ag_renderer_destroy(renderer);
    ag_scene_destroy(scene);
    program_close(&p);
}
