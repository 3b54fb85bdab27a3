// compare: references in the cache and in files.
#include "cli/compare/compare_run.h"

#include <dirent.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

TEST(a_reference_is_traced_once_and_continued)
{
    require_device();
    const char *cache = own_cache("kept-cache"), *folder = path_of("kept");
    run_expect(0, SMALL " -o", folder, NULL);
    assert_int_equal(count_files(cache), 1);
    json_t *first = report_of(folder);
    run_expect(0, SMALL " -o", folder, NULL);
    json_t *second = report_of(folder);
    CHECK(json_is_false(json_object_get(json_object_get(first, "reference"), "cached")));
    CHECK(json_is_true(json_object_get(json_object_get(second, "reference"), "cached")));
    check_equal_numbers(method_of(first, 0), method_of(second, 0));
    CHECK(of_reference(first, "seconds") == of_reference(second, "seconds"));
    CHECK(of_reference(first, "rays") == of_reference(second, "rays"));
    CHECK_RELATIVE(of_reference(first, "noise"), of_reference(second, "noise"),
                   1e-5); // 32-bit floats
    // More samples continue the cached ones; fewer need no tracing.
    run_expect(0, SMALL " --spp 5 -o", folder, NULL);
    json_t *third = report_of(folder);
    CHECK(json_is_false(json_object_get(json_object_get(third, "reference"), "cached")));
    assert_int_equal((int)of_reference(third, "spp"), 5);
    CHECK(of_reference(third, "rays") > of_reference(second, "rays"));
    CHECK(of_reference(third, "seconds") > of_reference(second, "seconds"));
    const char *whole = path_of("whole.exr");
    run_expect(0, "reference @cornell --size 24x18 --quiet --spp 5 -o", whole, NULL);
    struct image a = read_layer(whole, NULL),
                 b = read_layer(path_in(folder, "reference.exr"), NULL);
    for (int i = 0; i < 24 * 18 * 3; i++) CHECK_RELATIVE(a.pixels[i], b.pixels[i], 1e-5);
    image_finish(&a, test_host());
    image_finish(&b, test_host());
    run_expect(0, SMALL " --spp 3 -o", folder, NULL);
    json_t *fourth = report_of(folder);
    CHECK(json_is_true(json_object_get(json_object_get(fourth, "reference"), "cached")));
    assert_int_equal((int)of_reference(fourth, "spp"), 5);
    assert_int_equal(count_files(cache), 1);
    // Another image has its own file; --no-cache writes none.
    run_expect(0, SMALL " --bounces 1 -o", folder, NULL);
    assert_int_equal(count_files(cache), 2);
    run_expect(0, SMALL " --bounces 2 --no-cache -o", folder, NULL);
    assert_int_equal(count_files(cache), 2);
    json_decref(first);
    json_decref(second);
    json_decref(third);
    json_decref(fourth);
}

TEST(a_damaged_or_unwritable_cache_is_no_error)
{
    require_device();
    const char *cache = own_cache("damaged-cache"), *folder = path_of("damaged");
    run_expect(0, SMALL " -o", folder, NULL);
    DIR *dir = opendir(cache);
    assert_non_null(dir);
    for (struct dirent *entry; (entry = readdir(dir));)
        if (entry->d_name[0] == 'r') write_file(path_in(cache, entry->d_name), "no image", 10);
    closedir(dir);
    const struct run *r = run_expect(
        0, "compare @cornell --size 24x18 --frames 1 --spp 2 --gi none -o", folder, NULL);
    CHECK(strstr(r->err, "traced again"));
    json_t *report = report_of(folder);
    CHECK(json_is_false(json_object_get(json_object_get(report, "reference"), "cached")));
    json_decref(report);
    write_file(path_of("no-folder"), "", 0);
    setenv("AFTERGLOW_CACHE", path_of("no-folder"), 1);
    run_expect(0, SMALL " -o", folder, NULL);
}

// A sparse file of 3 GB, unused for years.
static void make_old(const char *path)
{
    int fd = open(path, O_WRONLY | O_CREAT, 0600);
    const struct timespec times[2] = { { .tv_sec = 1e9 }, { .tv_sec = 1e9 } };
    assert_true(fd >= 0 && ftruncate(fd, 3000000000) == 0 && futimens(fd, times) == 0 &&
                close(fd) == 0);
}

TEST(the_cache_respects_its_size_limit_and_foreign_files)
{
    require_device();
    const char *cache = own_cache("bound-cache"), *folder = path_of("bound");
    run_expect(0, SMALL " -o", folder, NULL);
    make_old(path_in(cache, "reference-1-0123456789abcdef.exr"));
    make_old(path_in(cache, "holiday.exr"));
    run_expect(0, SMALL " --spp 3 -o", folder, NULL);
    CHECK(!file_exists(path_in(cache, "reference-1-0123456789abcdef.exr")));
    CHECK(file_exists(path_in(cache, "holiday.exr")));
    assert_int_equal(count_files(cache), 2);
}

TEST(a_reference_of_another_image_is_refused)
{
    require_device();
    own_cache("other-cache");
    const char *own = path_of("own"), *again = path_of("again");
    run_expect(0, SMALL " -o", own, NULL);
    const char *exr = path_in(own, "reference.exr");
    run_expect(0, SCENE " --frames 1 --gi none -o", again, "--reference", exr, NULL);
    json_t *first = report_of(own), *second = report_of(again);
    check_equal_numbers(method_of(first, 0), method_of(second, 0));
    assert_int_equal((int)of_reference(second, "spp"), 2);
    CHECK_RELATIVE(of_reference(first, "noise"), of_reference(second, "noise"), 1e-5);
    json_decref(first);
    json_decref(second);
    static const char *const others[] = {
        "compare @cornell --size 32x18 --gi none", // another size …
        "compare @cornell --size 24x18 --gi none --eye 0,3,12 --target 0,2,0",
        "compare @cornell --size 24x18 --gi none --bounces 1",
        "compare @cornell:light=point --size 24x18 --gi none",
        "compare @cornell --size 24x18 --gi none --sky 1,1,1",
    };
    const char *folder = path_of("refused");
    for (size_t i = 0; i < sizeof others / sizeof others[0]; i++)
        check_one_error_line(run_expect(1, others[i], "-o", folder, "--reference", exr, NULL));
    check_one_error_line(
        run_expect(1, SCENE " -o", folder, "--reference", path_of("none.exr"), NULL));
    CHECK(!file_exists(folder));
    // Without the layer of indirect light only the image is compared.
    const char *bare = path_of("bare.exr");
    run_expect(0, "reference @cornell --size 24x18 --quiet --spp 2 --aov color -o", bare, NULL);
    run_expect(0, SCENE " --frames 1 --gi none -o", folder, "--reference", bare, NULL);
    json_t *report = report_of(folder);
    CHECK(json_is_null(json_object_get(method_of(report, 0), "indirect")));
    CHECK(number_of(method_of(report, 0), "flip") > 0);
    CHECK(!file_exists(path_in(folder, "reference-indirect.png")));
    json_decref(report);
}
