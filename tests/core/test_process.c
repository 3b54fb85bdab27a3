// Programs that process_output starts.
#include "framework/test.h"

#include "core/files/process.h"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

static struct file_bytes out;
static struct process_end end;

static bool run_shell(const char *script, size_t max_bytes, double timeout_s)
{
    char *arguments[] = { (char *)"sh", (char *)"-c", (char *)(uintptr_t)script, NULL };
    test_host()->failure = FAIL_NONE;
    return process_output(test_host(), "/bin/sh", arguments, -1, max_bytes, timeout_s, &out, &end);
}

static void check_output(const char *expected)
{
    assert_int_equal(out.size, strlen(expected));
    assert_memory_equal(out.data, expected, out.size);
    file_bytes_finish(test_host(), &out);
}

TEST(output_and_status_of_a_program_are_returned)
{
    CHECK(run_shell("printf abc; echo unseen >&2; exit 3", 100, 60));
    check_output("abc");
    CHECK(end.status == 3 && end.signal == 0 && !end.timed_out);
    CHECK(run_shell("kill -SEGV $$", 100, 60));
    check_output("");
    CHECK(end.signal == SIGSEGV);
}

TEST(a_program_reads_nothing_and_ends_where_output_is_no_longer_read)
{
    CHECK(run_shell("cat; echo done", 100, 60));
    check_output("done\n");
    CHECK(!run_shell("while :; do echo more; done", 100000, 60));
    CHECK(test_host()->failure == FAIL_MEMORY && !out.data);
    CHECK(run_shell("printf %100000s x", 100000, 60)); // no more than allowed
    CHECK(out.size == 100000);
    file_bytes_finish(test_host(), &out);
}

TEST(a_program_that_does_not_end_is_ended)
{
    CHECK(run_shell("exec sleep 1000", 100, 0.2));
    check_output("");
    CHECK(end.timed_out && end.signal == SIGKILL);
    CHECK(waitpid(-1, NULL, WNOHANG) < 0 && errno == ECHILD); // none is left
}

TEST(a_missing_program_is_a_failure)
{
    char *arguments[] = { (char *)"nothing", NULL };
    CHECK(!process_output(test_host(), test_path("nothing"), arguments, -1, 100, 60, &out, &end));
    CHECK(test_host()->failure == FAIL_UNSUPPORTED);
    CHECK(strstr(test_last_message(), "cannot start"));
}

// A host program may ignore SIGCHLD: its children leave no status.
TEST(output_is_complete_in_a_program_that_ignores_its_children)
{
    void (*before)(int) = signal(SIGCHLD, SIG_IGN);
    bool ok = run_shell("printf abc; exit 3", 100, 60);
    CHECK(ok);
    check_output("abc");
    CHECK(run_shell("exec sleep 1000", 100, 0.2) && end.timed_out);
    check_output("");
    signal(SIGCHLD, before);
}

TEST(signals_of_the_host_are_not_inherited)
{
    sigset_t all, before;
    sigfillset(&all);
    void (*pipes)(int) = signal(SIGPIPE, SIG_IGN);
    pthread_sigmask(SIG_BLOCK, &all, &before);
    bool ok = run_shell("kill -PIPE $$; echo alive", 1000, 60);
    pthread_sigmask(SIG_SETMASK, &before, NULL);
    signal(SIGPIPE, pipes);
    CHECK(ok);
    check_output("");
    CHECK(end.signal == SIGPIPE);
}

TEST(open_files_of_the_host_are_not_inherited)
{
    int high = fcntl(STDOUT_FILENO, F_DUPFD, 50); // not closed by exec
    CHECK(high >= 50);
    bool ok = run_shell("ls /proc/self/fd | tail -1", 1000, 60);
    close(high);
    CHECK(ok);
    CHECK(out.size == 2 && out.data[0] >= '0' && out.data[0] <= '9'); // ls has opened the folder
    file_bytes_finish(test_host(), &out);
}

TEST(the_environment_of_the_host_is_not_inherited)
{
    setenv("AFTERGLOW_TEST_SECRET", "secret", 1);
    CHECK(run_shell("printf %s \"${AFTERGLOW_TEST_SECRET-none}${HOME-none}\"", 1000, 60));
    unsetenv("AFTERGLOW_TEST_SECRET");
    check_output("nonenone");
}

TEST(a_host_without_standard_streams_gets_output_too)
{
    int saved[3];
    for (int fd = 0; fd < 3; fd++) saved[fd] = fcntl(fd, F_DUPFD_CLOEXEC, 60);
    for (int fd = 0; fd < 3; fd++) close(fd);
    bool ok = run_shell("printf abc; cat", 100, 60);
    for (int fd = 0; fd < 3; fd++) {
        dup2(saved[fd], fd);
        close(saved[fd]);
    }
    CHECK(ok);
    check_output("abc");
}
