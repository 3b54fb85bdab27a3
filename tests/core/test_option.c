// Option tables: defaults, parsing, printing, error messages, and the effect of changes.
#include "framework/test.h"

#include "core/option.h"
#include "core/rng.h"

#include <locale.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct options {
#define OPTION OPTION_FIELD
#include "core/options.def"
#undef OPTION
};

#define OPTION(...) OPTION_ROW(struct options, __VA_ARGS__)
static const struct option_row rows[] = {
#include "core/options.def"
};
#undef OPTION

static const struct option_alias aliases[] = { { "factor", "gain" },
                                               { "smooth", "blur" },
                                               { NULL, NULL } };
static const struct option_table table = OPTION_TABLE(struct options, rows, aliases);

static struct options defaults(void)
{
    struct options options;
    option_defaults(&table, &options);
    return options;
}

static bool parse(const char *text, struct options *options)
{
    test_forget_messages();
    return option_parse(test_host(), &table, "lpv", text, options);
}

// Parsing `text` fails with this message and leaves the options unchanged.
static void check_refused(const char *text, const char *message)
{
    struct options options = defaults(), before;
    CHECK(parse("steps=5,gain=2", &options));
    memcpy(&before, &options, sizeof before);
    CHECK(!parse(text, &options));
    CHECK_STRING(test_last_message(), message);
    assert_int_equal(test_host()->failure, FAIL_ARGUMENT);
    assert_memory_equal(&options, &before, sizeof before);
}

TEST(defaults_are_the_table)
{
    struct options options = defaults();
    assert_int_equal(options.steps, 8);
    CHECK(options.gain == 0.8f);
    CHECK(options.blur);
    assert_int_equal(options.quality, 1);
    assert_int_equal(options.dim, -5);
}

TEST(text_sets_the_named_options_alone)
{
    struct options options = defaults();
    CHECK(parse("gain=2.5,quality=high", &options));
    CHECK(options.gain == 2.5f);
    assert_int_equal(options.quality, 2);
    assert_int_equal(options.steps, 8);
    CHECK(parse("", &options));
    CHECK(options.gain == 2.5f);
    CHECK(parse("steps=3,blur=off,steps=4", &options)); // the last one counts
    assert_int_equal(options.steps, 4);
    CHECK(!options.blur);
}

TEST(ranges_include_their_ends)
{
    struct options options = defaults();
    // Rounded to single precision, 0.7 is below 0.7 and 4.4 above 4.4.
    CHECK(parse("steps=1,gain=0.7,dim=-2147483648", &options));
    CHECK(options.gain == 0.7f);
    assert_int_equal(options.dim, INT32_MIN);
    CHECK(parse("steps=32,gain=4.4,dim=2147483647", &options));
    assert_int_equal(options.dim, INT32_MAX);
}

TEST(booleans_have_their_usual_names)
{
    static const char *const yes[] = { "blur=true", "blur=1", "blur=on", "blur=yes" };
    static const char *const no[] = { "blur=false", "blur=0", "blur=off", "blur=no" };
    for (int i = 0; i < 4; i++) {
        struct options options = defaults();
        CHECK(parse(no[i], &options) && !options.blur);
        CHECK(parse(yes[i], &options) && options.blur);
    }
}

TEST(unknown_option_names_the_nearest)
{
    check_refused("step=3", "unknown option lpv:step: did you mean steps?");
    check_refused("GIAN=3", "unknown option lpv:GIAN: did you mean gain?");
    check_refused("zebra=3",
                  "unknown option lpv:zebra: known are steps, gain, blur, quality, dim, bias, "
                  "file");
}

