// Assimp reads whole files by plain calls of libc. EPERM is the answer to calls that this list does
// not have, so that another libc, which tries a newer call first, falls back or reports a failure.
#include "importer/sandbox.h"

#include <errno.h>
#include <fcntl.h>
#include <seccomp.h>
#include <stdbool.h>
#include <string.h>
#include <sys/mman.h>

// By name: which of them exist depends on the architecture. realpath calls readlink, lstat,
// faccessat and getcwd.
static const char *const allowed[] = {
    "read",         "pread64",        "readv",         "lseek",
    "_llseek",      "close",          "dup",           "fstat",
    "fstat64",      "newfstatat",     "fstatat64",     "statx",
    "stat",         "stat64",         "lstat",         "lstat64",
    "readlink",     "readlinkat",     "getcwd",        "brk",
    "munmap",       "mremap",         "madvise",       "futex",
    "futex_time64", "getrandom",      "clock_gettime", "clock_gettime64",
    "gettimeofday", "time",           "sched_yield",   "getpid",
    "gettid",       "rt_sigprocmask", "rt_sigreturn",  "restart_syscall",
    "access",       "faccessat",      "faccessat2",    "sysinfo",
    "exit",         "exit_group",
};

static const char *const deadly[] = {
    "execve", "execveat", "fork", "vfork", "clone", "clone3", "socket", "socketcall", "ptrace",
};

// A call that this architecture, or this version of libseccomp, does not have is no failure.
static bool add(scmp_filter_ctx filter, uint32_t action, const char *name, unsigned count,
                const struct scmp_arg_cmp *arguments)
{
    const int call = seccomp_syscall_resolve_name(name);
    if (call == __NR_SCMP_ERROR) return true;
    const int error = seccomp_rule_add_array(filter, action, call, count, arguments);
    return error == 0 || error == -EDOM || (call < 0 && error == -EINVAL);
}

static bool add_all(scmp_filter_ctx filter, int output)
{
    enum { CHANGES = O_ACCMODE | O_CREAT | O_TRUNC };
    const struct scmp_arg_cmp to_read = SCMP_A1(SCMP_CMP_MASKED_EQ, CHANGES, O_RDONLY);
    const struct scmp_arg_cmp to_read_at = SCMP_A2(SCMP_CMP_MASKED_EQ, CHANGES, O_RDONLY);
    const struct scmp_arg_cmp no_code = SCMP_A2(SCMP_CMP_MASKED_EQ, PROT_EXEC, 0);
    const struct scmp_arg_cmp to_output = SCMP_A0(SCMP_CMP_EQ, (scmp_datum_t)output);
    bool ok = true;
    for (size_t i = 0; i < sizeof allowed / sizeof *allowed; i++)
        ok = ok && add(filter, SCMP_ACT_ALLOW, allowed[i], 0, NULL);
    for (size_t i = 0; i < sizeof deadly / sizeof *deadly; i++)
        ok = ok && add(filter, SCMP_ACT_KILL_PROCESS, deadly[i], 0, NULL);
    return ok && add(filter, SCMP_ACT_ALLOW, "open", 1, &to_read) &&
           add(filter, SCMP_ACT_ALLOW, "openat", 1, &to_read_at) &&
           add(filter, SCMP_ACT_ALLOW, "mmap", 1, &no_code) &&
           add(filter, SCMP_ACT_ALLOW, "mmap2", 1, &no_code) &&
           add(filter, SCMP_ACT_ALLOW, "mprotect", 1, &no_code) &&
           add(filter, SCMP_ACT_ALLOW, "write", 1, &to_output);
}

const char *sandbox_enter(int output)
{
    const char *why = NULL;
    scmp_filter_ctx filter = seccomp_init(SCMP_ACT_ERRNO(EPERM));
    if (!filter || !add_all(filter, output)) {
        why = "the filter cannot be made";
    } else {
        const int error = seccomp_load(filter);
        if (error) why = strerror(-error);
    }
    seccomp_release(filter);
    return why;
}
