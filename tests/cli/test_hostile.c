// The program among hostile names, full disks, killed runs and links.
#include "cli/program.h"

#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

// C1, bidirectional and C0 controls.
#define NAME  "a\u202eb\xc2\x9b\x1b[31m"
#define SHOWN "a\\u202eb\\u009b\\u001b[31m"

static const char scene[] =
    "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0]}],"
    "\"nodes\":[{\"camera\":0}],\"cameras\":[{\"name\":\"\\u202e\\u009b\\u001bred\","
    "\"type\":\"perspective\",\"perspective\":{\"yfov\":0.8,\"znear\":0.1}}]}";

// Controls but for line breaks.
static bool has_controls(const char *text)
{
    return strpbrk(text, "\x1b\x7f") || strstr(text, "\xc2\x9b") || strstr(text, "\u202e");
}

TEST(names_are_printed_with_controls_escaped)
{
    char path[1024];
    snprintf(path, sizeof path, "%s", test_path(NAME ".gltf"));
    write_file(path, scene, strlen(scene));
    const struct run *result = run_expect(0, "info", path, NULL);
    CHECK(strstr(result->out, SHOWN ".gltf") && strstr(result->out, "\\u202e\\u009b\\u001bred"));
    CHECK(!has_controls(result->out) && !has_controls(result->err));
    result = run_expect(0, "info --json", path, NULL);
    CHECK(!has_controls(result->out));
    json_t *info = run_json(result);
    CHECK_STRING(json_string_value(json_object_get(info, "scene")), path); // exact for programs
    json_decref(info);
    result = run_expect(1, "info", test_path("no" NAME ".gltf"), NULL);
    check_one_error_line(result);
    CHECK(strstr(result->err, SHOWN) && !has_controls(result->err));
    result = run_expect(2, "render @cornell --gi", NAME, NULL);
    CHECK(strstr(result->err, SHOWN) && !has_controls(result->err));
}

// As a killed run leaves it: no process holds it.
TEST(a_file_left_by_a_killed_run_is_named_and_replaced)
{
    require_device();
    char stats[1024], left[1100];
    snprintf(stats, sizeof stats, "%s", test_path("s.json"));
    snprintf(left, sizeof left, "%s.tmp-0123456789abcdef", stats);
    write_file(left, "{", 1);
    const struct run *result = run_expect(0, "render @cornell --size 8x8 --stats", stats, "-o",
                                          test_path("left.png"), NULL);
    CHECK(strstr(result->err, "s.json.tmp-0123456789abcdef") && strstr(result->err, "removed"));
    CHECK(file_exists(stats) && !file_exists(left));
}

TEST(a_folder_left_by_a_killed_run_is_named_and_replaced)
{
    require_device();
    char folder[1024], left[1100], inside[1200];
    snprintf(folder, sizeof folder, "%s", test_path("results"));
    snprintf(left, sizeof left, "%s.tmp-0123456789abcdef", folder);
    snprintf(inside, sizeof inside, "%s/reference.exr", left);
    assert_int_equal(mkdir(left, 0777), 0);
    write_file(inside, "x", 1);
    const struct run *result = run_expect(
        0, "compare @cornell --size 8x8 --frames 1 --spp 1 --gi none --no-cache -o", folder, NULL);
    CHECK(strstr(result->err, "results.tmp-0123456789abcdef") && strstr(result->err, "removed"));
    CHECK(file_exists(folder) && !file_exists(left));
}

// The limit of a file's size stands for a full disk.
static void full_disk(bool full)
{
    static struct rlimit before;
    if (full) assert_int_equal(getrlimit(RLIMIT_FSIZE, &before), 0);
    const struct rlimit limit = { full ? 4096 : before.rlim_cur, before.rlim_max };
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &limit), 0);
}

TEST(a_full_disk_is_reported_with_the_path_of_an_image)
{
    char image[1024];
    snprintf(image, sizeof image, "%s", test_path("full.exr"));
    full_disk(true);
    const struct run *result =
        run_program("reference @cornell --size 64x64 --spp 1 -o", image, NULL);
    full_disk(false);
    CHECK(result->status == 1 && !file_exists(image));
    CHECK(strstr(result->err, image) && !strstr(result->err, ".tmp-"));
    CHECK(strstr(result->err, "File too large"));
}

