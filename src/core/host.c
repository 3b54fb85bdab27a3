// Memory, log messages and the last failure, through the callbacks of the host program.
#include "core/host.h"

#include "core/text.h"

#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#ifdef __linux__
#include <sys/mman.h>
#endif

enum { MESSAGE_SIZE = 1024 }; // longer messages are truncated

struct host host_default(void)
{
    return (struct host){ .log_up_to = LOG_INFO };
}

__attribute__((format(printf, 3, 0))) static void log_va(struct host *host, enum log_level level,
                                                         const char *format, va_list arguments)
{
    if (!host->log || level > host->log_up_to) return;
    char message[MESSAGE_SIZE], printable[MESSAGE_SIZE];
    if (vsnprintf(message, sizeof message, format, arguments) < 0)
        snprintf(message, sizeof message, "%s", format);
    text_escape(message, printable, sizeof printable);
    host->log(host->user, level, printable);
}

bool host_fail(struct host *host, enum fail_kind kind, const char *format, ...)
{
    host->failure = kind;
    va_list arguments;
    va_start(arguments, format);
    log_va(host, LOG_ERROR, format, arguments);
    va_end(arguments);
    return false;
}

void host_log(struct host *host, enum log_level level, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    log_va(host, level, format, arguments);
    va_end(arguments);
}

// Pointer subtraction is undefined in objects above PTRDIFF_MAX, so allocators refuse them.
static bool block_size(struct host *host, size_t count, size_t size, size_t *out)
{
    size_t bytes;
    if (!size_mul(count, size, &bytes) || bytes > PTRDIFF_MAX) {
        host_fail(host, FAIL_MEMORY, "cannot allocate %zu x %zu bytes: too large", count, size);
        return false;
    }
    *out = bytes ? bytes : 1;
    return true;
}

static bool fail_memory(struct host *host, size_t bytes)
{
    return host_fail(host, FAIL_MEMORY, "cannot allocate %zu bytes: out of memory", bytes);
}

// Textures and vertices are accessed at random: with 4 KB pages most accesses miss the TLB.
static void advise_huge_pages(void *block, size_t bytes)
{
#ifdef __linux__
    static const uintptr_t HUGE_PAGE = (uintptr_t)2 << 20;
    uintptr_t from = ((uintptr_t)block + HUGE_PAGE - 1) & ~(HUGE_PAGE - 1);
    uintptr_t to = ((uintptr_t)block + bytes) & ~(HUGE_PAGE - 1);
    if (to > from) (void)madvise((void *)from, to - from, MADV_HUGEPAGE);
#else
    (void)block;
    (void)bytes;
#endif
}

static void *zeroed(size_t bytes)
{
    void *block = calloc(1, bytes);
    if (block) advise_huge_pages(block, bytes);
    return block;
}

void *host_alloc(struct host *host, size_t count, size_t size)
{
    size_t bytes = 0;
    if (!block_size(host, count, size, &bytes)) return NULL;
    void *block = host->reallocate ? host->reallocate(host->user, NULL, bytes) : zeroed(bytes);
    if (block && host->reallocate) memset(block, 0, bytes);
    if (!block) fail_memory(host, bytes);
    return block;
}

void *host_realloc(struct host *host, void *old, size_t count, size_t size)
{
    size_t bytes = 0;
    if (!block_size(host, count, size, &bytes)) return NULL;
    void *block = host->reallocate ? host->reallocate(host->user, old, bytes) : realloc(old, bytes);
    if (!block) fail_memory(host, bytes);
    return block;
}

void host_free(struct host *host, void *pointer)
{
    if (!pointer) return;
    if (host->reallocate)
        host->reallocate(host->user, pointer, 0);
    else
        free(pointer);
}

char *host_strdup(struct host *host, const char *text)
{
    size_t size = strlen(text) + 1;
    char *copy = host_alloc(host, size, 1);
    if (copy) memcpy(copy, text, size);
    return copy;
}

char *host_sprintf(struct host *host, const char *format, ...)
{
    va_list arguments, again;
    va_start(arguments, format);
    va_copy(again, arguments);
    int length = vsnprintf(NULL, 0, format, arguments);
    va_end(arguments);
    char *text = NULL;
    if (length < 0)
        host_fail(host, FAIL_ARGUMENT, "cannot format \"%s\": not representable", format);
    else
        text = host_alloc(host, (size_t)length + 1, 1);
    if (text) vsnprintf(text, (size_t)length + 1, format, again);
    va_end(again);
    return text;
}

bool size_mul(size_t a, size_t b, size_t *out)
{
    if (b != 0 && a > SIZE_MAX / b) return false;
    *out = a * b;
    return true;
}

bool size_add(size_t a, size_t b, size_t *out)
{
    if (a > SIZE_MAX - b) return false;
    *out = a + b;
    return true;
}
