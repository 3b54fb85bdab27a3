// Conversions of floating-point numbers to integers, at the ends of the types and beyond them.
#include "framework/test.h"

#include "core/saturate.h"

#include <limits.h>
#include <math.h>

static const double BEYOND[] = { 0x1p31, 0x1p32, 0x1p63, 0x1p64, 1e300, INFINITY };
enum { BEYOND_COUNT = sizeof BEYOND / sizeof *BEYOND };

TEST(a_value_in_range_is_truncated_towards_zero)
{
    assert_int_equal(int_saturated(2.9, -5, 5), 2);
    assert_int_equal(int_saturated(-2.9, -5, 5), -2);
    assert_int_equal(int_saturated(2147483646.5, INT_MIN, INT_MAX), INT_MAX - 1);
    assert_int_equal(uint32_saturated(2.9, 1, 5), 2);
    CHECK(uint32_saturated(4294967294.5, 0, UINT32_MAX) == UINT32_MAX - 1);
    CHECK(uint64_saturated(0x1p63) == 1ull << 63);
}

TEST(a_value_out_of_range_is_the_nearest_limit)
{
    for (int i = 0; i < BEYOND_COUNT; i++) {
        assert_int_equal(int_saturated(BEYOND[i], -5, 5), 5);
        assert_int_equal(int_saturated(-BEYOND[i], -5, 5), -5);
        assert_int_equal(int_saturated(BEYOND[i], INT_MIN, INT_MAX), INT_MAX);
        assert_int_equal(int_saturated(-BEYOND[i], INT_MIN, INT_MAX), INT_MIN);
        assert_int_equal(uint32_saturated(BEYOND[i], 1, 5), 5);
        assert_int_equal(uint32_saturated(-BEYOND[i], 1, 5), 1);
        CHECK(uint64_saturated(-BEYOND[i]) == 0);
        if (BEYOND[i] >= 0x1p64) CHECK(uint64_saturated(BEYOND[i]) == UINT64_MAX);
    }
    assert_int_equal(uint32_saturated(-0.5, 0, 5), 0);
}

TEST(nan_is_the_lower_limit)
{
    assert_int_equal(int_saturated((double)NAN, -5, 5), -5);
    assert_int_equal(uint32_saturated((double)NAN, 1, 5), 1);
    CHECK(uint64_saturated((double)NAN) == 0);
}