// Drivers whose device memory is in nameless files cannot work below the limit: lavapipe of
// Mesa 25.
static void require_device_on_full_disk(void)
{
    full_disk(true);
    const struct run *result =
        run_program("render @cornell --size 8x8 --gi none --quiet -o", test_path("8.png"), NULL);
    full_disk(false);
    if (result->status == 0) return;
    if (result->status != -1) fail_msg("a small image: %s", result->err);
    test_skip("the driver does not work with a limit of file sizes");
}

TEST(a_full_disk_is_reported_with_the_path_of_a_folder)
{
    require_device();
    require_device_on_full_disk();
    char folder[1024];
    snprintf(folder, sizeof folder, "%s", test_path("full"));
    full_disk(true);
    const struct run *result = run_program(
        "compare @cornell --size 64x64 --frames 1 --spp 1 --gi none --no-cache -o", folder, NULL);
    full_disk(false);
    CHECK(result->status == 1 && !file_exists(folder));
    CHECK(strstr(result->err, folder) && !strstr(result->err, ".tmp-"));
    CHECK(strstr(result->err, "File too large"));
}

// Others may be able to write to a shared cache: a link there neither is read nor leads a write
// elsewhere.
TEST(links_in_the_cache_are_not_followed)
{
    require_device();
    static const char words[] =
        "compare @cornell --size 8x8 --frames 1 --spp 1 --gi none --verbose -o";
    char cache[512], found[1024] = "", victim[1024];
    snprintf(cache, sizeof cache, "%s", make_folder("cache"));
    snprintf(victim, sizeof victim, "%s", test_path("victim"));
    setenv("AFTERGLOW_CACHE", cache, 1);
    run_expect(0, words, test_path("linked"), NULL);
    char command[1200];
    snprintf(command, sizeof command, "ls %s/references/*.exr", cache);
    FILE *list = popen(command, "r");
    CHECK(list && fgets(found, sizeof found, list));
    pclose(list);
    found[strcspn(found, "\n")] = 0;
    assert_int_equal(rename(found, victim), 0); // a valid reference, but elsewhere
    assert_int_equal(symlink(victim, found), 0);
    struct stat before, after, cached;
    CHECK(stat(victim, &before) == 0);
    run_expect(0, words, test_path("linked"), NULL);
    CHECK(stat(victim, &after) == 0 && lstat(found, &cached) == 0);
    CHECK(before.st_ino == after.st_ino && before.st_mtim.tv_nsec == after.st_mtim.tv_nsec);
    CHECK(S_ISREG(cached.st_mode));
    unsetenv("AFTERGLOW_CACHE");
}

// ---- memory

static void check_refused_for_memory(const struct run *result, const char *what)
{
    check_one_error_line(result);
    CHECK(strstr(result->err, what) &&
          strstr(result->err, " GB of memory, this machine allows 4."));
    CHECK(strstr(result->err, "; "));
}

// A limit of the address space stands for a small machine.
TEST(what_does_not_fit_into_memory_is_refused_beforehand)
{
    static const uint8_t png[] = { 0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n', 0,  0,
                                   0,    13,  'I', 'H', 'D',  'R',  0,    0,    64, 0,
                                   0,    0,   64,  0,   8,    2,    0,    0,    0 };
    require_device();
    char image[1024];
    snprintf(image, sizeof image, "%s", test_path("claims.png")); // 16384x16384
    write_file(image, (const char *)png, sizeof png);
    struct rlimit before, small;
    assert_int_equal(getrlimit(RLIMIT_AS, &before), 0);
    small = (struct rlimit){ (rlim_t)4 << 30, before.rlim_max };
    assert_int_equal(setrlimit(RLIMIT_AS, &small), 0);
    const char *out = test_path("large.exr"), *folder = test_path("large");
    check_refused_for_memory(
        run_expect(1, "render @cornell --size 16384x16384 --quiet -o", out, NULL), "16384x16384");
    check_refused_for_memory(run_expect(1, "reference @cornell --size 16384x16384 -o", out, NULL),
                             "16384x16384");
    check_refused_for_memory(run_expect(1, "compare @cornell --size 16384x16384 -o", folder, NULL),
                             "16384x16384");
    check_refused_for_memory(run_expect(1, "diff", image, image, NULL), "claims.png");
    run_expect(0, "render @cornell --size 32x32 -o", out, NULL);
    assert_int_equal(setrlimit(RLIMIT_AS, &before), 0);
    CHECK(file_exists(out) && !file_exists(folder));
}
