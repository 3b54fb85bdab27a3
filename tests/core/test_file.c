// Whole-file reads and atomic writes.
#include "framework/test.h"

#include "core/files/file.h"

#include <dirent.h>
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

static void write_text(const char *path, const char *text)
{
    FILE *f = fopen(path, "wb");
    assert_non_null(f);
    fputs(text, f);
    assert_int_equal(fclose(f), 0);
}

static const char *read_text(const char *path)
{
    static char text[256];
    struct file_bytes bytes;
    CHECK(file_read(test_host(), path, sizeof text - 1, &bytes));
    memcpy(text, bytes.data, bytes.size + 1);
    file_bytes_finish(test_host(), &bytes);
    return text;
}

// A new, empty folder.
static const char *fresh_folder(const char *name)
{
    const char *path = test_path(name);
    assert_int_equal(mkdir(path, 0777), 0);
    return path;
}

static int entries_in(const char *folder)
{
    DIR *dir = opendir(folder);
    assert_non_null(dir);
    int count = 0;
    for (struct dirent *entry; (entry = readdir(dir));) count += entry->d_name[0] != '.';
    closedir(dir);
    return count;
}

static const char *in(const char *folder, const char *name)
{
    static char path[1024];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    return path;
}

// Reading `path` fails with "cannot read <path>: <why>".
static void check_unreadable(const char *path, size_t max_bytes, const char *why)
{
    char expected[1024];
    snprintf(expected, sizeof expected, "cannot read %s: %s", path, why);
    struct file_bytes bytes;
    CHECK(!file_read(test_host(), path, max_bytes, &bytes));
    CHECK_STRING(test_last_message(), expected);
    assert_int_equal(test_host()->failure, FAIL_FILE);
    assert_null(bytes.data);
    assert_int_equal(bytes.size, 0);
    file_bytes_finish(test_host(), &bytes);
}

static void check_unwritable(const char *path, const char *why)
{
    char expected[1024];
    snprintf(expected, sizeof expected, "cannot write %s: %s", path, why);
    struct file_writer writer;
    CHECK(!file_begin(&writer, test_host(), path));
    CHECK_STRING(test_last_message(), expected);
    assert_int_equal(test_host()->failure, FAIL_FILE);
    file_abort(&writer); // no effect after a failed begin
}

TEST(file_is_read_whole_with_a_terminating_zero)
{
    const char *path = test_path("read.bin");
    FILE *f = fopen(path, "wb");
    for (int i = 0; i < 100000; i++) fputc(i * 7 & 255, f);
    fclose(f);
    struct file_bytes bytes;
    CHECK(file_read(test_host(), path, 100000, &bytes));
    assert_int_equal(bytes.size, 100000);
    for (int i = 0; i < 100000; i++) CHECK(bytes.data[i] == (i * 7 & 255));
    CHECK(bytes.data[100000] == 0);
    file_bytes_finish(test_host(), &bytes);
    assert_null(bytes.data);
}

TEST(empty_file_is_zero_bytes)
{
    const char *path = test_path("empty");
    write_text(path, "");
    struct file_bytes bytes;
    CHECK(file_read(test_host(), path, 0, &bytes));
    assert_int_equal(bytes.size, 0);
    CHECK(bytes.data && bytes.data[0] == 0);
    file_bytes_finish(test_host(), &bytes);
}

TEST(start_of_a_file_is_read_whatever_its_size)
{
    const char *path = test_path("start");
    struct file_bytes bytes;
    write_text(path, "12345");
    CHECK(file_read_start(test_host(), path, 6, &bytes) && bytes.size == 5);
    CHECK_STRING((const char *)bytes.data, "12345");
    file_bytes_finish(test_host(), &bytes);
    assert_int_equal(truncate(path, (off_t)5 << 30), 0); // sparse
    CHECK(file_read_start(test_host(), path, 3, &bytes) && bytes.size == 3);
    CHECK_STRING((const char *)bytes.data, "123");
    file_bytes_finish(test_host(), &bytes);
    CHECK(!file_read_start(test_host(), test_path("no-start"), 3, &bytes) && !bytes.data);
    CHECK(strstr(test_last_message(), "No such file or directory"));
}

