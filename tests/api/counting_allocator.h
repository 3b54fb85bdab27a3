// An allocator for ag_context_desc.reallocate that counts blocks and can be made to fail.
#pragma once

#include <stdbool.h>
#include <stdlib.h>

struct counting_allocator {
    long blocks;     // currently allocated
    long asked;      // allocations so far
    long refuse_at;  // the allocation that fails; 0: none
    bool refuse_all; // from refuse_at on
};

static inline void *counting_reallocate(void *user, void *old, size_t bytes)
{
    struct counting_allocator *allocator = user;
    if (bytes == 0) {
        if (old) allocator->blocks--;
        free(old);
        return NULL;
    }
    allocator->asked++;
    bool refused =
        allocator->refuse_at && (allocator->refuse_all ? allocator->asked >= allocator->refuse_at
                                                       : allocator->asked == allocator->refuse_at);
    if (refused) return NULL;
    void *block = realloc(old, bytes);
    if (block && !old) allocator->blocks++;
    return block;
}
