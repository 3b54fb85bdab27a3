// A test program for structure/check.sh: one case passes, one fails, three are skipped for two
// reasons.
#include "framework/test.h"

TEST(passes)
{
    CHECK(test_time_factor() >= 1.0);
}

TEST(fails)
{
    CHECK(false);
}

TEST(lacks_one_thing)
{
    test_skip("no sample");
}

TEST(lacks_another_thing)
{
    test_skip("no example");
}

TEST(lacks_the_first_thing_too)
{
    test_skip("no sample");
}
