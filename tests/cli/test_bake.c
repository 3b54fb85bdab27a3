// afterglow bake and cache, and bakes of render and compare, with a program whose technique
// `sample` bakes.
#include "cli/program.h"

#include <fcntl.h>
#include <limits.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>
#include <utime.h>

// An empty cache of this test's own.
static const char *use_cache(const char *name)
{
    static char bakes[600];
    setenv("AFTERGLOW_CACHE", make_folder(name), 1);
    snprintf(bakes, sizeof bakes, "%s/bakes", getenv("AFTERGLOW_CACHE"));
    return bakes;
}

static double number(const json_t *document, const char *name)
{
    return json_number_value(json_object_get(document, name));
}

TEST(bake_writes_to_the_cache_and_the_next_run_uses_it)
{
    const char *folder = use_cache("bake-cache");
    const struct run *r = run_expect(0, "bake @cornell --gi sample", NULL);
    CHECK(strstr(r->err, "baking sample: 128 texels, 8000 rays"));
    CHECK(strstr(r->err, "baked in") && strstr(r->err, folder));
    CHECK_STRING(r->out, "");
    assert_int_equal(count_files(folder), 1);
    r = run_expect(0, "bake @cornell --gi sample", NULL);
    CHECK(strstr(r->err, "is already baked") && !strstr(r->err, "texels"));
    r = run_expect(0, "bake @cornell --gi sample --force --quiet", NULL);
    CHECK_STRING(r->err, "");
    assert_int_equal(count_files(folder), 1);
    run_expect(0, "bake @cornell --gi sample:rows=9 --quiet", NULL);
    run_expect(0, "bake @cornell --gi sample --seed 2 --quiet", NULL);
    run_expect(0, "bake @diagonal --gi sample --quiet", NULL);
    assert_int_equal(count_files(folder), 4);
    run_expect(0, "bake @cornell:light=point --gi sample --quiet", NULL); // other geometry
    assert_int_equal(count_files(folder), 5);
}

TEST(bake_gives_the_same_file_for_threads_shards_and_from_the_cache)
{
    use_cache("bake-same");
    const char *one = path_of("one.safetensors"), *many = path_of("many.safetensors"),
               *joined = path_of("joined.safetensors"), *copied = path_of("copy.safetensors"),
               *a = path_of("a.safetensors"), *b = path_of("b.safetensors");
    run_expect(0, "bake @cornell --gi sample --threads 1 -o", one, NULL);
    run_expect(0, "bake @cornell --gi sample --threads 4 -o", many, NULL);
    run_expect(0, "bake @cornell --gi sample --shard 0/2 -o", a, NULL);
    run_expect(0, "bake @cornell --gi sample --shard 1/2 -o", b, NULL);
    run_expect(0, "bake --merge", b, a, "-o", joined, NULL);
    run_expect(0, "bake @cornell --gi sample", NULL);
    const struct run *r = run_expect(0, "bake @cornell --gi sample -o", copied, NULL);
    CHECK(strstr(r->err, "already baked, in the cache; written: ") && strstr(r->err, copied));
    r = run_expect(0, "bake @cornell --gi sample -o", copied, NULL);
    CHECK(strstr(r->err, "sample is already baked: ") && !strstr(r->err, "written"));
    CHECK(files_are_equal(one, many) && files_are_equal(one, joined));
    CHECK(files_are_equal(one, copied));
}

TEST(bakes_of_scales_are_not_mixed_and_their_parts_know_them)
{
    const char *folder = use_cache("bake-scale");
    const char *one = path_of("scaled.safetensors"), *joined = path_of("scaled-joined.safetensors"),
               *a = path_of("scaled-a.safetensors"), *b = path_of("scaled-b.safetensors");
    run_expect(0, "bake @cornell --gi sample", NULL);
    run_expect(0, "bake @cornell --gi sample --scene-scale 2", NULL);
    assert_int_equal(count_files(folder), 2);
    run_expect(0, "bake @cornell --gi sample --scene-scale 2 -o", one, NULL);
    run_expect(0, "bake @cornell --gi sample --scene-scale 2 --shard 0/2 -o", a, NULL);
    run_expect(0, "bake @cornell --gi sample --scene-scale 2 --shard 1/2 -o", b, NULL);
    run_expect(0, "bake --merge", a, b, "-o", joined, NULL);
    CHECK(files_are_equal(one, joined));
    const struct run *r = run_expect(2, "bake --merge --scene-scale 2", a, b, "-o", joined, NULL);
    CHECK(strstr(r->err, "--scene-scale with --merge"));
}

