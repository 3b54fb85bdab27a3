// Which words the program offers to the completion of a shell.
#include "cli/program.h"

#include <string.h>

// Whether the offered words have this one. words: separated by blanks; typed: the last one.
static bool offers(const char *words, const char *typed, const char *word)
{
    const struct run *r = run_expect(0, words, typed, NULL);
    const size_t length = strlen(word);
    CHECK_STRING(r->err, "");
    for (const char *line = r->out; *line; line += strcspn(line, "\n") + 1)
        if (strncmp(line, word, length) == 0 && (line[length] == '\t' || line[length] == '\n'))
            return true;
    return false;
}

TEST(a_spec_goes_on_after_each_separator)
{
    static const char words[] = "__complete render @cornell --gi";
    CHECK(offers(words, "", "lpv") && offers(words, "", "lpv:"));
    CHECK(offers(words, "lpv:", "lpv:steps=") && offers(words, "lpv:", "lpv:quality="));
    CHECK(offers(words, "lpv:steps=4,", "lpv:steps=4,precision="));
    CHECK(offers(words, "lpv:steps=4,", "lpv:steps=4,quality="));
    CHECK(offers(words, "lpv:steps=4+", "lpv:steps=4+vo"));
    CHECK(offers(words, "lpv+vo:", "lpv+vo:quality="));
    CHECK(offers(words, "lpv:emitters=", "lpv:emitters=true"));
}

TEST(what_a_spec_has_is_not_offered_again)
{
    static const char words[] = "__complete compare @cornell --gi";
    CHECK(!offers(words, "lpv:steps=4,", "lpv:steps=4,steps="));
    CHECK(!offers(words, "lpv:quality=low,", "lpv:quality=low,quality="));
    CHECK(!offers(words, "lpv+", "lpv+vct")); // a second source
    CHECK(!offers(words, "vo+", "vo+ssao"));
    CHECK(!offers("__complete render --aov", "color,", "color,color"));
}

TEST(lists_and_scenes_go_on_after_commas)
{
    CHECK(offers("__complete render --aov", "color,depth,", "color,depth,normal"));
    CHECK(offers("__complete reference --aov", "color,", "color,samples"));
    CHECK(!offers("__complete render --aov", "color,", "color,samples"));
    CHECK(offers("__complete render --frame-options", "shadow_size=1024,",
                 "shadow_size=1024,keep_maps="));
    CHECK(offers("__complete reference --tonemap", "a", "agx"));
    CHECK(offers("__complete render --exposure", "h", "highlights"));
    CHECK(offers("__complete info", "@maze:", "@maze:blocks="));
    CHECK(offers("__complete info", "@maze:blocks=3,", "@maze:blocks=3,seed="));
    CHECK(offers("__complete info", "@cornell:light=", "@cornell:light=point"));
}

TEST(names_follow_list_and_help)
{
    CHECK(offers("__complete list", "", "lpv") && offers("__complete list", "", "@maze"));
    CHECK(!offers("__complete list lpv", "", "vct"));
    CHECK(offers("__complete help", "", "cache") && offers("__complete", "", "help"));
}

TEST(files_are_offered_where_they_may_stand)
{
    CHECK(offers("__complete info", "", ":files") && offers("__complete info", "", "@cornell"));
    CHECK(!offers("__complete info", "@co", ":files"));
    CHECK(!offers("__complete info a.glb", "", ":files"));
    CHECK(offers("__complete diff a.exr", "", ":files"));
    CHECK(!offers("__complete diff a.exr b.exr", "", ":files"));
    CHECK(offers("__complete bake --merge a b", "", ":files"));
    CHECK(offers("__complete render --bake", "", ":files"));
    CHECK(offers("__complete render", "--bake=a", ":files"));
    CHECK(!offers("__complete render --size", "", ":files"));
    CHECK(offers("__complete render --environment", "", ":files") &&
          offers("__complete render --environment", "", "sun-sky"));
}

TEST(a_value_after_an_equals_sign_keeps_its_option)
{
    CHECK(offers("__complete render", "--gi=lp", "--gi=lpv"));
    CHECK(offers("__complete render", "--aov=color,de", "--aov=color,depth"));
}

TEST(nothing_is_offered_for_nonsense)
{
    CHECK_STRING(run_expect(0, "__complete", NULL)->out, "");
    CHECK_STRING(run_expect(0, "__complete rendr @co", "x", NULL)->out, "");
    CHECK_STRING(run_expect(0, "__complete render --gi", "no-such:", NULL)->out, "");
    CHECK_STRING(run_expect(0, "__complete info", "@no-such:", NULL)->out, "");
    CHECK_STRING(run_expect(0, "__complete render --gi", "+:=,,", NULL)->out, "");
}