TEST(unreadable_files_fail_with_a_message)
{
    check_unreadable(test_path("missing"), 0, "No such file or directory");
    check_unreadable(fresh_folder("a_folder"), 0, "it is a folder");
    const char *large = test_path("large");
    write_text(large, "12345");
    check_unreadable(large, 4, "5 bytes are more than the 4 allowed");
    CHECK_STRING(read_text(large), "12345");
    const char *pipe = test_path("pipe");
    assert_int_equal(mkfifo(pipe, 0600), 0);
    check_unreadable(pipe, 0, "not a regular file");
    const char *sparse = test_path("sparse");
    write_text(sparse, "");
    assert_int_equal(truncate(sparse, ((off_t)4 << 30) + 1), 0);
    check_unreadable(sparse, 0, "4294967297 bytes are more than the 4294967296 allowed");
}

TEST(commit_writes_the_whole_content_and_leaves_no_temporary_file)
{
    const char *folder = fresh_folder("commit"), *path = in(folder, "out.txt");
    struct file_writer writer;
    CHECK(file_begin(&writer, test_host(), path));
    fputs("new", writer.stream);
    fflush(writer.stream);
    CHECK(access(path, F_OK) != 0); // not before the commit
    CHECK(file_commit(&writer));
    CHECK_STRING(read_text(path), "new");
    assert_int_equal(entries_in(folder), 1);
}

TEST(old_content_stays_until_the_commit)
{
    const char *folder = fresh_folder("replace"), *path = in(folder, "out.txt");
    write_text(path, "old");
    struct file_writer writer;
    CHECK(file_begin(&writer, test_host(), path));
    fputs("new", writer.stream);
    CHECK_STRING(read_text(path), "old");
    file_abort(&writer);
    CHECK_STRING(read_text(path), "old");
    CHECK(file_begin(&writer, test_host(), path));
    fputs("new", writer.stream);
    CHECK(file_commit(&writer));
    CHECK_STRING(read_text(path), "new");
    assert_int_equal(entries_in(folder), 1);
}

TEST(abort_leaves_no_file)
{
    const char *folder = fresh_folder("abort");
    struct file_writer writer;
    CHECK(file_begin(&writer, test_host(), in(folder, "a")));
    fputs("half", writer.stream);
    file_abort(&writer);
    assert_int_equal(entries_in(folder), 0);
}

TEST(two_writers_of_one_path_do_not_mix)
{
    const char *folder = fresh_folder("two"), *path = in(folder, "out.txt");
    struct file_writer a, b;
    CHECK(file_begin(&a, test_host(), path));
    CHECK(file_begin(&b, test_host(), path));
    fputs("from a", a.stream);
    fputs("from b", b.stream);
    CHECK(file_commit(&a));
    CHECK_STRING(read_text(path), "from a");
    CHECK(file_commit(&b));
    CHECK_STRING(read_text(path), "from b");
    assert_int_equal(entries_in(folder), 1);
}

TEST(new_file_has_the_mode_that_the_umask_gives)
{
    mode_t before = umask(027);
    const char *path = test_path("mode");
    struct file_writer writer;
    CHECK(file_begin(&writer, test_host(), path) && file_commit(&writer));
    umask(before);
    struct stat info;
    assert_int_equal(stat(path, &info), 0);
    assert_int_equal(info.st_mode & 0777, 0640);
}

TEST(unwritable_paths_fail_with_a_message)
{
    char path[600];
    snprintf(path, sizeof path, "%s", test_path("no_such_folder/out.png"));
    check_unwritable(path, "no such folder");
    const char *folder = fresh_folder("target_is_a_folder");
    check_unwritable(folder, "it is a folder");
    const char *file = test_path("plain");
    write_text(file, "x");
    snprintf(path, sizeof path, "%s/out.png", file);
    check_unwritable(path, "Not a directory");
    check_unwritable("/dev/null", "not a regular file");
    struct stat info;
    CHECK(stat("/dev/null", &info) == 0 && S_ISCHR(info.st_mode));
}

