// Methods as text: what a software device begins with.
#include "viewer/methods/method.h"

#include "framework/test.h"

static void check(const char *gi, const char *lowered)
{
    char out[METHOD_SPEC];
    method_lower(gi, out);
    CHECK_STRING(out, lowered);
}

TEST(techniques_without_options_and_bakes_are_lowered)
{
    check("none", "none");
    check("lpv", "lpv:quality=low");
    check("lpv+vo", "lpv:quality=low+vo:quality=low");
    check("lpv:dim=32+vo", "lpv:dim=32+vo:quality=low");
    check("vct:quality=high", "vct:quality=high");
    check("mrt+gtao", "mrt+gtao");
    check("", "");
    check("unknown", "unknown");
}

TEST(a_method_is_printed_as_it_was_parsed)
{
    struct method method;
    char out[METHOD_SPEC];
    method_init(&method);
    method_parse(&method, "vct:resolution=32+vo:samples=9");
    method_print(&method, out);
    CHECK_STRING(out, "vct:resolution=32+vo:samples=9");
}
