// A parallel loop. Results must not depend on the number of threads: each call of the body writes
// to its own index only.
#pragma once

#include <stddef.h>

// Calls body(user, i) for i in 0…count-1 on all cores, in any order, and returns when all are done.
// grain: chunk size in indices (at least 1).
void parallel_for(size_t count, size_t grain, void (*body)(void *user, size_t i), void *user);
// The same on at most `threads` threads.
void parallel_for_on(int threads, size_t count, size_t grain, void (*body)(void *user, size_t i),
                     void *user);
// The number of threads of parallel_for.
int parallel_threads(void);
// From now on, loops of the calling thread use at most `threads` threads.
void parallel_limit(int threads);
