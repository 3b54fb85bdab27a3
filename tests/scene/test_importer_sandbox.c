// System calls in the importer's sandbox, each tried in a process of its own.
#include "framework/test.h"

#include "importer/sandbox.h"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

static int output; // the one that may be written
static char file[512], folder[512];

// The wait status of a process that enters the sandbox and returns from `body` with true.
static int status_of(bool (*body)(void))
{
    int ends[2], status = 0;
    assert_int_equal(pipe(ends), 0);
    const pid_t child = fork();
    assert_true(child >= 0);
    if (child == 0) {
        output = ends[1];
        _exit(sandbox_enter(output) ? 77 : !body());
    }
    assert_true(waitpid(child, &status, 0) == child);
    for (int i = 0; i < 2; i++) close(ends[i]);
    if (WIFEXITED(status) && WEXITSTATUS(status) == 77) test_skip("no seccomp filter");
    return status;
}

static bool refused(int result)
{
    return result == -1 && errno == EPERM;
}

static void make_file(void)
{
    snprintf(folder, sizeof folder, "%s", test_path(""));
    snprintf(file, sizeof file, "%s", test_path("file"));
    FILE *made = fopen(file, "w");
    assert_non_null(made);
    CHECK(fputs("text", made) >= 0 && fclose(made) == 0);
}

static bool read_and_answer(void)
{
    char text[8] = "";
    struct stat info;
    const int fd = open(file, O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    char *real = realpath(folder, NULL); // ends with a slash
    return fd >= 0 && fstat(fd, &info) == 0 && info.st_size == 4 && pread(fd, text, 8, 0) == 4 &&
           close(fd) == 0 && real && strcmp(text, "text") == 0 && write(output, text, 4) == 4;
}

static bool allocate(void)
{
    size_t size = 1 << 10;
    char *block = malloc(size), *other = malloc(1000);
    for (; block && size < (size_t)64 << 20; size *= 2) {
        block = realloc(block, 2 * size);
        if (block) memset(block, 1, 2 * size);
    }
    free(other);
    free(block);
    return block != NULL;
}

TEST(files_are_read_and_the_output_is_written)
{
    make_file();
    assert_int_equal(status_of(read_and_answer), 0);
}

TEST(memory_is_allocated)
{
    assert_int_equal(status_of(allocate), 0);
}

static bool change_files(void)
{
    return refused(open(file, O_WRONLY)) && refused(open(file, O_RDWR)) &&
           refused(open(file, O_RDONLY | O_TRUNC)) &&
           refused(openat(AT_FDCWD, "made", O_RDONLY | O_CREAT, 0600)) &&
           refused(open(folder, O_TMPFILE | O_RDWR, 0600)) && refused(unlink(file)) &&
           refused(rename(file, "other")) && refused(mkdir("made", 0700)) &&
           refused(chmod(file, 0777)) && refused(symlink(file, "made")) &&
           refused(truncate(file, 0));
}

static bool reach_others(void)
{
    return refused((int)write(STDERR_FILENO, "x", 1)) && refused(kill(getppid(), SIGTERM)) &&
           refused(chdir("/")) && refused(pipe((int[2]){ 0 })) && refused(dup2(output, 9));
}

static bool make_code(void)
{
    void *page = mmap(NULL, 4096, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    return page != MAP_FAILED && refused(mprotect(page, 4096, PROT_READ | PROT_EXEC)) &&
           mmap(NULL, 4096, PROT_READ | PROT_EXEC, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0) ==
               MAP_FAILED;
}

TEST(no_file_is_changed)
{
    make_file();
    assert_int_equal(status_of(change_files), 0);
    CHECK(access(file, R_OK) == 0);
}

TEST(nothing_else_is_written_or_signalled)
{
    assert_int_equal(status_of(reach_others), 0);
}

TEST(no_memory_becomes_code)
{
    assert_int_equal(status_of(make_code), 0);
}

// As in a container that allows no filter.
static bool enter_again(void)
{
    return sandbox_enter(output) != NULL && allocate();
}

TEST(a_refused_filter_is_no_failure)
{
    assert_int_equal(status_of(enter_again), 0);
}

static bool begin_process(void)
{
    return fork() >= 0;
}

static bool begin_program(void)
{
    char *words[] = { (char *)"true", NULL }, *none[] = { NULL };
    return execve("/bin/true", words, none) == 0;
}

static bool begin_connection(void)
{
    return socket(AF_UNIX, SOCK_STREAM, 0) >= 0;
}

TEST(a_process_a_program_or_a_connection_ends_it)
{
    bool (*const bodies[])(void) = { begin_process, begin_program, begin_connection };
    for (size_t i = 0; i < sizeof bodies / sizeof *bodies; i++) {
        const int status = status_of(bodies[i]);
        CHECK(WIFSIGNALED(status) && WTERMSIG(status) == SIGSYS);
    }
}