TEST(read_only_folder_fails_with_a_message)
{
    if (geteuid() == 0) test_skip("root may write anywhere");
    char folder[512];
    snprintf(folder, sizeof folder, "%s", fresh_folder("read_only"));
    assert_int_equal(chmod(folder, 0555), 0);
    check_unwritable(in(folder, "out.png"), "Permission denied");
    chmod(folder, 0777);
}

TEST(symbolic_link_is_written_through)
{
    const char *folder = fresh_folder("links");
    char target[1024], link[1024];
    snprintf(target, sizeof target, "%s", in(folder, "target"));
    snprintf(link, sizeof link, "%s", in(folder, "link"));
    write_text(target, "old");
    assert_int_equal(symlink(target, link), 0);
    struct file_writer writer;
    CHECK(file_begin(&writer, test_host(), link));
    fputs("new", writer.stream);
    CHECK(file_commit(&writer));
    CHECK_STRING(read_text(target), "new");
    struct stat info;
    CHECK(lstat(link, &info) == 0 && S_ISLNK(info.st_mode));
    assert_int_equal(entries_in(folder), 2);
}

// Writes with a file size limit of 4096 bytes, which acts as a full disk; returns whether the
// commit succeeded. With space_before_commit only the stream knows of the failed write.
static bool commit_on_full_disk(const char *path, bool space_before_commit)
{
    struct file_writer writer;
    CHECK(file_begin(&writer, test_host(), path));
    struct rlimit before;
    assert_int_equal(getrlimit(RLIMIT_FSIZE, &before), 0);
    struct rlimit small = { 4096, before.rlim_max };
    void (*handler)(int) = signal(SIGXFSZ, SIG_IGN);
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &small), 0);
    for (int i = 0; i < 100000; i++) fputc('x', writer.stream);
    if (space_before_commit) setrlimit(RLIMIT_FSIZE, &before);
    bool committed = file_commit(&writer);
    setrlimit(RLIMIT_FSIZE, &before);
    signal(SIGXFSZ, handler);
    return committed;
}

TEST(file_name_of_maximum_length_can_be_written)
{
    const char *folder = fresh_folder("long");
    char name[256] = "";
    memset(name, 'n', 255);
    struct file_writer writer;
    CHECK(file_begin(&writer, test_host(), in(folder, name)));
    fputs("here", writer.stream);
    CHECK(file_commit(&writer));
    CHECK_STRING(read_text(in(folder, name)), "here");
    assert_int_equal(entries_in(folder), 1);
}

TEST(failed_write_keeps_the_old_file_and_leaves_no_temporary_file)
{
    const char *folder = fresh_folder("full"), *path = in(folder, "out.txt");
    write_text(path, "old");
    for (int space = 0; space < 2; space++) {
        test_forget_messages();
        CHECK(!commit_on_full_disk(path, space));
        assert_int_equal(test_host()->failure, FAIL_FILE);
        CHECK(strncmp(test_last_message(), "cannot write ", 13) == 0);
        CHECK_STRING(read_text(path), "old");
        assert_int_equal(entries_in(folder), 1);
    }
}

TEST(a_full_disk_is_reported_with_the_path_as_given)
{
    const char *folder = fresh_folder("full_link");
    char target[1024], link[1024], expected[1100];
    snprintf(target, sizeof target, "%s", in(folder, "target"));
    snprintf(link, sizeof link, "%s", in(folder, "link"));
    write_text(target, "old");
    assert_int_equal(symlink(target, link), 0);
    snprintf(expected, sizeof expected, "cannot write %s: %s", link, strerror(EFBIG));
    CHECK(!commit_on_full_disk(link, false));
    CHECK_STRING(test_last_message(), expected);
    CHECK_STRING(read_text(target), "old");
}