TEST(value_out_of_range_names_the_range)
{
    check_refused("steps=33", "cannot set lpv:steps to \"33\": it must be from 1 to 32 steps");
    check_refused("steps=0", "cannot set lpv:steps to \"0\": it must be from 1 to 32 steps");
    check_refused("gain=4.401", "cannot set lpv:gain to \"4.401\": it must be from 0.7 to 4.4");
    check_refused("gain=nan", "cannot set lpv:gain to \"nan\": it must be from 0.7 to 4.4");
    check_refused("gain=1e999", "cannot set lpv:gain to \"1e999\": it must be from 0.7 to 4.4");
    check_refused("dim=99999999999999999999",
                  "cannot set lpv:dim to \"99999999999999999999\": it must be from -2147483648 to "
                  "2147483647 cells");
}

TEST(value_of_the_wrong_type_names_the_type)
{
    check_refused("steps=2.5", "cannot set lpv:steps to \"2.5\": it must be a whole number");
    check_refused("steps=0x10", "cannot set lpv:steps to \"0x10\": it must be a whole number");
    check_refused("gain=much", "cannot set lpv:gain to \"much\": it must be a number");
    check_refused("blur=maybe", "cannot set lpv:blur to \"maybe\": it must be true or false");
    check_refused("quality=hihg", "cannot set lpv:quality to \"hihg\": did you mean high? "
                                  "(one of low|middle|high)");
    check_refused("quality=hi",
                  "cannot set lpv:quality to \"hi\": it must be one of low|middle|high");
    check_refused("quality=1",
                  "cannot set lpv:quality to \"1\": it must be one of low|middle|high");
}

TEST(text_is_any_path)
{
    static const struct {
        const char *written, *meant;
    } paths[] = {
        { "file=maps/hall.json", "maps/hall.json" },
        { "file=a,file=", "" },
        { "file=C:\\a b=c:d", "C:\\a b=c:d" },
        { "file=a%2Cb%2bc%25d,steps=9", "a,b+c%d" },
        { "file=\xc3\xa9\xe2\x82\xac", "\xc3\xa9\xe2\x82\xac" },
    };
    for (size_t i = 0; i < sizeof paths / sizeof *paths; i++) {
        struct options options = defaults();
        CHECK_STRING(options.file.at, "");
        CHECK(parse(paths[i].written, &options));
        CHECK_STRING(options.file.at, paths[i].meant);
    }
}

TEST(text_that_is_no_path_is_refused)
{
    const char *escapes = "a percent sign is written %25, a comma %2C, a plus sign %2B";
    const char *wrong[] = { "%", "a%2", "%zz", "%2", "%%" };
    char text[512], message[600];
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        snprintf(text, sizeof text, "file=%s", wrong[i]);
        snprintf(message, sizeof message, "cannot set lpv:file to \"%s\": %s", wrong[i], escapes);
        check_refused(text, message);
    }
    check_refused("file=a%00b", "cannot set lpv:file to \"a%00b\": it has a control character");
    check_refused("file=a\nb", "cannot set lpv:file to \"a\\u000ab\": it has a control character");
    snprintf(text, sizeof text, "file=%0256d", 0);
    snprintf(message, sizeof message,
             "cannot set lpv:file to \"%0256d\": it is longer than 255 bytes", 0);
    check_refused(text, message);
    struct options options = defaults();
    snprintf(text, sizeof text, "file=%0255d", 0);
    CHECK(parse(text, &options) && strlen(options.file.at) == 255);
}

TEST(incomplete_text_is_refused)
{
    check_refused("steps", "cannot set lpv:steps: no value is given");
    check_refused("steps=", "cannot set lpv:steps: no value is given");
    const char *nameless =
        "cannot read the options of lpv: a name is missing (key=value,key=value)";
    check_refused("=3", nameless);
    check_refused("steps=3,", nameless);
    check_refused(",steps=3", nameless);
    check_refused("steps=3,,gain=1", nameless);
}

TEST(error_after_valid_values_changes_nothing)
{
    check_refused("steps=9,gain=3,blur=0,quality=low,dim=7,steps=99",
                  "cannot set lpv:steps to \"99\": it must be from 1 to 32 steps");
}

