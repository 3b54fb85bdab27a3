// compare: bounds, wrong usage, complete folders, interruption.
#include "cli/compare/compare_run.h"

#include <dirent.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

static int count_lines(const char *text)
{
    int count = 0;
    while ((text = strchr(text, '\n'))) count++, text++;
    return count;
}

TEST(a_method_exceeding_a_bound_fails_after_the_report)
{
    require_device();
    own_cache("bounds-cache");
    const char *folder = path_of("bounds");
    const struct run *r =
        run_expect(1, SMALL " --gi ambient --max-flip 0.01 --max-relmse 1e9 -o", folder, NULL);
    assert_int_equal(count_lines(r->err), 2);
    CHECK(strstr(r->err, "afterglow: flip of none: 0.") && strstr(r->err, "--max-flip 0.01"));
    CHECK(file_exists(path_in(folder, "report.json")) && strstr(r->out, "\nambient"));
    r = run_expect(1, SMALL " --max-relmse 0 --max-ms 0 -o", folder, NULL);
    CHECK(strstr(r->err, "relmse of none") && strstr(r->err, "ms of none"));
    run_expect(0, SMALL " --max-flip 1 --max-relmse 1e9 --max-ms 1e9 -o", folder, NULL);
}

TEST(wrong_usage_is_reported_before_the_work)
{
    static const char *const wrong[] = {
        "--gi lvp",
        "--gi none --gi lpv:steps=0",
        "--frame-options size=3",
        "--max-flip -1",
        "--max-ms x",
        "--reference a.png",
        "--reference a.exr --spp 4",
        "--frames 0",
        "--aov color",
        "--gi lpv --eye 1,2,3",
        "--antialias",
    };
    char words[200];
    for (size_t i = 0; i < sizeof wrong / sizeof wrong[0]; i++) {
        snprintf(words, sizeof words, "compare @cornell %s -o", wrong[i]);
        check_one_error_line(run_expect(2, words, path_of("wrong"), NULL));
    }
    char many[400] = "compare @cornell";
    for (int i = 0; i < 17; i++) strcat(many, " --gi none");
    check_one_error_line(run_expect(2, many, NULL));
    check_one_error_line(run_expect(1, SMALL " --camera nobody -o", path_of("wrong"), NULL));
    CHECK(!file_exists(path_of("wrong")));
}

TEST(a_foreign_folder_is_left_alone)
{
    require_device();
    own_cache("folders-cache");
    char folder[400], file[500];
    snprintf(folder, sizeof folder, "%s", make_folder("folder"));
    snprintf(file, sizeof file, "%s/notes.txt", folder);
    write_file(file, "mine", 4);
    check_one_error_line(run_expect(1, SMALL " -o", folder, NULL)); // no report in it
    check_one_error_line(run_expect(1, SMALL " -o", file, NULL));
    check_one_error_line(run_expect(1, SMALL " -o", path_in(folder, "none/deeper"), NULL));
    check_one_error_line(run_expect(1, SMALL " -o", "/proc/compare", NULL));
    unlink(file);
    run_expect(0, SMALL " --gi ambient -o", folder, NULL); // an empty one
    CHECK(file_exists(path_in(folder, "2-ambient.png")));
    run_expect(0, SMALL " -o", folder, NULL); // one of its own; what was in it is gone
    CHECK(!file_exists(path_in(folder, "2-ambient.png")) &&
          file_exists(path_in(folder, "1-none.png")));
    write_file(file, "mine", 4);
    const struct run *r = run_expect(1, SMALL " -o", folder, NULL);
    check_one_error_line(r);
    CHECK(strstr(r->err, "notes.txt"));
    unlink(file);
    // Through a symbolic link, and with a trailing slash.
    const char *link = path_of("link");
    assert_int_equal(symlink(folder, link), 0);
    run_expect(0, SMALL " --gi ambient -o", path_in(link, ""), NULL);
    CHECK(file_exists(path_in(folder, "2-ambient.png")));
    struct stat info;
    CHECK(lstat(link, &info) == 0 && S_ISLNK(info.st_mode));
    // The current folder is never replaced.
    char before[1000];
    assert_true(getcwd(before, sizeof before) && chdir(folder) == 0);
    check_one_error_line(run_expect(1, SMALL " -o .", NULL));
    assert_int_equal(chdir(before), 0);
    // The default name is that of the scene.
    assert_int_equal(chdir(make_folder("elsewhere")), 0);
    run_expect(0, SMALL, NULL);
    CHECK(file_exists("cornell-compare/report.json"));
    assert_int_equal(count_files("."), 1);
    assert_int_equal(chdir(before), 0);
}

