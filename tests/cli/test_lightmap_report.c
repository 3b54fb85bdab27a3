// The report of bake --lightmap: its figures of known faults, and its page as a file.
#include "cli/program.h"
#include "cli/screen.h"

#include "core/files/file.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>

#define SCREEN                                                                                     \
    "bake --gi radiosity:density=4 --spp 16 --light sun:0.7,-1,0.1:500,500,500 --sky 1,1,1 "       \
    "--quiet --json "

static void use_cache(const char *name)
{
    setenv("AFTERGLOW_CACHE", make_folder(name), 1);
}

static const json_t *member(const json_t *report, const char *group, const char *name)
{
    const json_t *value =
        json_object_get(json_object_get(json_object_get(report, "quality"), group), name);
    if (!value) fail_msg("no %s.%s", group, name);
    return value;
}

static double number(const json_t *report, const char *group, const char *name)
{
    return json_number_value(member(report, group, name));
}

// ---- figures

// The screen is thinner than a texel and stands in the sun: the floor is lit on one side of it.
TEST(report_tells_where_light_leaks_below_a_screen)
{
    use_cache("report-leaks");
    const char *maps = path_of("report-leaks-maps");
    json_t *report =
        run_json(run_expect(0, SCREEN "--lightmap", maps, write_screen("leaks.gltf", 1.1), NULL));
    CHECK(number(report, "leaks", "texels") > 0.0);
    CHECK(number(report, "overlaps", "shared") == 0.0);
    CHECK_NEAR(number(report, "density", "wanted"), 4.0, 1e-6);
    CHECK_RELATIVE(number(report, "density", "reached"), 4.0, 1e-3);
    const json_t *worst = json_array_get(member(report, "leaks", "worst"), 0);
    const json_t *position = json_object_get(worst, "position");
    CHECK(json_number_value(json_object_get(worst, "step")) >= 0.25);
    // The screen covers x = 0.6 to 1.6, z = 0.
    const double x = json_number_value(json_array_get(position, 0)),
                 z = json_number_value(json_array_get(position, 2));
    print_message("%.0f texels, the first at %g, %g\n", number(report, "leaks", "texels"), x, z);
    CHECK(x > 0.3 && x < 1.9 && z > -0.5 && z < 0.5);
    json_decref(report);
}

static const char *const members[] = { "density", "texels", "overlaps", "charts",
                                       "seams",   "leaks",  "noise" };

TEST(report_file_has_what_json_prints)
{
    use_cache("report-file");
    const char *file = path_of("light-map.json");
    json_t *printed = run_json(run_expect(0,
                                          "bake @cornell --gi radiosity:texels=2048 --spp 4 "
                                          "--quiet --json --report",
                                          file, "--lightmap", path_of("report-file-maps"), NULL));
    json_t *written = json_load_file(file, 0, NULL);
    assert_non_null(written);
    CHECK(json_equal(printed, written));
    for (size_t i = 0; i < sizeof members / sizeof *members; i++)
        assert_non_null(json_object_get(json_object_get(written, "quality"), members[i]));
    CHECK(json_array_size(json_object_get(written, "stages")) > 0);
    CHECK(json_number_value(json_object_get(written, "threads")) >= 1.0);
    CHECK(json_number_value(json_object_get(written, "seconds")) > 0.0);
    CHECK_STRING(json_string_value(json_object_get(written, "scene")), "@cornell");
    json_decref(printed);
    json_decref(written);
}

TEST(largest_noise_is_that_of_the_bound)
{
    use_cache("report-noise");
    json_t *report = run_json(run_expect(
        0,
        "bake @cornell --gi radiosity:texels=2048 --spp auto:noise=12,max=2048 --quiet --json "
        "--lightmap",
        path_of("report-noise-maps"), NULL));
    CHECK_RELATIVE(number(report, "noise", "largest"),
                   json_number_value(json_object_get(report, "noise")), 1e-3);
    json_decref(report);
}

TEST(report_is_there_of_a_technique_and_after_an_update)
{
    use_cache("report-update");
    const char *maps = path_of("report-update-maps"),
               *page = path_of("report-update-maps/report.html");
    const char *scene = write_screen("report-update.gltf", -1.0);
    json_decref(run_json(run_expect(0, SCREEN "--lightmap", maps, scene, NULL)));
    CHECK(file_exists(page));
    json_t *report = run_json(run_expect(0, SCREEN "--update --lightmap", maps,
                                         write_screen("report-update.gltf", -0.5), NULL));
    CHECK(json_object_get(report, "update") && number(report, "noise", "largest") > 0.0);
    json_decref(report);
    require_device();
    report = run_json(run_expect(0,
                                 "bake @cornell --gi radiosity:texels=2048,rays=64 --quiet --json "
                                 "--lightmap",
                                 maps, NULL));
    CHECK(file_exists(page));
    CHECK(!json_object_get(json_object_get(report, "quality"), "noise"));
    CHECK(number(report, "seams", "texels") > 0.0);
    json_decref(report);
}

// ---- the page as a file

