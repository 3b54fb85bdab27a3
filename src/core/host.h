// What the program around the library lends it: a log, memory, and a place for the last failure.
// Every create function takes a `struct host *`, which must outlive the object. Nothing in the
// library prints, exits or reads the environment; a failure is a `false` or NULL plus one sentence
// here.
#pragma once

#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>

enum log_level { LOG_ERROR, LOG_WARNING, LOG_INFO, LOG_DEBUG };

// Why the last operation failed; the public API turns it into an ag_result.
enum fail_kind {
    FAIL_NONE,
    FAIL_ARGUMENT,    // the caller's value is out of range or unknown
    FAIL_FILE,        // a file cannot be opened, read or written
    FAIL_FORMAT,      // a file's content is wrong
    FAIL_UNSUPPORTED, // right, but this library or device cannot do it
    FAIL_MEMORY,      // out of memory, or more than is allowed
    FAIL_DEVICE,      // the GPU failed
    FAIL_CANCELLED,
};

struct host {
    void (*log)(void *user, enum log_level level, const char *message); // NULL: silent
    void *(*reallocate)(void *user, void *old, size_t bytes);           // NULL: libc; 0 bytes frees
    void *user;
    enum log_level log_up_to; // messages above are not formatted
    enum fail_kind failure;   // kind of the last host_fail
};

// A host with libc memory and no log; also what zero bytes mean, but for log_up_to.
struct host host_default(void);

// Remembers `kind`, logs one sentence ("<what> <where>: <why>", no newline) and returns false,
// so that `return host_fail(host, …)` reads well.
bool host_fail(struct host *host, enum fail_kind kind, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
void host_log(struct host *host, enum log_level level, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

// Zeroed memory for count × size bytes; NULL (with FAIL_MEMORY recorded and logged) when that
// overflows or cannot be had. count or size 0 gives a unique pointer. Free with host_free, which
// accepts NULL.
void *host_alloc(struct host *host, size_t count, size_t size);
// Grows or shrinks; contents are kept, new bytes are not zeroed. NULL leaves the old block as it
// was.
void *host_realloc(struct host *host, void *old, size_t count, size_t size);
void host_free(struct host *host, void *pointer);
char *host_strdup(struct host *host, const char *text);
// A new string, printf style; NULL when out of memory. Owned by the caller.
char *host_sprintf(struct host *host, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

// Checked sizes: false when the result does not fit, *out is then untouched.
bool size_mul(size_t a, size_t b, size_t *out);
bool size_add(size_t a, size_t b, size_t *out);