// The reason of the first failed write stays, whatever happens afterwards.
TEST(file_write_records_why)
{
    const char *path = test_path("why");
    char bytes[20000] = { 0 }, expected[1100];
    struct rlimit before, small;
    struct file_writer writer;
    CHECK(file_begin(&writer, test_host(), path));
    assert_int_equal(getrlimit(RLIMIT_FSIZE, &before), 0);
    small = (struct rlimit){ 4096, before.rlim_max };
    void (*handler)(int) = signal(SIGXFSZ, SIG_IGN);
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &small), 0);
    CHECK(!file_write(&writer, bytes, sizeof bytes));
    setrlimit(RLIMIT_FSIZE, &before);
    signal(SIGXFSZ, handler);
    CHECK(writer.why == EFBIG && !file_write(&writer, bytes, 1));
    CHECK(!file_commit(&writer));
    snprintf(expected, sizeof expected, "cannot write %s: %s", path, strerror(EFBIG));
    CHECK_STRING(test_last_message(), expected);
}

// A folder of one's own that others can write to, such as a shared cache.
TEST(links_in_a_named_folder_are_not_followed)
{
    const char *folder = fresh_folder("cache");
    char target[1024], link[1024], guarded[512];
    struct host host = *test_host();
    struct file_writer writer;
    struct file_bytes bytes;
    struct stat info;
    CHECK(snprintf(guarded, sizeof guarded, "%s", folder) < (int)sizeof guarded);
    snprintf(target, sizeof target, "%s", test_path("outside"));
    snprintf(link, sizeof link, "%s", in(folder, "link"));
    write_text(target, "outside");
    assert_int_equal(symlink(target, link), 0);
    CHECK(file_read(&host, link, 0, &bytes));
    file_bytes_finish(&host, &bytes);

    host.no_links_in = guarded;
    CHECK(!file_read(&host, link, 0, &bytes));
    CHECK(strstr(test_last_message(), "it is a symbolic link"));
    CHECK(file_begin(&writer, &host, link));
    fputs("inside", writer.stream);
    CHECK(file_commit(&writer));
    CHECK_STRING(read_text(target), "outside");
    CHECK_STRING(read_text(link), "inside");
    CHECK(lstat(link, &info) == 0 && S_ISREG(info.st_mode));
    CHECK(file_read(&host, link, 0, &bytes)); // a regular file there is read
    file_bytes_finish(&host, &bytes);
    snprintf(link, sizeof link, "%s_beside", guarded); // begins with the folder's name only
    assert_int_equal(symlink(target, link), 0);
    CHECK(file_read(&host, link, 0, &bytes));
    file_bytes_finish(&host, &bytes);
}

TEST(failed_rename_leaves_no_temporary_file)
{
    const char *folder = fresh_folder("rename"), *path = in(folder, "out");
    struct file_writer writer;
    CHECK(file_begin(&writer, test_host(), path));
    assert_int_equal(mkdir(path, 0777), 0); // created between begin and commit
    CHECK(!file_commit(&writer));
    assert_int_equal(test_host()->failure, FAIL_FILE);
    assert_int_equal(entries_in(folder), 1);
}

TEST(zeroed_writer_can_be_committed_and_aborted)
{
    struct file_writer writer = { 0 };
    file_abort(&writer);
    CHECK(!file_commit(&writer));
}

static void *no_memory(void *user, void *old, size_t bytes)
{
    int *allowed = user;
    if (bytes == 0) {
        free(old);
        return NULL;
    }
    return (*allowed)-- > 0 ? realloc(old, bytes) : NULL;
}

TEST(out_of_memory_leaves_no_file)
{
    const char *folder = fresh_folder("memory");
    for (int allowed = 0; allowed < 2; allowed++) {
        int left = allowed;
        struct host host = { .reallocate = no_memory, .user = &left };
        struct file_writer writer;
        CHECK(!file_begin(&writer, &host, in(folder, "out")));
        assert_int_equal(host.failure, FAIL_MEMORY);
        assert_int_equal(entries_in(folder), 0);
    }
}

TEST(extension_begins_after_the_last_dot)
{
    static const char *const cases[][2] = {
        { "a.PNG", "png" },  { "x/y.tar.gz", "gz" },
        { "none", "" },      { "dir.d/none", "" },
        { "trailing.", "" }, { "", "" },
        { ".exr", "exr" },   { "a.abcdefghijklmnopqrst", "abcdefghijklmno" },
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char extension[16];
        file_extension(cases[i][0], extension);
        CHECK_STRING(extension, cases[i][1]);
    }
}
