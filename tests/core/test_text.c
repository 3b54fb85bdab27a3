// Control characters of names, and UTF-8.
#include "framework/test.h"

#include "core/text.h"

#include <string.h>

static const char *escaped(const char *text)
{
    static char out[256];
    const size_t length = text_escape(text, out, sizeof out);
    assert_int_equal(length, strlen(out));
    return out;
}

TEST(printable_text_stays)
{
    CHECK_STRING(escaped(""), "");
    CHECK_STRING(escaped("a file\\name (1).gltf"), "a file\\name (1).gltf");
    CHECK_STRING(escaped("Wände 壁 🪟"), "Wände 壁 🪟");
}

TEST(controls_are_escaped)
{
    CHECK_STRING(escaped("a\nb\tc\x1b[2J\x7f"), "a\\u000ab\\u0009c\\u001b[2J\\u007f");
    CHECK_STRING(escaped("\xc2\x80\xc2\x9b\xc2\x9f\xc2\xa0"), "\\u0080\\u009b\\u009f\xc2\xa0");
}

TEST(bidirectional_controls_and_separators_are_escaped)
{
    CHECK_STRING(escaped("\u202egnp.exe"), "\\u202egnp.exe");
    CHECK_STRING(escaped("\u061c\u200e\u200f\u2028\u2029\u202a\u2066\u2069"),
                 "\\u061c\\u200e\\u200f\\u2028\\u2029\\u202a\\u2066\\u2069");
    CHECK_STRING(escaped("\u200d\u2027\u202f\u206a"), "\u200d\u2027\u202f\u206a");
}

TEST(bytes_that_are_not_utf8_are_escaped)
{
    CHECK_STRING(escaped("\x9b"
                         "31m"),
                 "\\x9b31m"); // the C1 control of eight-bit terminals
    CHECK_STRING(escaped("\xc0\xaf \xed\xa0\x80 \xf4\x90\x80\x80 \xe2\x80"),
                 "\\xc0\\xaf \\xed\\xa0\\x80 \\xf4\\x90\\x80\\x80 \\xe2\\x80");
}

TEST(truncation_is_between_characters)
{
    static const char text[] = "é\x1b壁";
    for (size_t size = 1; size < 16; size++) {
        char out[16];
        memset(out, '!', sizeof out);
        const size_t length = text_escape(text, out, size);
        assert_int_equal(length, strlen(out));
        CHECK(length < size && (length == 0 || length == 2 || length == 8 || length == 11));
        CHECK(length == 11 || size <= (length == 0 ? 2u : length == 2 ? 8u : 11u));
    }
    CHECK(text_escape("a", (char[1]){ 0 }, 0) == 0);
    CHECK(text_escape(text, NULL, 0) == 11);
}

TEST(floats_are_the_shortest_decimal_that_parses_to_them)
{
    static const struct {
        float value;
        const char *text;
    } cases[] = { { 0.1f, "0.1" },
                  { -2.0f, "-2" },
                  { 1e20f, "1e+20" },
                  { 1.0f / 3.0f, "0.33333334" },
                  { 16777216.0f, "16777216" },
                  { 0.0f, "0" } };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char text[16];
        text_float(cases[i].value, text, sizeof text);
        CHECK_STRING(text, cases[i].text);
    }
}

TEST(a_log_message_has_no_controls)
{
    test_forget_messages();
    host_fail(test_host(), FAIL_FILE, "cannot read %s: %s", "a\u202eb", "it is a\x1b[31m folder");
    CHECK_STRING(test_last_message(), "cannot read a\\u202eb: it is a\\u001b[31m folder");
}
