// A parallel loop. Results must not depend on the number of threads: write to your own index only.
#pragma once

#include <stddef.h>

// Calls body(user, i) for i in 0…count-1 on all cores, in any order, and returns when all are done.
// grain: indices that go to one thread at a time (at least 1).
void parallel_for(size_t count, size_t grain, void (*body)(void *user, size_t i), void *user);
