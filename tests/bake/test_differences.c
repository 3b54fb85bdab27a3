// Which options of a bake file differ.
#include "framework/test.h"

#include "bake/bake_state.h"

#include <stdio.h>
#include <string.h>

static void expect(const char *of_file, const char *wanted, const char *text)
{
    char out[200];
    option_differences(of_file, wanted, out, sizeof out);
    CHECK_STRING(out, text);
}

TEST(only_differing_options_are_named)
{
    expect("rays=256,texels=64,cells=8", "rays=512,texels=64,cells=16",
           "rays is 256, not 512, cells is 8, not 16");
    expect("rays=256", "rays=256", "");
    expect("ray=1,rays=2", "rays=1,ray=1", "rays is 2, not 1"); // order and prefixes
}

TEST(options_of_one_side_alone_are_named)
{
    expect("rays=1", "rays=1,cells=8", "cells is not stated, not 8");
    expect("rays=1,cells=8", "rays=1", "cells is 8, an option of another version");
    expect("", "rays=1", "rays is not stated, not 1");
}

TEST(a_long_list_is_cut)
{
    char list[4096] = "", out[200];
    for (int i = 0; i < 100; i++)
        snprintf(list + strlen(list), 32, "%soption%d=1", i ? "," : "", i);
    option_differences(list, "", out, sizeof out);
    CHECK(strlen(out) < sizeof out);
    CHECK(strncmp(out, "option0 is 1, ", 14) == 0);
}
