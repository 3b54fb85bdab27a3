// Arena allocator: many small allocations, released together.
#pragma once

#include "core/host.h"

struct arena_block;

struct arena {
    struct host *host;
    struct arena_block *blocks;
    size_t bytes; // handed out so far
};

void arena_init(struct arena *arena, struct host *host);
void arena_finish(struct arena *arena); // accepts a zeroed arena
// Zeroed, aligned to 16 bytes; fails as host_alloc does. The product count × size is checked.
void *arena_alloc(struct arena *arena, size_t count, size_t size);
char *arena_strdup(struct arena *arena, const char *text);
