// Device memory: suballocation, bytes by owner, deferred deletes, failing allocations.
#include "framework/gpu_test.h"
#include "gpu_test_shaders.h"

#include "core/rng.h"
#include "gpu/vk.h"

#include <stdlib.h>
#include <string.h>

static uint64_t bytes_of(struct gpu *gpu, const char *owner)
{
    struct gpu_memory list[32];
    int count = gpu_memory_by_owner(gpu, list, 32);
    for (int i = 0; i < count; i++) {
        if (strcmp(list[i].owner, owner) == 0) return list[i].bytes;
    }
    return 0;
}

TEST_GPU(allocations_are_aligned_and_never_overlap)
{
    enum { SLOTS = 60, STEPS = 3000 };
    struct allocation slots[SLOTS] = { 0 };
    struct rng rng = rng_for(4, 5, 6);
    for (int step = 0; step < STEPS; step++) {
        struct allocation *slot = &slots[rng_u32(&rng) % SLOTS];
        if (slot->block) {
            memory_free(gpu, slot);
            continue;
        }
        VkMemoryRequirements needs = { .size = 1 + rng_u32(&rng) % (1u << (4 + rng_u32(&rng) % 17)),
                                       .alignment = 1u << rng_u32(&rng) % 13,
                                       .memoryTypeBits = 1 };
        bool linear = rng_u32(&rng) % 2;
        CHECK(memory_allocate(gpu, &needs, MEMORY_DEVICE, linear, "ranges.any", slot));
        assert_int_equal(slot->offset % needs.alignment, 0);
        for (int i = 0; i < SLOTS; i++) {
            if (&slots[i] == slot || !slots[i].block || slots[i].memory != slot->memory) continue;
            assert_true(slots[i].offset + slots[i].bytes <= slot->offset ||
                        slot->offset + slot->bytes <= slots[i].offset);
        }
    }
    uint64_t sum = 0;
    for (int i = 0; i < SLOTS; i++) sum += slots[i].bytes;
    assert_int_equal(bytes_of(gpu, "ranges"), sum);
    for (int i = 0; i < SLOTS; i++) memory_free(gpu, &slots[i]);
    assert_int_equal(bytes_of(gpu, "ranges"), 0);
    // Free ranges are merged: the block has room for large allocations again.
    VkMemoryRequirements needs = { .size = 15u << 20, .alignment = 16, .memoryTypeBits = 1 };
    struct allocation large[4];
    for (int i = 0; i < 4; i++) {
        CHECK(memory_allocate(gpu, &needs, MEMORY_DEVICE, true, "ranges.large", &large[i]));
        assert_ptr_equal(large[i].memory, large[0].memory);
    }
    for (int i = 0; i < 4; i++) memory_free(gpu, &large[i]);
}

static gpu_image named_image(struct gpu *gpu, const char *name, uint32_t size)
{
    gpu_image image;
    CHECK(gpu_image_create(gpu,
                           &(struct gpu_image_desc){ .name = name,
                                                     .format = GPU_RGBA16F,
                                                     .width = size,
                                                     .height = size,
                                                     .usage = GPU_SAMPLED },
                           &image));
    return image;
}

static gpu_buffer named_buffer(struct gpu *gpu, const char *name, size_t bytes)
{
    gpu_buffer buffer;
    CHECK(gpu_buffer_create(gpu, &(struct gpu_buffer_desc){ name, bytes, GPU_BUFFER_STORAGE },
                            &buffer));
    return buffer;
}

