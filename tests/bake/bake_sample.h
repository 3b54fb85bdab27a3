// A made-up bake of three waves: rows of a matrix by random numbers, a sum over tasks, and
// decompositions that read both.
#pragma once

#include "bake/bake.h"

#include <stdatomic.h>

struct bake_sample {
    int rows;          // of the matrix
    double task_s;     // least time of a task of the first wave, by polling for cancellation
    double last_s;     // the same of the last wave
    double last_flops; // stated for a task of the last wave
    int failing_task;  // of the first stage; -1: none
    atomic_int runs;   // tasks run, of all stages
    atomic_int prepared, finished;
    bool fail_prepare;
    double prepare_s; // least time of preparing
};

struct bake_sample bake_sample_default(void);
// identity NULL: bake_sample_identity().
struct bake *bake_sample_create(struct bake_sample *sample, const struct bake_identity *identity);
// The same with another host, as other threads need. NULL: it failed.
struct bake *bake_sample_create_for(struct host *host, struct bake_sample *sample,
                                    const struct bake_identity *identity);
struct bake_identity bake_sample_identity(void);
// The bytes of a file. Free with file_bytes_finish.
struct file_bytes bake_sample_bytes(const char *path);