static char *read_page(const char *path)
{
    struct file_bytes bytes;
    CHECK(file_read(test_host(), path, 0, &bytes));
    char *text = malloc(bytes.size + 1);
    assert_non_null(text);
    memcpy(text, bytes.data, bytes.size + 1);
    file_bytes_finish(test_host(), &bytes);
    return text;
}

static bool is_void(const char *name)
{
    static const char *const names[] = { "!doctype", "meta", "link", "img", "br", "input" };
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        if (strcmp(name, names[i]) == 0) return true;
    return false;
}

enum { NAME_SIZE = 16, DEPTH = 32 };

// Reads "<name" or "</name"; the end of the tag.
static const char *read_tag(const char *at, bool *closes, char name[NAME_SIZE])
{
    size_t length = 0;
    *closes = at[1] == '/';
    at += *closes ? 2 : 1;
    while ((isalnum((unsigned char)*at) || *at == '!') && length + 1 < NAME_SIZE)
        name[length++] = (char)tolower((unsigned char)*at++);
    name[length] = 0;
    const char *end = strchr(at, '>');
    assert_non_null(end);
    return end + 1;
}

// Each element that is not void is closed, in order. Scripts and styles are text.
static void check_elements(const char *text)
{
    char open[DEPTH][NAME_SIZE], name[NAME_SIZE];
    int depth = 0;
    bool closes;
    for (const char *at = text; (at = strchr(at, '<'));) {
        if (strncmp(at, "<!--", 4) == 0) {
            at = strstr(at, "-->");
            assert_non_null(at);
            continue;
        }
        at = read_tag(at, &closes, name);
        if (closes) {
            if (depth == 0 || strcmp(open[depth - 1], name) != 0)
                fail_msg("</%s> closes <%s>", name, depth > 0 ? open[depth - 1] : "");
            depth--;
        } else if (!is_void(name)) {
            assert_true(depth < DEPTH);
            strcpy(open[depth++], name);
        }
        const bool raw = !closes && (strcmp(name, "script") == 0 || strcmp(name, "style") == 0);
        if (raw) at = strstr(at, name[1] == 'c' ? "</script" : "</style");
        assert_non_null(at);
    }
    assert_int_equal(depth, 0);
}

TEST(page_is_well_formed_and_needs_nothing_else)
{
    use_cache("report-page");
    run_expect(0, "bake @cornell --gi radiosity:texels=2048 --spp 4 --quiet --lightmap",
               path_of("report-page-maps"), NULL);
    char *page = read_page(path_of("report-page-maps/report.html"));
    check_elements(page);
    CHECK(!strstr(page, "http:") && !strstr(page, "https:") && !strstr(page, "{{"));
    CHECK(strstr(page, "default-src 'none'"));
    static const char *const images[] = { "light", "charts", "density", "leaks", "noise" };
    char text[64];
    for (size_t i = 0; i < sizeof images / sizeof *images; i++) {
        snprintf(text, sizeof text, "\"%s.png\":\"data:image/png;base64,", images[i]);
        CHECK(strstr(page, text));
        snprintf(text, sizeof text, "report-page-maps/%s.png", images[i]);
        CHECK(!file_exists(path_of(text)));
    }
    free(page);
}

// ---- failures

// The limit of a file's size stands for a full disk: the page, the largest file, does not fit.
TEST(a_full_disk_leaves_the_earlier_folder)
{
    static const char WORDS[] =
        "bake @cornell --gi radiosity:density=1 --spp 1 --quiet --lightmap-format png --lightmap";
    struct rlimit before;
    struct stat page, scene;
    use_cache("report-full");
    const char *maps = path_of("report-full-maps"), *other = path_of("report-full-other");
    run_expect(0, WORDS, maps, NULL);
    assert_int_equal(stat(path_of("report-full-maps/report.html"), &page), 0);
    assert_int_equal(stat(path_of("report-full-maps/scene.glb"), &scene), 0);
    CHECK(scene.st_size + 1000 < page.st_size);
    assert_int_equal(getrlimit(RLIMIT_FSIZE, &before), 0);
    const struct rlimit limit = { (rlim_t)page.st_size - 1000, before.rlim_max };
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &limit), 0);
    const struct run *r = run_program(WORDS, other, NULL);
    assert_int_equal(r->status, 1);
    check_one_error_line(r);
    CHECK(strstr(r->err, "report.html") && !strstr(r->err, ".tmp-") && !file_exists(other));
    r = run_program(WORDS, maps, NULL);
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &before), 0);
    assert_int_equal(r->status, 1);
    assert_int_equal(count_files(maps), 4);
}

TEST(reports_that_cannot_be_written_are_refused_before_any_work)
{
    use_cache("report-refused");
    const char *maps = path_of("report-refused-maps");
    check_one_error_line(run_expect(1, "bake @cornell --spp 1 --report",
                                    path_of("absent/report.json"), "--lightmap", maps, NULL));
    check_one_error_line(
        run_expect(2, "bake @cornell --spp 1 --report-full --lightmap", maps, NULL));
    CHECK(!file_exists(maps));
}
