// The host's memory, messages and failures, and checked arithmetic.
#include "framework/test.h"

#include <stdlib.h>
#include <string.h>

// Counts its blocks, fails after `allowed` allocations, and fills new blocks with a pattern.
struct host_fixture {
    int live, allowed;
    char message[2048];
    int messages;
    enum log_level level;
};

static void *fixture_reallocate(void *user, void *old, size_t bytes)
{
    struct host_fixture *fixture = user;
    if (bytes == 0) {
        fixture->live -= old != NULL;
        free(old);
        return NULL;
    }
    if (fixture->allowed-- <= 0) return NULL;
    void *block = realloc(old, bytes);
    if (!old) memset(block, 0xcd, bytes);
    fixture->live += !old;
    return block;
}

static void fixture_log(void *user, enum log_level level, const char *message)
{
    struct host_fixture *fixture = user;
    strncpy(fixture->message, message, sizeof fixture->message - 1);
    fixture->level = level;
    fixture->messages++;
}

static struct host fixture_host(struct host_fixture *fixture)
{
    return (struct host){ .log = fixture_log,
                          .reallocate = fixture_reallocate,
                          .user = fixture,
                          .log_up_to = LOG_WARNING };
}

TEST(checked_arithmetic_fails_on_overflow)
{
    size_t out = 7;
    CHECK(size_mul(0, SIZE_MAX, &out) && out == 0);
    CHECK(size_mul(SIZE_MAX, 1, &out) && out == SIZE_MAX);
    CHECK(size_mul(SIZE_MAX / 2, 2, &out) && out == SIZE_MAX - 1);
    CHECK(size_add(SIZE_MAX - 1, 1, &out) && out == SIZE_MAX);
    out = 7;
    CHECK(!size_mul(SIZE_MAX / 2 + 1, 2, &out) && out == 7);
    CHECK(!size_mul((size_t)1 << 32, (size_t)1 << 32, &out) && out == 7);
    CHECK(!size_add(SIZE_MAX, 1, &out) && out == 7);
}

static void check_all_zero(const unsigned char *bytes, size_t size)
{
    for (size_t i = 0; i < size; i++) CHECK(bytes[i] == 0);
}

TEST(memory_of_any_allocator_is_zeroed)
{
    struct host_fixture fixture = { .allowed = 1 };
    struct host custom = fixture_host(&fixture), libc = host_default();
    unsigned char *a = host_alloc(&custom, 10, 100), *b = host_alloc(&libc, 10, 100);
    check_all_zero(a, 1000);
    check_all_zero(b, 1000);
    host_free(&custom, a);
    host_free(&libc, b);
    assert_int_equal(fixture.live, 0);
}

TEST(empty_requests_give_distinct_pointers)
{
    struct host host = host_default();
    void *a = host_alloc(&host, 0, 8), *b = host_alloc(&host, 8, 0);
    assert_non_null(a);
    assert_non_null(b);
    assert_ptr_not_equal(a, b);
    host_free(&host, a);
    host_free(&host, b);
    host_free(&host, NULL);
}

TEST(sizes_that_overflow_are_refused_without_calling_the_allocator)
{
    struct host_fixture fixture = { .allowed = 100 };
    struct host host = fixture_host(&fixture);
    assert_null(host_alloc(&host, SIZE_MAX / 2 + 1, 2));
    assert_int_equal(host.failure, FAIL_MEMORY);
    assert_null(host_alloc(&host, SIZE_MAX, 1));
    assert_null(host_realloc(&host, NULL, SIZE_MAX / 4, 8));
    assert_int_equal(fixture.allowed, 100);
    assert_int_equal(fixture.messages, 3);
    assert_int_equal(fixture.level, LOG_ERROR);
}

TEST(failing_allocator_gives_null_and_a_message)
{
    struct host_fixture fixture = { .allowed = 0 };
    struct host host = fixture_host(&fixture);
    assert_null(host_alloc(&host, 3, 4));
    CHECK_STRING(fixture.message, "cannot allocate 12 bytes: out of memory");
    assert_int_equal(host.failure, FAIL_MEMORY);
    assert_null(host_strdup(&host, "text"));
    assert_null(host_sprintf(&host, "%d", 5));
    assert_int_equal(fixture.live, 0);
}

TEST(failed_realloc_keeps_the_old_block)
{
    struct host_fixture fixture = { .allowed = 2 };
    struct host host = fixture_host(&fixture);
    char *block = host_alloc(&host, 4, 1);
    memcpy(block, "abc", 4);
    char *grown = host_realloc(&host, block, 1000, 1);
    CHECK_STRING(grown, "abc");
    assert_null(host_realloc(&host, grown, 2000, 1));
    CHECK_STRING(grown, "abc");
    host_free(&host, grown);
    assert_int_equal(fixture.live, 0);
}

TEST(strings_are_copied_and_formatted_at_any_length)
{
    struct host host = host_default();
    char *copy = host_strdup(&host, "a copy");
    CHECK_STRING(copy, "a copy");
    char *text = host_sprintf(&host, "%05000d|%s", 7, copy);
    assert_int_equal(strlen(text), 5007);
    CHECK_STRING(text + 4999, "7|a copy");
    host_free(&host, text);
    host_free(&host, copy);
}

TEST(failure_returns_false_and_stores_kind_and_message)
{
    struct host_fixture fixture = { 0 };
    struct host host = fixture_host(&fixture);
    CHECK(!host_fail(&host, FAIL_FORMAT, "cannot read %s: %d of %d", "a.b", 1, 2));
    assert_int_equal(host.failure, FAIL_FORMAT);
    CHECK_STRING(fixture.message, "cannot read a.b: 1 of 2");
    assert_int_equal(fixture.level, LOG_ERROR);
}

TEST(messages_above_the_level_are_not_sent)
{
    struct host_fixture fixture = { 0 };
    struct host host = fixture_host(&fixture);
    host_log(&host, LOG_INFO, "below the level");
    assert_int_equal(fixture.messages, 0);
    host_log(&host, LOG_WARNING, "at the level");
    assert_int_equal(fixture.messages, 1);
    assert_int_equal(host.failure, FAIL_NONE);
}

TEST(long_messages_are_truncated)
{
    struct host_fixture fixture = { 0 };
    struct host host = fixture_host(&fixture);
    host_fail(&host, FAIL_FILE, "%05000d", 0);
    CHECK(strlen(fixture.message) > 500 && strlen(fixture.message) < 5000);
}

TEST(host_without_log_stores_failures)
{
    struct host host = { 0 };
    CHECK(!host_fail(&host, FAIL_DEVICE, "not logged"));
    assert_int_equal(host.failure, FAIL_DEVICE);
}
