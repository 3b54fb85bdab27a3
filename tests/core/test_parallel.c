// Parallel loops: each index exactly once, same result for any number of threads.
#include "framework/test.h"

#include "core/parallel.h"
#include "core/rng.h"

#include <stdatomic.h>
#include <string.h>

enum { COUNT = 10007 };

static void count_visit(void *user, size_t i)
{
    atomic_fetch_add_explicit((atomic_int *)user + i, 1, memory_order_relaxed);
}

TEST(each_index_is_visited_once_for_any_grain)
{
    static const size_t grains[] = { 0, 1, 7, 1000, COUNT, COUNT + 1, SIZE_MAX };
    for (size_t g = 0; g < sizeof grains / sizeof *grains; g++) {
        static atomic_int visits[COUNT + 1];
        memset(visits, 0, sizeof visits);
        parallel_for(COUNT, grains[g], count_visit, visits);
        for (int i = 0; i < COUNT; i++) assert_int_equal(visits[i], 1);
        assert_int_equal(visits[COUNT], 0);
    }
}

TEST(empty_loop_calls_nothing)
{
    parallel_for(0, 1, NULL, NULL);
}

static void write_random(void *user, size_t i)
{
    struct rng rng = rng_for((uint32_t)i, 0, 0);
    ((uint32_t *)user)[i] = rng_u32(&rng);
}

TEST(result_equals_that_of_a_serial_loop)
{
    static uint32_t parallel[COUNT], plain[COUNT];
    parallel_for(COUNT, 3, write_random, parallel);
    for (size_t i = 0; i < COUNT; i++) write_random(plain, i);
    assert_memory_equal(parallel, plain, sizeof plain);
}

static void inner_loop(void *user, size_t i)
{
    parallel_for(100, 10, count_visit, (atomic_int *)user + i * 100);
}

TEST(loops_nest)
{
    static atomic_int visits[1000];
    parallel_for(10, 1, inner_loop, visits);
    for (int i = 0; i < 1000; i++) assert_int_equal(visits[i], 1);
}