TEST_GPU(bytes_are_counted_by_owner_largest_first)
{
    gpu_image a = named_image(gpu, "grid.colour", 64), b = named_image(gpu, "grid.normal", 64);
    gpu_image c = named_image(gpu, "huge.image", 2048); // a dedicated block
    gpu_owner_push(gpu, "probes");
    gpu_buffer d = named_buffer(gpu, "sh", 1000);
    gpu_owner_pop(gpu);
    assert_in_range(bytes_of(gpu, "grid"), 2 * 64 * 64 * 8, 3 * 64 * 64 * 8);
    assert_in_range(bytes_of(gpu, "huge"), 2048 * 2048 * 8, 2 * 2048 * 2048 * 8);
    assert_in_range(bytes_of(gpu, "probes"), 1000, 4096);
    struct gpu_memory list[32];
    int count = gpu_memory_by_owner(gpu, list, 32);
    for (int i = 1; i < count; i++) assert_true(list[i - 1].bytes >= list[i].bytes);
    assert_int_equal(gpu_memory_by_owner(gpu, list, 1), 1);
    CHECK_STRING(list[0].owner, "huge");
    gpu_image_destroy(gpu, &a);
    gpu_image_destroy(gpu, &b);
    gpu_image_destroy(gpu, &c);
    gpu_buffer_destroy(gpu, &d);
    CHECK(gpu_wait(gpu));
    assert_int_equal(bytes_of(gpu, "grid") + bytes_of(gpu, "huge") + bytes_of(gpu, "probes"), 0);
}

TEST_GPU(objects_in_use_are_freed_after_the_gpu_is_done)
{
    gpu_buffer used = named_buffer(gpu, "used.words", 4000), total = test_gpu_buffer(gpu, 4);
    gpu_pipeline sum = test_gpu_compute(gpu, &shader_test_sum_comp);
    struct gpu_cmd *cmd = gpu_frame_begin(gpu);
    gpu_fill_buffer(cmd, used, 0, 4000, 3);
    gpu_dispatch(cmd, sum, GPU_BIND({ "Words", .buffer = used }, { "Total", .buffer = total }),
                 NULL, 0, 1, 1, 1);
    gpu_buffer_destroy(gpu, &used);
    assert_int_equal(used.id, 0);
    gpu_pipeline_destroy(gpu, &sum);
    gpu_buffer other = named_buffer(gpu, "other.words", 4000); // must not reuse that memory
    assert_true(bytes_of(gpu, "used") > 0);
    CHECK(gpu_frame_end(gpu, cmd));
    uint32_t got;
    CHECK(gpu_buffer_download(gpu, total, 0, &got, 4));
    assert_int_equal(got, 3000);
    CHECK(gpu_wait(gpu));
    assert_int_equal(bytes_of(gpu, "used"), 0);
    gpu_buffer_destroy(gpu, &other);
    gpu_buffer_destroy(gpu, &total);
}

// Blocks have 64 MiB: nine images of 15 MiB take three of them.
TEST_GPU(of_blocks_that_become_empty_one_is_kept)
{
    enum { COUNT = 9 };
    gpu_image images[COUNT];
    const uint32_t before = gpu->memory.block_count;
    for (int round = 0; round < 2; round++) {
        for (int i = 0; i < COUNT; i++)
            images[i] = test_gpu_image(gpu, GPU_2D, GPU_R8, 4096, 3840, 1, 1, GPU_SAMPLED);
        CHECK(gpu->memory.block_count >= before + 2);
        for (int i = 0; i < COUNT; i++) gpu_image_destroy(gpu, &images[(4 * i + 1) % COUNT]);
        CHECK(gpu_wait(gpu));
        CHECK(gpu->memory.block_count <= before + 1);
    }
}

TEST_GPU(objects_are_created_and_destroyed_over_many_frames)
{
    uint32_t expected = 0, got;
    gpu_buffer total = test_gpu_buffer(gpu, 4);
    gpu_pipeline sum = test_gpu_compute(gpu, &shader_test_sum_comp);
    for (uint32_t frame = 0; frame < 20; frame++) {
        struct gpu_cmd *cmd = gpu_frame_begin(gpu);
        gpu_buffer words = named_buffer(gpu, "temporary.words", 400 + 4 * frame);
        gpu_fill_buffer(cmd, words, 0, 400, frame); // the rest is zero
        gpu_dispatch(cmd, sum, GPU_BIND({ "Words", .buffer = words }, { "Total", .buffer = total }),
                     NULL, 0, 1, 1, 1);
        gpu_buffer_destroy(gpu, &words);
        CHECK(gpu_frame_end(gpu, cmd));
        expected += 100 * frame;
    }
    CHECK(gpu_buffer_download(gpu, total, 0, &got, 4));
    assert_int_equal(got, expected);
    assert_int_equal(bytes_of(gpu, "temporary"), 0);
    gpu_buffer_destroy(gpu, &total);
    gpu_pipeline_destroy(gpu, &sum);
}