TEST(old_name_sets_the_option_and_warns)
{
    struct options options = defaults();
    CHECK(parse("factor=2.5", &options));
    CHECK(options.gain == 2.5f);
    CHECK_STRING(
        test_last_message(),
        "lpv: option factor is now gain; the old name will be removed in the next release");
    CHECK(parse("gain=3,blur=off", &options));
    CHECK_STRING(test_last_message(), "");
    CHECK(option_find(&table, "factor") == option_find(&table, "gain"));
    CHECK(option_find(&table, "gain") == &rows[1] && !option_find(&table, "zebra"));
}

static void count_warnings(void *count, enum log_level level, const char *message)
{
    (void)message;
    if (level == LOG_WARNING) ++*(int *)count;
}

TEST(old_name_warns_once_per_parse)
{
    int warnings = 0;
    struct host host = { .log = count_warnings, .user = &warnings, .log_up_to = LOG_WARNING };
    struct options options = defaults();
    CHECK(option_parse(&host, &table, "lpv", "factor=2,factor=3,gain=1", &options));
    assert_int_equal(warnings, 1);
    CHECK(option_parse(&host, &table, "lpv", "factor=2,smooth=on", &options));
    assert_int_equal(warnings, 3);
}

TEST(old_name_is_refused_like_the_new_one)
{
    check_refused("factor=much", "cannot set lpv:gain to \"much\": it must be a number");
    check_refused("factor", "cannot set lpv:factor: no value is given");
    check_refused("facto=1",
                  "unknown option lpv:facto: known are steps, gain, blur, quality, dim, bias, "
                  "file");
}

TEST(very_long_text_fails_with_a_message)
{
    enum { LONG = 100000 };
    char *text = malloc(LONG + 1);
    assert_non_null(text);
    memset(text, 'x', LONG);
    text[LONG] = 0;
    struct options options = defaults();
    CHECK(!parse(text, &options));
    memcpy(text, "steps=", 6);
    CHECK(!parse(text, &options));
    free(text);
}

TEST(text_cut_at_any_length_sets_all_or_nothing)
{
    const char *whole = "steps=9,gain=3.25,blur=no,quality=high,dim=-12";
    for (size_t length = 0; length <= strlen(whole); length++) {
        char text[64];
        snprintf(text, sizeof text, "%.*s", (int)length, whole);
        struct options options = defaults(), before = defaults();
        if (!parse(text, &options)) assert_memory_equal(&options, &before, sizeof before);
    }
}

TEST(failing_memory_fails_the_parse)
{
    struct options options = defaults();
    struct host host = host_default();
    struct option_table huge = { rows, table.count, SIZE_MAX, NULL };
    CHECK(!option_parse(&host, &huge, "lpv", "steps=9", &options));
    assert_int_equal(host.failure, FAIL_MEMORY);
    assert_int_equal(options.steps, 8);
}

static struct options random_options(struct rng *rng)
{
    struct options options = defaults();
    options.steps = 1 + (int32_t)(rng_u32(rng) % 32);
    options.gain = 0.7f + 3.7f * rng_float(rng);
    options.bias = ldexpf(rng_float(rng) - 0.5f, (int)(rng_u32(rng) % 240) - 120);
    options.blur = rng_u32(rng) & 1;
    options.quality = (int32_t)(rng_u32(rng) % 3);
    options.dim = (int32_t)rng_u32(rng);
    const int length = (int)(rng_u32(rng) % OPTION_TEXT_SIZE);
    for (int i = 0; i < length; i++) {
        const char c = (char)(' ' + rng_u32(rng) % 224);
        options.file.at[i] = c == 127 ? ',' : c;
    }
    return options;
}

static void print_all(const struct options *options, char *out, size_t size)
{
    size_t used = 0;
    for (size_t i = 0; i < table.count; i++) {
        char value[OPTION_VALUE_SIZE];
        option_print(&rows[i], options, value, sizeof value);
        used +=
            (size_t)snprintf(out + used, size - used, "%s%s=%s", i ? "," : "", rows[i].name, value);
    }
}

