// An allocator for ag_context_desc.reallocate that counts, and refuses when it is told to.
#pragma once

#include <stdbool.h>
#include <stdlib.h>

struct purse {
    long blocks;     // alive
    long asked;      // allocations so far
    long refuse_at;  // the allocation that fails; 0: none
    bool refuse_all; // from refuse_at on
};

static inline void *purse_reallocate(void *user, void *old, size_t bytes)
{
    struct purse *purse = user;
    if (bytes == 0) {
        if (old) purse->blocks--;
        free(old);
        return NULL;
    }
    purse->asked++;
    bool refused = purse->refuse_at && (purse->refuse_all ? purse->asked >= purse->refuse_at
                                                          : purse->asked == purse->refuse_at);
    if (refused) return NULL;
    void *block = realloc(old, bytes);
    if (block && !old) purse->blocks++;
    return block;
}
