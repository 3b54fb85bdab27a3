// posix_spawn instead of fork: other threads of the host program may hold locks.
#include "core/files/process.h"

#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <string.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

struct spawn_plan {
    posix_spawn_file_actions_t files;
    posix_spawnattr_t attributes;
    bool has_files, has_attributes;
};

static void plan_finish(struct spawn_plan *plan)
{
    if (plan->has_files) posix_spawn_file_actions_destroy(&plan->files);
    if (plan->has_attributes) posix_spawnattr_destroy(&plan->attributes);
}

// The pipe is moved first: it may have the number of a standard stream that the host has closed.
static bool plan_files(struct spawn_plan *plan, int input, int output)
{
    if (posix_spawn_file_actions_init(&plan->files) != 0) return false;
    plan->has_files = true;
    posix_spawn_file_actions_t *files = &plan->files;
    return posix_spawn_file_actions_adddup2(files, output, STDOUT_FILENO) == 0 &&
           (input < 0
                ? posix_spawn_file_actions_addopen(files, STDIN_FILENO, "/dev/null", O_RDONLY, 0)
                : posix_spawn_file_actions_adddup2(files, input, STDIN_FILENO)) == 0 &&
           posix_spawn_file_actions_addopen(files, STDERR_FILENO, "/dev/null", O_WRONLY, 0) == 0 &&
           posix_spawn_file_actions_addclosefrom_np(files, STDERR_FILENO + 1) == 0;
}

// Blocked and ignored signals would be inherited.
static bool plan_signals(struct spawn_plan *plan)
{
    sigset_t none, all;
    if (posix_spawnattr_init(&plan->attributes) != 0) return false;
    plan->has_attributes = true;
    sigemptyset(&none);
    sigfillset(&all);
    return posix_spawnattr_setsigmask(&plan->attributes, &none) == 0 &&
           posix_spawnattr_setsigdefault(&plan->attributes, &all) == 0 &&
           posix_spawnattr_setflags(&plan->attributes,
                                    POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF) == 0;
}

static bool start(struct host *host, const char *program, char *const arguments[], int input,
                  int output, pid_t *pid)
{
    struct spawn_plan plan = { .has_files = false };
    char *no_environment[] = { NULL };
    int error =
        plan_files(&plan, input, output) && plan_signals(&plan)
            ? posix_spawn(pid, program, &plan.files, &plan.attributes, arguments, no_environment)
            : ENOMEM;
    plan_finish(&plan);
    if (error == 0) return true;
    return host_fail(host, FAIL_UNSUPPORTED, "cannot start %s: %s", program, strerror(error));
}

static double now_s(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

// Doubles the buffer, up to max_bytes and one more, which tells that there is more.
static bool grow_buffer(struct host *host, struct file_bytes *out, size_t *capacity,
                        size_t max_bytes)
{
    if (out->size < *capacity) return true;
    size_t grown = *capacity ? 2 * *capacity : (size_t)1 << 16;
    if (grown > max_bytes) grown = max_bytes + 1;
    unsigned char *more = host_realloc(host, out->data, grown, 1);
    if (!more) return false;
    out->data = more;
    *capacity = grown;
    return true;
}

// Reads to the end of the pipe.
static bool collect(struct host *host, const char *program, int fd, size_t max_bytes,
                    double timeout_s, struct file_bytes *out, bool *timed_out)
{
    size_t capacity = 0;
    double deadline = now_s() + timeout_s;
    for (;;) {
        double left = deadline - now_s();
        struct pollfd ready = { .fd = fd, .events = POLLIN };
        int polled = left > 0.0 ? poll(&ready, 1, (int)(left < 1e5 ? 1e3 * left + 1 : 1e8)) : 0;
        if (polled < 0 && errno == EINTR) continue;
        *timed_out = polled == 0;
        if (polled <= 0) return true;
        if (!grow_buffer(host, out, &capacity, max_bytes)) return false;
        ssize_t got = read(fd, out->data + out->size, capacity - out->size);
        if (got < 0 && errno == EINTR) continue;
        if (got <= 0) return true;
        out->size += (size_t)got;
        if (out->size > max_bytes) {
            return host_fail(host, FAIL_MEMORY, "%s writes more than %zu bytes", program,
                             max_bytes);
        }
    }
}

static pid_t wait_for(pid_t pid, int *status, int options)
{
    pid_t ended;
    do ended = waitpid(pid, status, options);
    while (ended < 0 && errno == EINTR);
    return ended;
}

// The number may belong to another process as soon as this one has been reaped: only a child that
// still runs is killed.
static void reap(pid_t pid, bool stop, struct process_end *end)
{
    int status = 0;
    pid_t ended = stop ? wait_for(pid, &status, WNOHANG) : 0;
    if (ended == 0) {
        if (stop) kill(pid, SIGKILL);
        ended = wait_for(pid, &status, 0);
    }
    if (ended != pid) return; // the host program has reaped it
    if (WIFEXITED(status)) end->status = WEXITSTATUS(status);
    if (WIFSIGNALED(status)) end->signal = WTERMSIG(status);
}

bool process_output(struct host *host, const char *program, char *const arguments[], int input,
                    size_t max_bytes, double timeout_s, struct file_bytes *out,
                    struct process_end *end)
{
    int ends[2];
    pid_t pid;
    *out = (struct file_bytes){ 0 };
    *end = (struct process_end){ 0 };
    if (pipe2(ends, O_CLOEXEC) != 0)
        return host_fail(host, FAIL_UNSUPPORTED, "cannot start %s: %s", program, strerror(errno));
    bool started = start(host, program, arguments, input, ends[1], &pid);
    close(ends[1]);
    bool ok =
        started && collect(host, program, ends[0], max_bytes, timeout_s, out, &end->timed_out);
    close(ends[0]);
    if (started) reap(pid, !ok || end->timed_out, end);
    if (!ok) file_bytes_finish(host, out);
    return ok;
}