TEST(printed_options_read_back_the_same)
{
    struct rng rng = rng_for(1, 0, 0);
    for (int k = 0; k < 1000; k++) {
        struct options options = random_options(&rng), again = defaults();
        char text[1024];
        print_all(&options, text, sizeof text);
        CHECK(parse(text, &again));
        assert_int_equal(option_difference(&table, &options, &again), -1);
    }
}

TEST(printed_numbers_are_the_shortest)
{
    struct options options = defaults();
    char text[64];
    option_print(&rows[1], &options, text, sizeof text);
    CHECK_STRING(text, "0.8");
    options.gain = 1.0f / 3.0f;
    option_print(&rows[1], &options, text, sizeof text);
    CHECK_STRING(text, "0.33333334");
    option_print(&rows[3], &options, text, 4);
    CHECK_STRING(text, "mid");
    CHECK(parse("file=a%2Cbc", &options));
    option_print(&rows[6], &options, text, sizeof text);
    CHECK_STRING(text, "a%2Cbc");
}

TEST(numbers_have_a_dot_in_every_locale)
{
    test_use_decimal_comma();
    struct options options = defaults();
    char text[64];
    CHECK(parse("gain=2.5", &options));
    option_print(&rows[1], &options, text, sizeof text);
    setlocale(LC_ALL, "C");
    CHECK(options.gain == 2.5f);
    CHECK_STRING(text, "2.5");
}

TEST(an_option_for_experts_has_its_effect)
{
    const struct option_row *steps = option_find(&table, "steps"),
                            *dim = option_find(&table, "dim");
    CHECK(steps->expert && steps->effect == INVALIDATE);
    CHECK(!dim->expert && dim->effect == RESIZE);
}

TEST(difference_is_the_strongest_effect)
{
    struct options a = defaults(), b = a;
    assert_int_equal(option_difference(&table, &a, &b), -1);
    b.file.at[0] = 'x';
    assert_int_equal(option_difference(&table, &a, &b), LIVE);
    b = a;
    b.gain = 1.0f;
    assert_int_equal(option_difference(&table, &a, &b), LIVE);
    b.steps = 2;
    assert_int_equal(option_difference(&table, &a, &b), INVALIDATE);
    b.dim = 2;
    assert_int_equal(option_difference(&table, &a, &b), RESIZE);
    b.quality = 0;
    assert_int_equal(option_difference(&table, &a, &b), RECREATE);
    b.dim = a.dim;
    b.blur = false;
    assert_int_equal(option_difference(&table, &b, &a), RECREATE);
}

TEST(copy_of_live_options_leaves_the_others)
{
    struct rng rng = rng_for(2, 0, 0);
    for (int k = 0; k < 100; k++) {
        const struct options from = random_options(&rng), before = random_options(&rng);
        struct options into = before;
        option_copy_live(&table, &from, &into);
        CHECK(into.gain == from.gain && into.bias == from.bias && into.blur == from.blur);
        CHECK(into.steps == from.steps);
        CHECK_STRING(into.file.at, from.file.at);
        CHECK(into.quality == before.quality && into.dim == before.dim);
        CHECK(option_difference(&table, &into, &before) <= INVALIDATE);
    }
}

TEST(nearest_name_allows_small_typing_errors_only)
{
    static const char *const known[] = { "lpv", "vct", "mrt", "iterations", "interleave" };
    struct {
        const char *name, *nearest;
    } cases[] = {
        { "vct", "vct" },
        { "vtc", "vct" },
        { "LPV", "lpv" },
        { "mrtt", "mrt" },
        { "mr", "mrt" },
        { "iteratoin", "iterations" },
        { "interlieve", "interleave" },
        { "xyz", NULL },
        { "", NULL },
        { "v", NULL },
        { "interval", NULL },
        { "vctvctvct", NULL },
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        const char *nearest = nearest_name(cases[i].name, known, 5);
        if (!cases[i].nearest)
            assert_null(nearest);
        else
            CHECK_STRING(nearest ? nearest : "(none)", cases[i].nearest);
    }
    assert_null(nearest_name("vct", known, 0));
}
