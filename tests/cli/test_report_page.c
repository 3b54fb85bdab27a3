// The file of the report page: self-contained, names are escaped, a missing image is an error
// that leaves nothing behind. test_report_page_browser.c uses the page.
#include "cli/compare/report_page.h" // before cmocka, whose fail() is a macro

#include "cli/program.h"
#include "cli/report_sample.h"

#include "core/files/file.h"

#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const char HOSTILE[] =
    "</script><script>alert(1)</script><!-- <script> \xe2\x80\xa8\xe2\x80\xa9 \\ \" ' & ]]>";

static char *page_of(const char *folder)
{
    char path[512];
    struct file_bytes bytes;
    snprintf(path, sizeof path, "%s/report.html", folder);
    assert_true(file_read(test_host(), path, 0, &bytes));
    char *text = malloc(bytes.size + 1);
    assert_non_null(text);
    memcpy(text, bytes.data, bytes.size + 1);
    file_bytes_finish(test_host(), &bytes);
    return text;
}

static int count(const char *text, const char *part)
{
    int found = 0;
    for (const char *at = text; (at = strstr(at, part)); at += strlen(part)) found++;
    return found;
}

// The document in <script … id="data-NAME">.
static json_t *data_of(const char *page, const char *name)
{
    char mark[64];
    json_error_t error;
    snprintf(mark, sizeof mark, "id=\"data-%s\">", name);
    const char *begin = strstr(page, mark);
    assert_non_null(begin);
    begin += strlen(mark);
    json_t *data = json_loadb(begin, (size_t)(strstr(begin, "</script>") - begin), 0, &error);
    if (!data) fail_msg("no JSON under %s: %s", name, error.text);
    return data;
}

// The message on standard error of a failing write.
static const char *failure(const char *folder, const json_t *report)
{
    static char text[1024];
    char path[300];
    snprintf(path, sizeof path, "%s", test_path("said"));
    int kept = dup(STDERR_FILENO), file = open(path, O_RDWR | O_CREAT | O_TRUNC, 0600);
    assert_true(kept >= 0 && file >= 0);
    dup2(file, STDERR_FILENO);
    enum status status = report_page_write(folder, report);
    dup2(kept, STDERR_FILENO);
    ssize_t got = pread(file, text, sizeof text - 1, 0);
    text[got > 0 ? got : 0] = 0;
    close(kept);
    close(file);
    assert_int_equal(status, FAILED);
    return text;
}

static int value_of(char digit)
{
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    const char *at = strchr(digits, digit);
    return at && *at ? (int)(at - digits) : -1;
}

static void check_base64(const char *text, const struct file_bytes *bytes)
{
    size_t length = strlen(text), used = 0;
    unsigned held = 0;
    int bits = 0;
    assert_int_equal(length, (bytes->size + 2) / 3 * 4);
    for (size_t i = 0; i < length && text[i] != '='; i++) {
        held = held << 6 | (unsigned)value_of(text[i]);
        bits += 6;
        if (bits < 8) continue;
        bits -= 8;
        CHECK(used < bytes->size && (held >> bits & 255) == bytes->data[used]);
        used++;
    }
    assert_int_equal(used, bytes->size);
}

TEST(the_page_holds_every_image_to_the_byte)
{
    static const char HEAD[] = "data:image/png;base64,";
    char folder[300];
    snprintf(folder, sizeof folder, "%s", make_folder("whole"));
    json_t *report = sample_report(folder, "@cornell", "none");
    assert_int_equal(report_page_write(folder, report), DONE);
    char *page = page_of(folder);
    json_t *images = data_of(page, "images"), *uri;
    assert_int_equal(json_object_size(images), SAMPLE_IMAGES);
    const char *name;
    json_object_foreach(images, name, uri)
    {
        char path[600];
        struct file_bytes bytes;
        snprintf(path, sizeof path, "%s/%s", folder, name);
        assert_true(file_read(test_host(), path, 0, &bytes));
        CHECK(strncmp(json_string_value(uri), HEAD, strlen(HEAD)) == 0);
        check_base64(json_string_value(uri) + strlen(HEAD), &bytes);
        file_bytes_finish(test_host(), &bytes);
    }
    json_decref(images);
    json_decref(report);
    free(page);
}

// URLs follow one of these; the policy in the page allows only data: URIs.
TEST(the_page_loads_nothing)
{
    static const char *const fetching[] = {
        "src=\"h", "src='",    "src=\"/", "src=\"f", "href=\"h",
        "href='",  "href=\"/", "url(",    "@import", "<link rel=\"stylesheet",
        "<iframe", "<object",  "{{"
    };
    char folder[300];
    snprintf(folder, sizeof folder, "%s", make_folder("alone"));
    json_t *report = sample_report(folder, "@cornell", "none");
    assert_int_equal(report_page_write(folder, report), DONE);
    char *page = page_of(folder);
    for (size_t i = 0; i < sizeof fetching / sizeof *fetching; i++)
        if (strstr(page, fetching[i])) fail_msg("%s stands in the page", fetching[i]);
    CHECK(strstr(page, "default-src 'none'; img-src data:;"));
    CHECK(strstr(page, "Chart.js v3") && strstr(page, "MIT License"));
    json_decref(report);
    free(page);
}

