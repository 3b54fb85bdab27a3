// Temporary names, their locks, and removal of what a killed process left.
#include "framework/test.h"

#include "core/files/file.h"
#include "core/files/temporary.h"

#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

static bool exists(const char *path)
{
    struct stat info;
    return lstat(path, &info) == 0;
}

static int removed;
static void count_removed(void *user, const char *path)
{
    CHECK(user == &removed && strstr(path, ".tmp-") && !exists(path));
    removed++;
}

static int remove_stale(const char *target)
{
    removed = 0;
    temporary_remove_stale(target, count_removed, &removed);
    return removed;
}

// Runs `work` in a process that is killed while it holds what it made.
static void in_killed_process(void (*work)(const char *target), const char *target)
{
    const pid_t child = fork();
    CHECK(child >= 0);
    if (child == 0) {
        work(target);
        kill(getpid(), SIGKILL);
    }
    int status = 0;
    CHECK(waitpid(child, &status, 0) == child && WIFSIGNALED(status));
}

static void make_file(const char *target)
{
    struct temporary temporary;
    if (!temporary_file(&temporary, target)) _exit(1);
}

static void make_folder(const char *target)
{
    struct temporary temporary;
    char path[TEMPORARY_PATH + 8];
    if (!temporary_folder(&temporary, target)) _exit(1);
    snprintf(path, sizeof path, "%s/a", temporary.path);
    FILE *file = fopen(path, "w");
    if (!file || fclose(file) != 0) _exit(1);
}

TEST(names_of_one_target_differ)
{
    const char *target = test_path("names.exr");
    struct temporary a, b;
    CHECK(temporary_file(&a, target) && temporary_file(&b, target));
    CHECK(strcmp(a.path, b.path) != 0);
    CHECK(strlen(a.path) == strlen(target) + 21);
    CHECK(strncmp(a.path, target, strlen(target)) == 0);
    CHECK(unlink(a.path) == 0 && unlink(b.path) == 0);
    temporary_release(&a);
    temporary_release(&b);
    temporary_release(&a);
}

TEST(what_is_in_use_stays)
{
    const char *target = test_path("used.exr");
    struct temporary file, folder;
    CHECK(temporary_file(&file, target) && temporary_folder(&folder, target));
    assert_int_equal(remove_stale(target), 0);
    CHECK(exists(file.path) && exists(folder.path));
    CHECK(unlink(file.path) == 0 && rmdir(folder.path) == 0);
    temporary_release(&file);
    temporary_release(&folder);
}

TEST(what_a_killed_process_left_is_removed)
{
    const char *target = test_path("left.exr");
    in_killed_process(make_file, target);
    in_killed_process(make_file, target);
    assert_int_equal(remove_stale(target), 2);
    assert_int_equal(remove_stale(target), 0);
    in_killed_process(make_folder, target);
    assert_int_equal(remove_stale(target), 1);
}

TEST(other_names_stay)
{
    static const char *const names[] = {
        "kept.exr.tmp-0123456789abcdeg",  "kept.exr.tmp-0123456789abcde",
        "kept.exr.tmp-0123456789abcdef0", "kept.exr",
        "kept.tmp-0123456789abcdef",
    };
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        FILE *file = fopen(test_path(names[i]), "w");
        CHECK(file && fclose(file) == 0);
    }
    // Neither is a link followed nor a folder with folders in it removed.
    CHECK(symlink(test_path("kept.exr"), test_path("kept.exr.tmp-0000000000000001")) == 0);
    CHECK(mkdir(test_path("kept.exr.tmp-0000000000000002"), 0777) == 0);
    CHECK(mkdir(test_path("kept.exr.tmp-0000000000000002/x"), 0777) == 0);
    assert_int_equal(remove_stale(test_path("kept.exr")), 0);
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) CHECK(exists(test_path(names[i])));
    CHECK(exists(test_path("kept.exr.tmp-0000000000000001")));
    CHECK(exists(test_path("kept.exr.tmp-0000000000000002/x")));
}

TEST(the_next_write_names_what_was_left_and_replaces_it)
{
    const char *target = test_path("next.txt");
    struct file_writer writer;
    in_killed_process(make_file, target);
    test_forget_messages();
    CHECK(file_begin(&writer, test_host(), target));
    CHECK(strstr(test_last_message(), "next.txt: removed ") &&
          strstr(test_last_message(), ".tmp-"));
    assert_int_equal(remove_stale(target), 0);
    CHECK(file_write(&writer, "x", 1) && file_commit(&writer));
    CHECK(exists(target));
    assert_int_equal(remove_stale(target), 0);
}

TEST(name_of_a_temporary_file_states_its_target)
{
    assert_int_equal(temporary_stem("a.exr.tmp-0123456789abcdef"), 5);
    assert_int_equal(temporary_stem("a.exr.tmp-0123456789abcde"), 0);
    assert_int_equal(temporary_stem("a.exr.tmp-0123456789abcdeg"), 0);
    assert_int_equal(temporary_stem("a.exr.tmp-0123456789abcdef0"), 0);
    assert_int_equal(temporary_stem("a.exr"), 0);
    assert_int_equal(temporary_stem(""), 0);
}

TEST(only_a_file_that_no_process_holds_is_removed_by_its_path)
{
    struct temporary t;
    char path[TEMPORARY_PATH];
    CHECK(temporary_file(&t, test_path("held")));
    memcpy(path, t.path, sizeof path);
    CHECK(temporary_is_held(path) && !temporary_remove(path));
    temporary_release(&t);
    CHECK(!temporary_is_held(path) && temporary_remove(path));
    CHECK(!temporary_remove(path));
}