// A host allocator that fails after `left` allocations and counts live ones.
struct failing_allocator {
    int left, live;
};

static void *failing_reallocate(void *user, void *old, size_t bytes)
{
    struct failing_allocator *allocator = user;
    if (!bytes) {
        if (old) allocator->live--;
        free(old);
        return NULL;
    }
    if (allocator->left-- <= 0) return NULL;
    if (!old) allocator->live++;
    return realloc(old, bytes);
}

// Creates a device, runs one frame and destroys everything. Some failures are no errors: an object
// that cannot be queued for a deferred delete is freed at once.
static bool use_device(struct host *host)
{
    struct gpu *gpu = gpu_create(host, &(struct gpu_desc){ .device = NULL });
    if (!gpu) return false;
    const struct gpu_image_desc image_desc = {
        "test.image", GPU_2D, GPU_R32F, 16, 16, 1, 2, GPU_SAMPLED | GPU_STORAGE, NULL
    };
    const struct gpu_buffer_desc buffer_desc = { "test.buffer", 4, GPU_BUFFER_STORAGE };
    const uint32_t words[4] = { 1, 2, 3, 4 };
    gpu_image image;
    gpu_buffer total;
    gpu_pipeline sum, reduce;
    bool ok = gpu_image_create(gpu, &image_desc, &image);
    ok = gpu_buffer_create(gpu, &buffer_desc, &total) && ok;
    ok = gpu_compute_pipeline_create(gpu, "test.sum", &shader_test_sum_comp, NULL, 0, &sum) && ok;
    ok = gpu_compute_pipeline_create(gpu, "test.reduce", &shader_test_reduce_comp, NULL, 0,
                                     &reduce) &&
         ok;
    struct gpu_cmd *cmd = ok ? gpu_frame_begin(gpu) : NULL;
    if (cmd) {
        gpu_dispatch(cmd, sum,
                     GPU_BIND(gpu_transient(cmd, "Words", words, sizeof words),
                              { "Total", .buffer = total }),
                     NULL, 0, 1, 1, 1);
        gpu_dispatch(cmd, reduce,
                     GPU_BIND({ "above", .image = image, .one_mip = true },
                              { "below", .image = image, .mip = 1 }),
                     NULL, 0, 1, 1, 1);
        ok = gpu_frame_end(gpu, cmd);
    }
    uint32_t got = 0;
    ok = ok && gpu_buffer_download(gpu, total, 0, &got, 4) && got == 10;
    gpu_image_destroy(gpu, &image);
    gpu_buffer_destroy(gpu, &total);
    gpu_pipeline_destroy(gpu, &sum);
    gpu_pipeline_destroy(gpu, &reduce);
    assert_int_equal(gpu_live_objects(gpu), 0);
    gpu_destroy(gpu);
    return ok;
}

TEST(no_failing_allocation_leaks)
{
    test_gpu_require();
    struct host host = host_default();
    struct failing_allocator allocator = { 0 };
    host.reallocate = failing_reallocate;
    host.user = &allocator;
    int n = 0;
    do {
        assert_true(n < 200);
        allocator = (struct failing_allocator){ .left = n++ };
        host.failure = FAIL_NONE;
        bool done = use_device(&host);
        assert_int_equal(allocator.live, 0);
        if (!done) assert_int_equal(host.failure, FAIL_MEMORY);
    } while (allocator.left < 0);
    assert_true(n > 10);
}