TEST(no_name_ends_its_block)
{
    char plain[300], hostile[300];
    snprintf(plain, sizeof plain, "%s", make_folder("plain"));
    snprintf(hostile, sizeof hostile, "%s", make_folder("hostile"));
    json_t *first = sample_report(plain, "@cornell", "none");
    json_t *second = sample_report(hostile, HOSTILE, HOSTILE);
    assert_int_equal(report_page_write(plain, first), DONE);
    assert_int_equal(report_page_write(hostile, second), DONE);
    char *a = page_of(plain), *b = page_of(hostile);
    static const char *const marks[] = { "<script", "</script",   "<!--",
                                         "-->",     "alert(1)</", "\xe2\x80\xa8" };
    for (size_t i = 0; i < sizeof marks / sizeof *marks; i++)
        assert_int_equal(count(a, marks[i]), count(b, marks[i]));
    json_t *read = data_of(b, "report");
    CHECK(json_equal(json_object_get(read, "scene"), json_object_get(second, "scene")));
    json_t *method = json_array_get(json_object_get(read, "methods"), 0);
    CHECK_STRING(json_string_value(json_object_get(method, "gi")), HOSTILE);
    json_decref(read);
    json_decref(first);
    json_decref(second);
    free(a);
    free(b);
}

TEST(a_missing_image_leaves_the_page_unchanged)
{
    char folder[300], path[400];
    snprintf(folder, sizeof folder, "%s", make_folder("missing"));
    json_t *report = sample_report(folder, "@cornell", "none");
    snprintf(path, sizeof path, "%s/2-error.png", folder);
    assert_int_equal(unlink(path), 0);
    const char *said = failure(folder, report);
    CHECK(strstr(said, "afterglow: cannot embed ") && strstr(said, "2-error.png: No such file"));
    assert_int_equal(count_files(folder), SAMPLE_IMAGES - 1);

    write_file(path, "no image at all", 17);
    CHECK(strstr(failure(folder, report), "2-error.png: not a PNG file"));
    snprintf(path, sizeof path, "%s/report.html", folder);
    write_file(path, "before", 6);
    failure(folder, report);
    char *page = page_of(folder);
    CHECK_STRING(page, "before");
    assert_int_equal(count_files(folder), SAMPLE_IMAGES + 1);
    free(page);
    json_decref(report);
}

TEST(images_outside_the_folder_are_refused)
{
    static const char *const names[] = {
        "../reference.png", "/reference.png", "a/../../reference.png", "..", "", "a/.."
    };
    char folder[300];
    snprintf(folder, sizeof folder, "%s", make_folder("inside"));
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        json_t *report = json_pack("{s:{s:{s:s}}}", "reference", "images", "picture", names[i]);
        CHECK(strstr(failure(folder, report), "it is not in"));
        json_decref(report);
    }
    assert_int_equal(count_files(folder), 0);
}

TEST(a_report_without_images_is_a_page_too)
{
    char folder[300];
    snprintf(folder, sizeof folder, "%s", make_folder("bare"));
    json_t *report = json_pack("{s:s, s:{s:n}, s:[{s:s, s:{s:n}}]}", "scene", "@cornell",
                               "reference", "images", "methods", "gi", "none", "images", "picture");
    assert_int_equal(report_page_write(folder, report), DONE);
    char *page = page_of(folder);
    json_t *images = data_of(page, "images");
    assert_int_equal(json_object_size(images), 0);
    json_decref(images);
    json_decref(report);
    free(page);
}

TEST(the_legend_has_the_colours_of_the_maps)
{
    char folder[300];
    snprintf(folder, sizeof folder, "%s", make_folder("scale"));
    json_t *report = json_object();
    assert_int_equal(report_page_write(folder, report), DONE);
    char *page = page_of(folder);
    json_t *scale = data_of(page, "scale");
    size_t last = json_array_size(scale) - 1;
    CHECK(last >= 16);
    CHECK_STRING(json_string_value(json_array_get(scale, 0)), "#000000");
    CHECK_STRING(json_string_value(json_array_get(scale, last)), "#ffffff");
    // Half of the maximum is red: the hue of metrics.c runs from blue-violet over red to yellow.
    unsigned red, green, blue;
    assert_int_equal(sscanf(json_string_value(json_array_get(scale, last / 2)), "#%2x%2x%2x", &red,
                            &green, &blue),
                     3);
    CHECK(red > 2 * green && red > blue);
    json_decref(scale);
    json_decref(report);
    free(page);
}
