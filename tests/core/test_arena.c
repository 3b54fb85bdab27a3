// The arena allocator.
#include "framework/test.h"

#include "core/arena.h"
#include "core/rng.h"

#include <stdlib.h>
#include <string.h>

TEST(blocks_are_zeroed_aligned_and_do_not_overlap)
{
    enum { BLOCKS = 2000 };
    static unsigned char *blocks[BLOCKS];
    static size_t sizes[BLOCKS];
    struct arena arena;
    arena_init(&arena, test_host());
    struct rng rng = rng_for(1, 0, 0);
    size_t total = 0;
    for (int i = 0; i < BLOCKS; i++) {
        sizes[i] = 1 + rng_u32(&rng) % (i % 50 == 0 ? 200000 : 200);
        blocks[i] = arena_alloc(&arena, sizes[i], 1);
        assert_non_null(blocks[i]);
        assert_int_equal((uintptr_t)blocks[i] % 16, 0);
        for (size_t k = 0; k < sizes[i]; k++) CHECK(blocks[i][k] == 0);
        memset(blocks[i], i & 255, sizes[i]);
        total += sizes[i];
    }
    for (int i = 0; i < BLOCKS; i++)
        for (size_t k = 0; k < sizes[i]; k++) CHECK(blocks[i][k] == (i & 255));
    assert_int_equal(arena.bytes, total);
    arena_finish(&arena);
}

TEST(strings_are_copied)
{
    struct arena arena;
    arena_init(&arena, test_host());
    char text[] = "abc";
    char *copy = arena_strdup(&arena, text);
    text[0] = 'x';
    CHECK_STRING(copy, "abc");
    arena_finish(&arena);
}

TEST(empty_requests_give_distinct_pointers)
{
    struct arena arena;
    arena_init(&arena, test_host());
    void *a = arena_alloc(&arena, 0, 8), *b = arena_alloc(&arena, 8, 0);
    assert_non_null(a);
    assert_non_null(b);
    assert_ptr_not_equal(a, b);
    arena_finish(&arena);
}

TEST(sizes_that_overflow_fail)
{
    struct arena arena;
    struct host host = host_default();
    arena_init(&arena, &host);
    assert_null(arena_alloc(&arena, SIZE_MAX / 2 + 1, 2));
    assert_int_equal(host.failure, FAIL_MEMORY);
    host.failure = FAIL_NONE;
    assert_null(arena_alloc(&arena, SIZE_MAX, 1));
    assert_int_equal(host.failure, FAIL_MEMORY);
    assert_null(arena_alloc(&arena, SIZE_MAX - 40, 1));
    assert_int_equal(arena.bytes, 0);
    arena_finish(&arena);
}

// An allocator that aligns to 8 bytes only and fails on request.
struct misaligned {
    bool fail;
    int live;
};

static void *misaligned_reallocate(void *user, void *old, size_t bytes)
{
    struct misaligned *source = user;
    if (bytes == 0) {
        source->live--;
        free((char *)old - 8);
        return NULL;
    }
    if (source->fail) return NULL;
    assert_null(old);
    source->live++;
    char *block = malloc(bytes + 8);
    return block + 8;
}

TEST(blocks_are_aligned_for_any_alignment_of_the_allocator)
{
    struct misaligned source = { 0 };
    struct host host = { .reallocate = misaligned_reallocate, .user = &source };
    struct arena arena;
    arena_init(&arena, &host);
    for (size_t size = 1; size < 100000; size *= 3)
        assert_int_equal((uintptr_t)arena_alloc(&arena, size, 1) % 16, 0);
    CHECK(source.live > 1);
    arena_finish(&arena);
    assert_int_equal(source.live, 0);
}

TEST(failing_allocator_fails_the_request_and_leaves_the_arena_usable)
{
    struct misaligned source = { .fail = true };
    struct host host = { .reallocate = misaligned_reallocate, .user = &source };
    struct arena arena;
    arena_init(&arena, &host);
    assert_null(arena_alloc(&arena, 10, 1));
    assert_null(arena_strdup(&arena, "text"));
    source.fail = false;
    assert_non_null(arena_alloc(&arena, 10, 1));
    arena_finish(&arena);
    assert_int_equal(source.live, 0);
}

TEST(zeroed_arena_can_be_finished_and_a_finished_one_again)
{
    struct arena arena = { 0 };
    arena_finish(&arena);
    arena_init(&arena, test_host());
    assert_non_null(arena_alloc(&arena, 1, 1));
    arena_finish(&arena);
    assert_int_equal(arena.bytes, 0);
    arena_finish(&arena);
}

#ifdef __SANITIZE_ADDRESS__
#include <sanitizer/asan_interface.h>

TEST(the_address_sanitizer_sees_a_write_beyond_an_allocation)
{
    static const size_t sizes[] = { 1, 12, 16, 100, 4096, 100000 };
    struct arena arena;
    arena_init(&arena, test_host());
    for (int i = 0; i < 6; i++) {
        char *first = arena_alloc(&arena, sizes[i], 1), *second = arena_alloc(&arena, 12, 1);
        assert_null(__asan_region_is_poisoned(first, sizes[i]));
        assert_null(__asan_region_is_poisoned(second, 12));
        CHECK(__asan_address_is_poisoned(first + sizes[i]));
    }
    arena_finish(&arena);
}
#endif
