// Runs another program and collects its output. POSIX only.
#pragma once

#include "core/files/file.h"

// How a program ended; 0 0 also where the host program reaps its children itself, by ignoring
// SIGCHLD or by waiting for all: a caller tells from the output whether it is complete.
struct process_end {
    int status, signal;
    bool timed_out;
};

// Starts `program` with arguments (the first is its name, NULL ends them), the descriptor `input`
// as standard input (-1: /dev/null; not 0 to 2), standard error /dev/null, default signals, no
// environment and no other file of this process; waits for its end. False when it cannot be started
// (FAIL_UNSUPPORTED), writes more than max_bytes or memory ends (FAIL_MEMORY); it is then ended.
// Output is owned by the caller, see file_bytes_finish. Thread-safe: nothing of the calling process
// is changed, no signal handler and no signal mask.
bool process_output(struct host *host, const char *program, char *const arguments[], int input,
                    size_t max_bytes, double timeout_s, struct file_bytes *out,
                    struct process_end *end);
