/// Contexts. A context holds the log callback and the allocator of a program. Every other object
/// belongs to one context; several contexts are independent.
#ifndef AFTERGLOW_CONTEXT_H
#define AFTERGLOW_CONTEXT_H

#include <afterglow/types.h>

AG_BEGIN

struct ag_context;

enum ag_log_level { AG_LOG_ERROR, AG_LOG_WARNING, AG_LOG_INFO, AG_LOG_DEBUG };

struct ag_context_desc {
    /// Gets one sentence without a newline, on the calling thread. NULL: no log.
    void (*log)(void *user, enum ag_log_level level, const char *message);
    /// Like realloc; 0 bytes frees and returns NULL. Bakes that run call it on threads of their own
    /// too, one at a time. NULL: the C library's.
    void *(*reallocate)(void *user, void *old, size_t bytes);
    void *user;                  ///< passed to both callbacks
    enum ag_log_level log_up_to; ///< least important level to log; default AG_LOG_WARNING
    /// A folder in which files are opened without following symbolic links, and links are replaced
    /// by what is written; for a cache that others can write to. NULL: none.
    const char *no_links_in;
    /// Default true: read AFTERGLOW_SHADER_DIR, AFTERGLOW_VALIDATION and AFTERGLOW_IMPORTER.
    bool use_environment;
    /// Path of the program afterglow-import, which reads OBJ, FBX and X files in a process of its
    /// own. NULL: AFTERGLOW_IMPORTER, else the one installed with the library. "": none.
    const char *importer;
    /// Default false: a file that a scene refers to and that a symbolic link leads out of the
    /// folder of the scene is AG_ERROR_FILE. The scene file itself may be a link.
    bool follow_links;
    uint64_t reserved[3]; ///< 0; see ABI in types.h
};

/// Thread: any.
AG_API void ag_context_desc_default(struct ag_context_desc *desc);

/// The symbol of ag_context_create has the minor version in its name, as ag_context_create_0_1, so
/// that headers and a library of different binary interfaces do not link. dlsym takes
/// AG_CONTEXT_CREATE_SYMBOL, a string.
#define AG_JOIN(name, major, minor) name##_##major##_##minor
#define AG_NAME(name, major, minor) AG_JOIN(name, major, minor)
#define AG_VERSIONED(name)          AG_NAME(name, AG_VERSION_MAJOR, AG_VERSION_MINOR)
#define ag_context_create           AG_VERSIONED(ag_context_create)
#define AG_CONTEXT_CREATE_SYMBOL    AG_STRING(ag_context_create)
/// desc NULL: the defaults. *out is NULL on failure. Thread: any.
AG_API enum ag_result ag_context_create(const struct ag_context_desc *desc,
                                        struct ag_context **out);
/// The context stays, and its callbacks are called, until all of its objects are destroyed, images
/// and probes too: a program that leaks none knows then that it may unload the callbacks.
/// Thread: the context's.
AG_API void ag_context_destroy(struct ag_context *context);
/// Sentence of the last error, "" if there was none. Valid until the next call with the context.
/// Thread: the context's.
AG_API const char *ag_context_last_error(const struct ag_context *context);

AG_END

#endif