// ---- interruption

static pid_t start(const char *words, const char *folder)
{
    static char text[2000];
    char *list[80] = { (char *)AFTERGLOW_PROGRAM };
    int count = 1;
    snprintf(text, sizeof text, "%s", words);
    char *rest = text;
    for (char *word; (word = strsep(&rest, " ")) && count < 77;) list[count++] = word;
    list[count++] = (char *)"-o";
    list[count++] = (char *)folder;
    fflush(NULL);
    pid_t child = fork();
    if (child < 0) fail_msg("cannot fork");
    if (child == 0) {
        signal(SIGINT, SIG_DFL);
        if (!freopen("/dev/null", "w", stdout) || !freopen("/dev/null", "w", stderr)) _exit(126);
        execv(AFTERGLOW_PROGRAM, list);
        _exit(127);
    }
    return child;
}

static bool has_entry(const char *folder, const char *part)
{
    DIR *dir = opendir(folder);
    bool found = false;
    for (struct dirent *entry; dir && (entry = readdir(dir));)
        found |= strstr(entry->d_name, part) != NULL;
    if (dir) closedir(dir);
    return found;
}

TEST(ctrl_c_keeps_the_samples_and_leaves_no_folder)
{
    require_device();
    char home[400], folder[500];
    snprintf(home, sizeof home, "%s", make_folder("stopped"));
    snprintf(folder, sizeof folder, "%s/results", home);
    const char *cache = own_cache("stopped-cache");
    pid_t child = start("compare @cornell --size 24x18 --frames 1 --gi none --spp 1000000", folder);
    for (int i = 0; i < 60000 * test_time_factor() && !has_entry(cache, "reference"); i++)
        test_pause_ms(1);
    test_pause_ms(200 * test_time_factor()); // the first samples are written; more are being traced
    assert_int_equal(kill(child, SIGINT), 0);
    int status = 0;
    assert_true(waitpid(child, &status, 0) == child);
    CHECK(WIFEXITED(status) && WEXITSTATUS(status) == 1);
    CHECK(!file_exists(folder) && !has_entry(home, ".tmp-"));
    assert_int_equal(count_files(cache), 1);
    // The next run uses them.
    run_expect(0, SMALL " -o", folder, NULL);
    json_t *report = report_of(folder);
    CHECK(json_is_true(json_object_get(json_object_get(report, "reference"), "cached")));
    CHECK(of_reference(report, "spp") > 2);
    json_decref(report);
}

TEST(a_signal_while_the_folder_is_filled_leaves_none)
{
    require_device();
    own_cache("filled-cache");
    char home[400], folder[500], words[600];
    snprintf(home, sizeof home, "%s", make_folder("filled"));
    snprintf(folder, sizeof folder, "%s/results", home);
    snprintf(words, sizeof words, "compare @cornell --size 256x192 --frames 1 --spp 1 --quiet");
    for (int i = 0; i < 8; i++) strcat(words, " --gi none");
    pid_t child = start(words, folder);
    int status = 0;
    for (int i = 0; i < 60000 * test_time_factor() && !has_entry(home, ".tmp-"); i++)
        test_pause_ms(1);
    kill(child, SIGTERM);
    assert_true(waitpid(child, &status, 0) == child);
    CHECK(WIFSIGNALED(status) && WTERMSIG(status) == SIGTERM);
    CHECK(!has_entry(home, ".tmp-") && !file_exists(folder));
}
