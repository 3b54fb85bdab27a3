// The time of reading and of copying bytes once, beside which a pass that is bound by memory
// is judged.
#pragma once

#include <stdbool.h>
#include <stddef.h>

// Threads for which a software driver would share the work: LP_NUM_THREADS, else all processors.
int copy_threads(void);

struct copy_time {
    double read_ms, copy_ms; // least of the runs
};
// Allocates twice as many bytes. False: out of memory.
bool copy_measure(size_t bytes, int threads, int runs, struct copy_time *out);
