#include "framework/test.h"

#include "core/files/file.h"
#include "techniques/gi_spec.h"
#include "techniques/technique_rules.h"

#include <stdio.h>
#include <string.h>

// Fake techniques of all roles for the parser; never created.
static bool fake_create(void *state, const struct technique_create *how)
{
    return state && how;
}
static void fake_record(void *state, struct gpu_cmd *cmd, const struct frame_view *view)
{
    (void)state, (void)cmd, (void)view;
}
static void fake_destroy(void *state)
{
    (void)state;
}

struct fake_options {
    float bias;
};
static const struct option_row fake_rows[] = { OPTION_ROW(struct fake_options, float32, bias, 1,
                                                          -1e6, 1e6, "", LIVE, "a number") };

static const struct option_alias fake_aliases[] = { { "offset", "bias" }, { NULL, NULL } };

static const struct technique_preset fake_presets[] = { { "low", "bias=0.5" },
                                                        { "high", "bias=8" },
                                                        { NULL, NULL } };

#define FAKE(name_, role_)                                                                         \
    {                                                                                              \
        .name = name_, .title = "fake", .paper = "none", .role = role_, .create = fake_create,     \
        .record = fake_record, .destroy = fake_destroy, .state_size = sizeof(struct fake_options), \
        .options = OPTION_TABLE(struct fake_options, fake_rows, NULL)                              \
    }
static const struct technique still = FAKE("still", ROLE_SOURCE),
                              light = FAKE("light", ROLE_SOURCE), delta = FAKE("delta", ROLE_DELTA),
                              shade = FAKE("shade", ROLE_VISIBILITY),
                              mirror = FAKE("mirror", ROLE_REFLECTION);
static const struct technique graded = {
    .name = "graded",
    .title = "fake",
    .paper = "none",
    .role = ROLE_SOURCE,
    .create = fake_create,
    .record = fake_record,
    .destroy = fake_destroy,
    .state_size = sizeof(struct fake_options),
    .options = OPTION_TABLE(struct fake_options, fake_rows, fake_aliases),
    .presets = fake_presets,
};
static const struct technique *const fakes[] = { &still,  &light,  &delta, &shade,
                                                 &mirror, &graded, NULL };

static void parses_as(const char *text, const char *printed)
{
    struct gi_spec spec;
    CHECK(gi_spec_parse_among(&spec, test_host(), text, fakes));
    char *back = gi_spec_print(&spec);
    CHECK_STRING(back, printed);
    host_free(test_host(), back);
    gi_spec_finish(&spec);
}

static void fails_with(const char *text, const char *words)
{
    struct gi_spec spec;
    test_forget_messages();
    CHECK(!gi_spec_parse_among(&spec, test_host(), text, fakes));
    if (!strstr(test_last_message(), words))
        fail_msg("\"%s\" says \"%s\", not \"%s\"", text, test_last_message(), words);
    assert_int_equal(spec.count, 0);
}

TEST(gi_spec_terms_may_have_any_order)
{
    parses_as("light:bias=2+delta+shade", "light:bias=2+delta:bias=1+shade:bias=1");
    parses_as("shade+light:bias=2+delta", "light:bias=2+delta:bias=1+shade:bias=1");
    parses_as("delta+shade+light:bias=2", "light:bias=2+delta:bias=1+shade:bias=1");
    parses_as("mirror+shade+delta+light", "light:bias=1+delta:bias=1+shade:bias=1+mirror:bias=1");
    parses_as("mirror:bias=3", "still:bias=1+mirror:bias=3");
}

TEST(gi_spec_without_a_source_has_the_first_one)
{
    parses_as("", "still:bias=1");
    parses_as("shade:bias=3", "still:bias=1+shade:bias=3");
}

TEST(gi_spec_of_visibility_or_reflection_alone_stands_on_ambient)
{
    int found = 0;
    for (size_t i = 0; techniques[i]; i++) {
        struct gi_spec spec;
        if (techniques[i]->role < ROLE_VISIBILITY) continue;
        CHECK(gi_spec_parse(&spec, test_host(), techniques[i]->name));
        assert_int_equal(spec.count, 2);
        CHECK_STRING(spec.technique[0]->name, "ambient");
        CHECK(spec.technique[1] == techniques[i] && spec.added_source);
        gi_spec_finish(&spec);
        found++;
    }
    CHECK(found > 1);
    struct gi_spec none;
    CHECK(gi_spec_parse(&none, test_host(), "none+vo"));
    CHECK(!none.added_source && strcmp(none.technique[0]->name, "none") == 0);
    gi_spec_finish(&none);
}

