// Parallel loops over OpenMP's threads.
#include "core/parallel.h"

#include <limits.h>

void parallel_for(size_t count, size_t grain, void (*body)(void *user, size_t i), void *user)
{
    int chunk = grain < 1 ? 1 : grain > INT_MAX ? INT_MAX : (int)grain;
    // Nothing is gained by waking the other threads for one chunk.
#pragma omp parallel for schedule(dynamic, chunk) if (count > (size_t)chunk)
    for (size_t i = 0; i < count; i++) body(user, i);
}