TEST(bake_report_has_stages_times_and_bytes)
{
    use_cache("bake-report");
    const char *path = path_of("report.json");
    json_t *printed = run_json(
        run_expect(0, "bake @cornell --gi sample:wait_ms=20 --json --quiet --report", path, NULL));
    json_t *report = json_load_file(path, 0, NULL);
    CHECK(report && json_equal(report, printed));
    CHECK_STRING(json_string_value(json_object_get(report, "technique")), "sample");
    CHECK_NEAR(number(json_object_get(report, "options"), "rows"), 8, 0);
    const json_t *stages = json_object_get(report, "stages");
    CHECK(json_array_size(stages) == 2);
    CHECK_STRING(json_string_value(json_object_get(json_array_get(stages, 0), "name")), "gather");
    CHECK(number(json_array_get(stages, 0), "seconds") >= 8 * 0.02);
    CHECK(number(report, "seconds") > 0.0 && number(report, "estimate_seconds") > 0.0);
    CHECK(number(report, "peak_memory_bytes") > 1e6);
    CHECK_NEAR(number(report, "bytes"), 64, 0);
    CHECK_NEAR(number(report, "tensors"), 1, 0);
    CHECK(json_is_false(json_object_get(report, "full")));
    CHECK(json_is_false(json_object_get(report, "cached")));
    json_decref(printed);
    // The report of a cached file has the figures of the run that made it.
    printed = run_json(
        run_expect(0, "bake @cornell --gi sample:wait_ms=20 --json --quiet --report", path, NULL));
    CHECK(json_is_true(json_object_get(printed, "cached")));
    CHECK(json_is_null(json_object_get(printed, "estimate_seconds")));
    CHECK_RELATIVE(number(printed, "seconds"), number(report, "seconds"), 0.01);
    const json_t *again = json_object_get(printed, "stages");
    for (size_t i = 0; i < json_array_size(stages); i++)
        CHECK_NEAR(number(json_array_get(again, i), "seconds"),
                   number(json_array_get(stages, i), "seconds"), 1e-3);
    json_decref(report);
    json_decref(printed);
}

TEST(bake_refuses_wrong_usage_and_leaves_nothing)
{
    static const struct {
        int status;
        const char *words, *names;
    } cases[] = {
        { 2, "bake", "SCENE is missing" },
        { 2, "bake @cornell", "--gi SPEC is missing" },
        { 2, "bake @cornell --gi none", "cannot bake none: it needs no bake" },
        { 2, "bake @cornell --gi sampel", "did you mean sample?" },
        { 2, "bake @cornell --gi sample:rows=0", "rows" },
        { 2, "bake @cornell --gi sample -o a.exr", ".safetensors" },
        { 2, "bake @cornell --gi sample --shard 2/2 -o a.safetensors", "0 <= I < N" },
        { 2, "bake @cornell --gi sample --shard 0/2", "it requires -o" },
        { 2, "bake --merge a.safetensors", "it requires -o" },
        { 2, "bake @cornell --gi sample --threads 0", "1 to 1024" },
        { 1, "bake @cornell --gi sample:rows=100000 --max-memory 1",
          "more than the limit of 1 MiB" },
        { 1, "bake no-such-scene.glb --gi sample", "no-such-scene.glb" },
        { 1, "bake @cornell --gi sample -o /no-such-folder/a.safetensors", "/no-such-folder" },
        { 1, "bake --merge /no-such-file -o a.safetensors", "/no-such-file" },
    };
    const char *folder = use_cache("bake-wrong");
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        const struct run *r = run_expect(cases[i].status, cases[i].words, NULL);
        check_one_error_line(r);
        if (!strstr(r->err, cases[i].names)) fail_msg("%s: %s", cases[i].words, r->err);
    }
    CHECK(!file_exists("a.safetensors") && count_files(folder) <= 0);
}