TEST(gi_spec_reads_exponents_with_a_plus)
{
    parses_as("light:bias=1e+3+shade:bias=2.5E+2", "light:bias=1e+03+shade:bias=2.5e+02");
    parses_as("light:bias=1e+03+shade:bias=2.5e+02", "light:bias=1e+03+shade:bias=2.5e+02");
}

TEST(gi_spec_printed_parses_to_the_same)
{
    struct gi_spec spec, again;
    CHECK(gi_spec_parse(&spec, test_host(), "lpv:steps=7,lobe=normal,focus=0.625"));
    char *text = gi_spec_print(&spec);
    CHECK(gi_spec_parse(&again, test_host(), text));
    CHECK(option_difference(&spec.technique[0]->options, spec.options[0], again.options[0]) == -1);
    CHECK(strstr(text, "lpv:bands=2,neighbours=6,dim=32,") == text &&
          strstr(text, ",steps=7,lobe=normal,"));
    host_free(test_host(), text);
    gi_spec_finish(&again);
    gi_spec_finish(&spec);
}

TEST(gi_spec_errors_name_the_mistake_and_the_nearest_name)
{
    fails_with("light,bias=2", "did you mean light:bias=2?");
    fails_with("lihgt,bias=2", "unknown technique lihgt,bias=2");
    fails_with("lighr", "unknown technique lighr: did you mean light?");
    fails_with("xyzzyxyzzy", "known are still, light, delta, shade, mirror, graded");
    fails_with("light:bais=1", "bias");
    fails_with("light:bias=x", "light:bias");
    fails_with("light+still", "at most one source");
    fails_with("shade+light+shade", "at most one visibility");
    fails_with("light+", "a technique's name is missing");
    fails_with("+light", "name is missing");
    fails_with("light++shade", "name is missing");
    fails_with(":bias=1", "name is missing");
    fails_with("delta", "a delta needs a source");
    fails_with("delta+shade", "a delta needs a source");
    fails_with("light +shade", "unknown technique");
    char longest[GI_MAX_TEXT + 2];
    memset(longest, 'a', sizeof longest - 1);
    longest[sizeof longest - 1] = 0;
    fails_with(longest, "longer than");
}

TEST(gi_spec_presets_apply_before_other_options)
{
    parses_as("graded", "graded:bias=1");
    parses_as("graded:quality=low", "graded:bias=0.5");
    parses_as("graded:quality=high,bias=3", "graded:bias=3");
    parses_as("graded:bias=3,quality=high", "graded:bias=3");
    parses_as("graded:quality=high,quality=low+shade", "graded:bias=0.5+shade:bias=1");
}

TEST(gi_spec_accepts_old_names_of_options)
{
    test_forget_messages();
    parses_as("graded:offset=3", "graded:bias=3");
    CHECK_STRING(
        test_last_message(),
        "graded: option offset is now bias; the old name will be removed in the next release");
    parses_as("graded:quality=low,offset=4+shade", "graded:bias=4+shade:bias=1");
}

TEST(gi_spec_errors_of_presets_name_the_known_ones)
{
    fails_with("graded:quality=hihg", "did you mean high? (one of low|high)");
    fails_with("graded:quality=ultimate",
               "cannot set graded:quality to \"ultimate\": it must be one of low|high");
    fails_with("graded:quality=", "graded:quality: no value is given");
    fails_with("graded:quality", "graded:quality: no value is given");
    fails_with("graded:qualty=low", "unknown option graded:qualty: did you mean quality?");
    fails_with("graded:quality=low,,bias=1", "a name is missing");
    fails_with("graded:quality=low,", "a name is missing");
    fails_with("graded:quality=low,bias=x", "graded:bias");
    fails_with("light:quality=low", "light has no presets");
}

