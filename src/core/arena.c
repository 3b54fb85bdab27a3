// Bump allocation from a list of blocks. Memory is never reused before arena_finish, so a block
// that host_alloc zeroed needs no clearing.
#include "core/arena.h"

#include <stdint.h>
#include <string.h>

// Under the address sanitizer each allocation is a block of its own, and the bytes behind it are
// poisoned: a write beyond it is then reported.
#ifdef __has_feature
#if __has_feature(address_sanitizer)
#define __SANITIZE_ADDRESS__ 1
#endif
#endif
#ifdef __SANITIZE_ADDRESS__
#include <sanitizer/asan_interface.h>
enum { ARENA_ISOLATES = 1 };
#else
#define ASAN_POISON_MEMORY_REGION(at, size)   ((void)(at), (void)(size))
#define ASAN_UNPOISON_MEMORY_REGION(at, size) ((void)(at), (void)(size))
enum { ARENA_ISOLATES = 0 };
#endif

enum { ARENA_ALIGNMENT = 16, ARENA_BLOCK_BYTES = 64 * 1024 };

struct arena_block {
    struct arena_block *next;
    size_t used, capacity; // bytes of data
    unsigned char data[];
};

void arena_init(struct arena *arena, struct host *host)
{
    *arena = (struct arena){ .host = host };
}

void arena_finish(struct arena *arena)
{
    for (struct arena_block *block = arena->blocks, *next; block; block = next) {
        next = block->next;
        ASAN_UNPOISON_MEMORY_REGION(block->data, block->capacity);
        host_free(arena->host, block);
    }
    *arena = (struct arena){ .host = arena->host };
}

// Aligns the address, not the offset: the host's allocator may align to less than 16 bytes.
static void *block_alloc(struct arena_block *block, size_t bytes)
{
    if (!block) return NULL;
    uintptr_t at = (uintptr_t)(block->data + block->used);
    size_t padding = (size_t)(-at & (ARENA_ALIGNMENT - 1));
    size_t available = block->capacity - block->used;
    if (padding > available || bytes > available - padding) return NULL;
    void *memory = block->data + block->used + padding;
    block->used += padding + bytes;
    return memory;
}

static struct arena_block *block_create(struct host *host, size_t capacity)
{
    size_t bytes = 0;
    if (!size_add(capacity, sizeof(struct arena_block), &bytes))
        bytes = SIZE_MAX; // host_alloc fails
    struct arena_block *block = host_alloc(host, bytes, 1);
    if (block) block->capacity = capacity;
    return block;
}

static void isolate(struct arena_block *block)
{
    ASAN_POISON_MEMORY_REGION(block->data + block->used, block->capacity - block->used);
}

void *arena_alloc(struct arena *arena, size_t count, size_t size)
{
    size_t bytes = 0, padded = 0;
    if (!size_mul(count, size, &bytes) || !size_add(bytes, ARENA_ALIGNMENT, &padded)) {
        host_fail(arena->host, FAIL_MEMORY, "cannot allocate %zu x %zu bytes: too large", count,
                  size);
        return NULL;
    }
    if (bytes == 0) bytes = 1;
    void *memory = ARENA_ISOLATES ? NULL : block_alloc(arena->blocks, bytes);
    if (!memory) {
        bool large = ARENA_ISOLATES || padded > ARENA_BLOCK_BYTES / 4;
        struct arena_block *block =
            block_create(arena->host, large ? padded : (size_t)ARENA_BLOCK_BYTES);
        if (!block) return NULL;
        // A large request gets a block of its own behind the current one, which stays in use.
        struct arena_block **link = large && arena->blocks ? &arena->blocks->next : &arena->blocks;
        block->next = *link;
        *link = block;
        memory = block_alloc(block, bytes);
        if (ARENA_ISOLATES) isolate(block);
    }
    arena->bytes += bytes;
    return memory;
}

char *arena_strdup(struct arena *arena, const char *text)
{
    size_t size = strlen(text) + 1;
    char *copy = arena_alloc(arena, size, 1);
    if (copy) memcpy(copy, text, size);
    return copy;
}