TEST(bake_refuses_parts_of_another_bake_and_complete_files)
{
    use_cache("bake-parts");
    const char *a = path_of("part-a.safetensors"), *b = path_of("part-b.safetensors"),
               *whole = path_of("whole.safetensors"), *out = path_of("parts.safetensors");
    run_expect(0, "bake @cornell --gi sample --shard 0/2 -o", a, NULL);
    run_expect(0, "bake @cornell --gi sample:rows=9 --shard 1/2 -o", b, NULL);
    run_expect(0, "bake @cornell --gi sample -o", whole, NULL);
    const struct run *r = run_expect(1, "bake --merge", a, b, "-o", out, NULL);
    CHECK(strstr(r->err, "other options: rows is 9, not 8") && !file_exists(out));
    r = run_expect(1, "bake --merge", a, whole, "-o", out, NULL);
    CHECK(strstr(r->err, "its kind is bake, not partial") && !file_exists(out));
}

// Replaces a text of the file by one of the same length.
static void replace_text(const char *path, const char *from, const char *to)
{
    static char bytes[65536];
    FILE *file = fopen(path, "rb");
    CHECK(file);
    const size_t size = fread(bytes, 1, sizeof bytes, file);
    fclose(file);
    char *at = size < sizeof bytes ? memmem(bytes, size, from, strlen(from)) : NULL;
    CHECK(at && strlen(from) == strlen(to));
    memcpy(at, to, strlen(to));
    write_file(path, bytes, size);
}

// A damaged file is a failure, not wrong usage.
TEST(bake_refuses_a_part_whose_scale_is_damaged)
{
    static const char *const wrong[] = { "\"1e30\"", "\"1e-9\"", "\"-0.5\"", "\"0,25\"",
                                         "\"nan \"" };
    use_cache("bake-wrong-scale");
    const char *part = path_of("scaled-part.safetensors"),
               *out = path_of("wrong-scale.safetensors");
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
        run_expect(0, "bake @cornell --gi sample --scene-scale 0.25 --shard 0/2 -o", part, NULL);
        replace_text(part, "\"0.25\"", wrong[i]);
        const struct run *r = run_expect(1, "bake --merge", part, "-o", out, NULL);
        check_one_error_line(r);
        CHECK(strstr(r->err, part) && strstr(r->err, "its scale of the scene is wrong"));
        CHECK(!file_exists(out));
    }
}

// ---- Ctrl-C