// By ascending cost, with known names; the second one is the default, some have no third.
TEST(presets_of_techniques_parse)
{
    static const char *const names[] = { "low", "medium", "high" };
    for (size_t i = 0; techniques[i]; i++) {
        const struct technique_preset *preset = techniques[i]->presets;
        for (int k = 0; preset && (k < 2 || (k < 3 && preset[k].name)); k++) {
            struct gi_spec spec;
            char text[64];
            CHECK_STRING(preset[k].name, names[k]);
            snprintf(text, sizeof text, "%s:quality=%s", techniques[i]->name, preset[k].name);
            CHECK(gi_spec_parse(&spec, test_host(), text));
            CHECK((preset[k].options[0] != 0) == (k != 1));
            gi_spec_finish(&spec);
        }
        CHECK(!preset || !preset[2].name || !preset[3].name);
    }
}

TEST(gi_spec_cut_at_any_length_parses_or_fails)
{
    const char *text = "lpv:dim=16,steps=3,lobe=normal,focus=0.5,offset=1,gain=2e+0";
    char part[128];
    for (size_t length = 0; length <= strlen(text); length++) {
        memcpy(part, text, length);
        part[length] = 0;
        struct gi_spec spec;
        if (gi_spec_parse(&spec, test_host(), part)) gi_spec_finish(&spec);
    }
}

TEST(registry_finds_each_technique_by_its_name)
{
    for (size_t i = 0; techniques[i]; i++) {
        CHECK(technique_is_sound(techniques[i]));
        CHECK(technique_find(techniques[i]->name) == techniques[i]);
    }
    CHECK(technique_find("lpv2") == NULL);
    CHECK(techniques[0] == technique_find("none"));
}

TEST(registry_refuses_incomplete_techniques)
{
    CHECK(technique_is_sound(&light));
    struct technique bad = light;
    bad.name = "Light";
    CHECK(!technique_is_sound(&bad));
    bad = light;
    bad.record = NULL;
    CHECK(!technique_is_sound(&bad));
    bad = light;
    bad.state_size--;
    CHECK(!technique_is_sound(&bad));
    bad = light;
    bad.bake_version = 1;
    CHECK(!technique_is_sound(&bad));
    struct option_row named_quality = fake_rows[0];
    named_quality.name = "quality";
    bad = light;
    bad.options.rows = &named_quality;
    CHECK(!technique_is_sound(&bad));
    const struct technique_debug_view views[] = { { "a", "b", NULL }, { NULL, NULL, NULL } };
    bad = light;
    bad.debug_views = views;
    CHECK(!technique_is_sound(&bad));
    const struct option_alias of_nothing[] = { { "offset", "bais" }, { NULL, NULL } };
    bad = light;
    bad.options.aliases = of_nothing;
    CHECK(!technique_is_sound(&bad));
    const struct option_alias of_a_row[] = { { "bias", "bias" }, { NULL, NULL } };
    bad.options.aliases = of_a_row;
    CHECK(!technique_is_sound(&bad));
    CHECK(technique_is_sound(&graded));
}

TEST(every_option_and_view_is_in_the_readme_of_its_technique)
{
    for (size_t i = 0; techniques[i]; i++) {
        char path[1024], quoted[64];
        const char *folder = techniques[i]->folder ? techniques[i]->folder : techniques[i]->name;
        snprintf(path, sizeof path, TECHNIQUES_DIR "/%s/README.md", folder);
        struct file_bytes text;
        CHECK(file_read(test_host(), path, 0, &text));
        for (size_t k = 0; k < techniques[i]->options.count; k++) {
            snprintf(quoted, sizeof quoted, "`%s`", techniques[i]->options.rows[k].name);
            if (!strstr((const char *)text.data, quoted)) fail_msg("%s lacks %s", path, quoted);
        }
        const struct technique_preset *preset = techniques[i]->presets;
        for (; preset && preset->name; preset++) {
            snprintf(quoted, sizeof quoted, "quality=%s", preset->name);
            if (!strstr((const char *)text.data, quoted)) fail_msg("%s lacks %s", path, quoted);
        }
        const struct technique_debug_view *view = techniques[i]->debug_views;
        for (; view && view->name; view++) {
            snprintf(quoted, sizeof quoted, "`%s`", view->name);
            if (!strstr((const char *)text.data, quoted)) fail_msg("%s lacks %s", path, quoted);
        }
        file_bytes_finish(test_host(), &text);
    }
}
