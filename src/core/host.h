// Callbacks of the host program: log and memory, and the kind of the last failure. Every create
// function takes a `struct host *`, which must outlive the object. The library never prints, exits
// or reads the environment; a failure is `false` or NULL plus one logged sentence.
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
    FAIL_UNSUPPORTED, // valid, but not supported by this library or device
    FAIL_MEMORY,      // out of memory, or over a limit
    FAIL_DEVICE,      // GPU failure
    FAIL_CANCELLED,
};

struct host {
    void (*log)(void *user, enum log_level level, const char *message); // NULL: silent
    void *(*reallocate)(void *user, void *old, size_t bytes);           // NULL: libc; bytes 0: free
    void *user;
    enum log_level log_up_to; // messages above this level are not formatted
    enum fail_kind failure;   // kind of the last host_fail
    const char *no_links_in;  // NULL, or a folder in which core/file.h does not follow links
    bool follow_links;        // files that a scene refers to may be outside its folder
    const char *importer;     // path of the program that reads OBJ, FBX and X; NULL: none
};

// libc memory, no log. A zeroed host is the same but for log_up_to.
struct host host_default(void);

// Stores `kind`, logs one sentence ("<what> <where>: <why>", no newline) and returns false, for
// `return host_fail(host, …)`. Control characters, of names, are escaped (core/text.h).
bool host_fail(struct host *host, enum fail_kind kind, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
void host_log(struct host *host, enum log_level level, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

// Zeroed memory for count × size bytes; NULL (FAIL_MEMORY, logged) on overflow or out of memory. A
// count or size of 0 gives a unique pointer. Free with host_free, which accepts NULL.
void *host_alloc(struct host *host, size_t count, size_t size);
// Keeps the contents; new bytes are not zeroed. On failure returns NULL and keeps the old block.
void *host_realloc(struct host *host, void *old, size_t count, size_t size);
void host_free(struct host *host, void *pointer);
char *host_strdup(struct host *host, const char *text);
// A new string, printf style; NULL when out of memory. Owned by the caller.
char *host_sprintf(struct host *host, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

// Checked arithmetic: false on overflow, with *out unchanged.
bool size_mul(size_t a, size_t b, size_t *out);
bool size_add(size_t a, size_t b, size_t *out);