static double now_s(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

// Tasks and limits are longer on a loaded machine, where the program needs longer to start, too.
static const char *sample_spec(int rows, double task_ms)
{
    static char spec[64];
    snprintf(spec, sizeof spec, "sample:rows=%d,wait_ms=%.0f", rows, task_ms * test_time_factor());
    return spec;
}

// Starts a bake, interrupts it after a while and returns how long it took to end, both in seconds
// of an idle machine.
static double interrupt(const char *gi, double after_s)
{
    char program[] = AFTERGLOW_PROGRAM, command[] = "bake", scene[] = "@cornell", option[] = "--gi",
         quiet[] = "--quiet",
         *words[] = { program, command, scene, option, (char *)gi, quiet, NULL };
    const pid_t child = fork();
    if (child == 0) {
        signal(SIGINT, SIG_DFL);
        fclose(stderr);
        execv(program, words);
        _exit(127);
    }
    int status = 0;
    test_pause_ms(1e3 * after_s * test_time_factor());
    const double begun = now_s();
    CHECK(child > 0 && kill(child, SIGINT) == 0 && waitpid(child, &status, 0) == child);
    CHECK(WIFEXITED(status) && WEXITSTATUS(status) == 1);
    return (now_s() - begun) / test_time_factor();
}

TEST(bake_stops_within_a_second_of_ctrl_c_and_continues_with_what_was_finished)
{
    const char *folder = use_cache("bake-interrupted");
    const char *gi = sample_spec(200, 30);
    CHECK(interrupt(gi, 1.5) < 1.0);
    assert_int_equal(count_files(folder), 1); // the checkpoint
    json_t *report = run_json(run_expect(0, "bake @cornell --json --quiet --force --gi", gi, NULL));
    assert_int_equal(count_files(folder), 1); // the bake
    CHECK(number(report, "estimate_seconds") < 0.95 * number(report, "seconds"));
    json_decref(report);
}

// Tasks of three seconds that do not poll; the probe has run the first one.
TEST(bake_stops_within_a_second_of_ctrl_c_in_the_middle_of_a_long_task)
{
    const char *folder = use_cache("bake-long");
    CHECK(interrupt(sample_spec(4, 3000), 4.5) < 1.1);
    assert_int_equal(count_files(folder), 1);
}

// ---- render and compare

TEST(render_bakes_by_itself_once)
{
    require_device();
    const char *folder = use_cache("bake-render"), *image = path_of("baked.png"),
               *stats = path_of("baked.json");
    const char *words = "render @cornell:light=point --size 16x16 --gi sample -o";
    const struct run *r = run_expect(1, words, image, "--no-bake", NULL);
    CHECK(strstr(r->err, "there is no bake") && !file_exists(image));
    r = run_expect(0, words, image, "--stats", stats, NULL);
    CHECK(strstr(r->err, "baking sample"));
    assert_int_equal(count_files(folder), 1);
    json_t *document = json_load_file(stats, 0, NULL);
    CHECK_NEAR(number(json_object_get(document, "bake"), "bytes"), 64, 0);
    CHECK(number(json_object_get(document, "bake"), "seconds") > 0.0);
    json_decref(document);
    r = run_expect(0, words, image, "--no-bake", NULL);
    CHECK(!strstr(r->err, "baking sample"));
}

TEST(render_makes_a_damaged_bake_again)
{
    require_device();
    const char *folder = use_cache("bake-damaged"), *image = path_of("again.png");
    json_t *report =
        run_json(run_expect(0, "bake @cornell:light=point --gi sample --json --quiet", NULL));
    const char *path = json_string_value(json_object_get(report, "output"));
    write_file(path, "damaged", 7);
    const char *words = "render @cornell:light=point --size 16x16 --gi sample -o";
    CHECK(strstr(run_expect(0, words, image, NULL)->err, "warning: sample is baked again"));
    CHECK(!strstr(run_expect(0, words, image, NULL)->err, "baked again"));
    assert_int_equal(count_files(folder), 1);
    json_decref(report);
}

TEST(render_with_a_bake_of_another_scene_fails_and_says_so)
{
    require_device();
    use_cache("bake-other");
    const char *bake = path_of("other.safetensors"), *image = path_of("other.png");
    run_expect(0, "bake @diagonal --gi sample --quiet -o", bake, NULL);
    const struct run *r =
        run_expect(1, "render @cornell --size 16x16 --gi sample -o", image, "--bake", bake, NULL);
    check_one_error_line(r);
    CHECK(strstr(r->err, "it is of another scene") && !file_exists(image));
    run_expect(0, "render @diagonal --size 16x16 --gi sample -o", image, "--bake", bake, NULL);
}

static void check_refused_bake(const char *words, const char *bake, const char *more,
                               const char *image, const char *names)
{
    const struct run *r =
        run_expect(1, words, image, "--bake", bake, more ? "--bake" : NULL, more, NULL);
    check_one_error_line(r);
    if (!strstr(r->err, names)) fail_msg("%s: %s", words, r->err);
    CHECK(strstr(r->err, bake) && !file_exists(image));
}

TEST(render_with_a_file_that_is_no_bake_says_what_it_is)
{
    char image[300];
    const char *json = path_of("no-bake.json"), *text = path_of("no-bake.txt");
    static const char members[] = "\n{\"blocks\": []}", words[] = "0123456789";
    use_cache("render-no-bake");
    snprintf(image, sizeof image, "%s", path_of("no-bake.png"));
    write_file(json, members, sizeof members - 1);
    write_file(text, words, sizeof words - 1);
    const struct run *r =
        run_expect(1, "render @cornell --gi sample --size 16x16 -o", image, "--bake", json, NULL);
    check_one_error_line(r);
    CHECK(strstr(r->err, "it is JSON text, not a safetensors file"));
    r = run_expect(1, "render @cornell --gi sample --size 16x16 -o", image, "--bake", text, NULL);
    CHECK(strstr(r->err, "it is not a safetensors file"));
}

// Before the scene is loaded: there is none of that name.
TEST(bake_file_that_no_technique_of_the_run_uses_is_refused)
{
    use_cache("bake-unused");
    const char *bake = path_of("unused.safetensors"), *copy = path_of("unused-2.safetensors"),
               *absent = path_of("absent.safetensors"), *out = path_of("unused.png"),
               *folder = path_of("unused-compare");
    run_expect(0, "bake @cornell --gi sample --quiet -o", bake, NULL);
    run_expect(0, "bake @cornell --gi sample --quiet -o", copy, NULL);
    check_refused_bake("render absent.glb --gi none -o", bake, NULL, out,
                       "it is of sample, which --gi none does not use");
    check_refused_bake("compare absent.glb --gi none --gi none -o", bake, NULL, folder,
                       "it is of sample, which no --gi uses");
    check_refused_bake("render absent.glb --gi sample -o", bake, copy, out, "is of sample too");
    check_refused_bake("render absent.glb --gi none -o", absent, NULL, out, "absent.safetensors");
    check_refused_bake("compare absent.glb --gi none -o", absent, NULL, folder,
                       "absent.safetensors");
}

TEST(compare_says_what_the_bake_of_a_method_cost)
{
    require_device();
    use_cache("bake-compare");
    const char *words = "compare @cornell:light=point --size 16x16 --spp 1 --frames 1 --json "
                        "--quiet --gi none --gi sample -o";
    for (int i = 0; i < 2; i++) {
        json_t *report = run_json(run_expect(0, words, path_of("baked-compare"), NULL));
        const json_t *methods = json_object_get(report, "methods");
        const json_t *bake = json_object_get(json_array_get(methods, 1), "bake");
        CHECK(!json_object_get(json_array_get(methods, 0), "bake"));
        CHECK_NEAR(number(bake, "bytes"), 64, 0);
        CHECK(json_is_number(json_object_get(bake, "seconds"))); // of the run that made it
        CHECK(json_is_true(json_object_get(bake, "cached")) == (i == 1));
        json_decref(report);
    }
}

// ---- the cache

TEST(cache_lists_and_clears_references_and_bakes)
{
    require_device();
    const char *folder = use_cache("cache-list");
    char other[700];
    run_expect(0, "compare @cornell:light=point --size 16x16 --spp 1 --frames 1 --gi sample -o",
               path_of("cached-compare"), NULL);
    snprintf(other, sizeof other, "%s/notes.txt", folder);
    write_file(other, "mine", 4);
    json_t *list = run_json(run_expect(0, "cache --json", NULL));
    const json_t *files = json_object_get(list, "files");
    CHECK(json_array_size(files) == 2 && number(list, "bytes") > 100.0);
    CHECK_NEAR(number(list, "limit_bytes"), 2147483648.0, 0);
    CHECK_STRING(json_string_value(json_object_get(json_array_get(files, 0), "kind")), "bake");
    CHECK_STRING(json_string_value(json_object_get(json_array_get(files, 1), "kind")), "reference");
    json_decref(list);
    CHECK(strstr(run_expect(0, "cache", NULL)->out, "2 files"));
    CHECK(strstr(run_expect(0, "cache --clear", NULL)->err, "removed 2 files"));
    CHECK(strstr(run_expect(0, "cache", NULL)->out, "0 files"));
    CHECK(file_exists(other)); // not ours
}

// A sparse file of 3 GiB takes no space.
static void write_old_bake(const char *folder, const char *name, time_t used, off_t bytes)
{
    char path[800];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    write_file(path, "", 0);
    CHECK(truncate(path, bytes) == 0);
    CHECK(utime(path, &(struct utimbuf){ used, used }) == 0);
}

static json_t *cached_file(const json_t *list, size_t index)
{
    return json_array_get(json_object_get(list, "files"), index);
}

static void set_age(const json_t *list, size_t index, long seconds)
{
    const char *path = json_string_value(json_object_get(cached_file(list, index), "path"));
    const struct utimbuf times = { time(NULL) - seconds, time(NULL) - seconds };
    CHECK(path && utime(path, &times) == 0);
}

TEST(cache_shows_scene_technique_options_size_and_age)
{
    const char *folder = use_cache("cache-words");
    char damaged[700];
    run_expect(0, "bake @cornell --gi sample:rows=9 --quiet", NULL);
    run_expect(0, "bake @cornell --gi sample --scene-scale 0.5 --quiet", NULL);
    json_t *list = run_json(run_expect(0, "cache --json", NULL));
    const json_t *nine = cached_file(list, 0);
    CHECK_STRING(json_string_value(json_object_get(nine, "scene")), "@cornell");
    CHECK_STRING(json_string_value(json_object_get(nine, "technique")), "sample");
    CHECK(strstr(json_string_value(json_object_get(nine, "options")), "rows=9"));
    set_age(list, 0, 3 * 3600 + 5);
    set_age(list, 1, 2 * 86400 + 5);
    const struct run *r = run_expect(0, "cache", NULL);
    CHECK(strstr(r->out, "3 h  @cornell                  sample:rows=9\n"));
    CHECK(strstr(r->out, "2 d  @cornell --scene-scale 0.5  sample\n"));
    CHECK(!strstr(r->out, ".safetensors"));
    CHECK(strstr(run_expect(0, "cache --verbose", NULL)->out, ".safetensors\n"));
    json_decref(list);
    // A file that states nothing is listed too.
    snprintf(damaged, sizeof damaged, "%s/0123456789abcdef0123456789abcdef.safetensors", folder);
    write_file(damaged, "{\"a\": 1}    ", 12);
    CHECK(strstr(run_expect(0, "cache", NULL)->out, "now  ?"));
    list = run_json(run_expect(0, "cache --json", NULL));
    CHECK(json_is_null(json_object_get(cached_file(list, 2), "scene")));
    json_decref(list);
}

TEST(cache_shows_the_view_of_a_reference)
{
    require_device();
    use_cache("cache-view");
    run_expect(0,
               "compare @cornell:light=point --size 16x16 --spp 1 --frames 1 --gi none "
               "--bounces 2 --scene-scale 2 -o",
               path_of("view-compare"), NULL);
    CHECK(strstr(run_expect(0, "cache", NULL)->out,
                 "@cornell:light=point --scene-scale 2  16x16, main, 2 bounces\n"));
}

TEST(cache_over_its_limit_loses_the_least_recently_used_files)
{
    const char *folder = use_cache("cache-limit");
    CHECK(mkdir(folder, 0700) == 0);
    write_old_bake(folder, "00000000000000000000000000000001.safetensors", 1000, 1 << 30);
    write_old_bake(folder, "00000000000000000000000000000002.safetensors", 3000, 1 << 30);
    write_old_bake(folder, "00000000000000000000000000000003.safetensors.checkpoint", 2000, 1000);
    const struct run *r = run_expect(0, "bake @cornell --gi sample --verbose", NULL);
    CHECK(strstr(r->err, "00000000000000000000000000000001.safetensors"));
    CHECK(strstr(r->err, "made room"));
    assert_int_equal(count_files(folder), 3);
}

static const struct run *run_without_cache(int status, const char *words, const char *path)
{
    const struct run *r = run_expect(status, words, path, NULL);
    if (!strstr(r->err, "no cache") || !strstr(r->err, "set AFTERGLOW_CACHE"))
        fail_msg("%s: %s", words, r->err);
    return r;
}

// Checks what is said with the cache that the environment names.
static void check_without_cache(const char *why)
{
    const char *file = path_of("uncached.safetensors"), *image = path_of("uncached.png");
    const struct run *r = run_without_cache(1, "bake @cornell --gi sample", NULL);
    check_one_error_line(r);
    CHECK(strstr(r->err, why) && strstr(r->err, "use -o FILE.safetensors"));
    r = run_expect(0, "bake @cornell --gi sample -o", file, NULL);
    CHECK(!strstr(r->err, "no cache") && file_exists(file));
    r = run_without_cache(0, "render @cornell --size 16x16 --gi sample -o", image);
    CHECK(strstr(r->err, "no cache") < strstr(r->err, "texels")); // before the work
    r = run_expect(0, "render @cornell --size 16x16 --gi sample -o", image, "--bake", file, NULL);
    CHECK(!strstr(r->err, "no cache"));
    r = run_without_cache(0, "compare @cornell --size 16x16 --spp 1 --frames 1 --gi none -o",
                          path_of("uncached-compare"));
    CHECK(strstr(r->err, "use --reference FILE.exr"));
    unlink(file);
}

TEST(results_that_no_cache_keeps_are_announced_before_the_work)
{
    require_device();
    char home[PATH_MAX];
    const char *given = getenv("HOME");
    snprintf(home, sizeof home, "%s", given ? given : "/");
    setenv("AFTERGLOW_CACHE", "/dev/null/cache", 1);
    check_without_cache("/dev/null/cache");
    unsetenv("AFTERGLOW_CACHE");
    unsetenv("XDG_CACHE_HOME");
    unsetenv("HOME");
    check_without_cache("neither AFTERGLOW_CACHE, XDG_CACHE_HOME nor HOME names a folder");
    setenv("HOME", home, 1);
}

// The disk of tests/cli/full_disk.c.
TEST(bake_that_the_disk_has_no_room_for_is_refused_before_the_work)
{
    require_device();
    const char *path = test_path("no-room.safetensors");
    use_cache("cache-full");
    setenv("LD_PRELOAD", FULL_DISK, 1);
    const struct run *r = run_expect(1, "bake @cornell --gi sample -o", path, NULL);
    check_one_error_line(r);
    CHECK(strstr(r->err, "0.0 MB are free there, it needs") && !file_exists(path));
    r = run_expect(1, "bake @cornell --gi sample", NULL);
    CHECK(strstr(r->err, "afterglow cache --clear") && !strstr(r->err, "baking sample"));
    r = run_expect(0, "render @cornell:light=point --size 16x16 --gi sample -o",
                   test_path("no-room.png"), NULL);
    unsetenv("LD_PRELOAD");
    CHECK(strstr(r->err, "is not kept for the next run: 0.0 MB are free there"));
}

#define LEFT_BAKE      "00000000000000000000000000000001.safetensors.tmp-0123456789abcdef"
#define LEFT_REFERENCE "reference-1-0123456789abcdef.exr.tmp-0123456789abcdef"

static const char *kind_of(const json_t *list, size_t i)
{
    const json_t *file = json_array_get(json_object_get(list, "files"), i);
    return json_string_value(json_object_get(file, "kind"));
}

// Both kinds, and one that a process is writing.
TEST(cache_lists_and_clears_what_killed_writers_left)
{
    char references[700], held[800];
    const char *bakes = use_cache("cache-left");
    snprintf(references, sizeof references, "%s/references", getenv("AFTERGLOW_CACHE"));
    snprintf(held, sizeof held, "%s/%s", bakes,
             "00000000000000000000000000000002.safetensors.tmp-0123456789abcdef");
    CHECK(mkdir(bakes, 0700) == 0 && mkdir(references, 0700) == 0);
    write_old_bake(bakes, LEFT_BAKE, 1000, 1000000);
    write_old_bake(references, LEFT_REFERENCE, 2000, 2000000);
    write_file(held, "half", 4);
    const int lock = open(held, O_RDONLY | O_CLOEXEC);
    CHECK(lock >= 0 && flock(lock, LOCK_EX) == 0);
    json_t *list = run_json(run_expect(0, "cache --json", NULL));
    assert_int_equal(json_array_size(json_object_get(list, "files")), 2);
    CHECK_STRING(kind_of(list, 0), "left-over");
    CHECK_STRING(kind_of(list, 1), "left-over");
    CHECK_NEAR(number(list, "bytes"), 3000000.0, 0);
    json_decref(list);
    CHECK(strstr(run_expect(0, "cache", NULL)->out, "left-over"));
    CHECK(strstr(run_expect(0, "cache --clear", NULL)->err, "removed 2 files, 3.0 MB"));
    assert_int_equal(count_files(bakes), 1);
    assert_int_equal(count_files(references), 0);
    CHECK(file_exists(held) && close(lock) == 0);
}

TEST(cache_over_its_limit_loses_what_killed_writers_left)
{
    const char *folder = use_cache("cache-limit-left");
    CHECK(mkdir(folder, 0700) == 0);
    write_old_bake(folder, LEFT_BAKE, 1000, 3LL << 30);
    run_expect(0, "bake @cornell --gi sample --quiet", NULL);
    assert_int_equal(count_files(folder), 1);
}
