/// A context: the log and the memory that the program lends to the library. Everything hangs from
/// one; two can live side by side.
#ifndef AFTERGLOW_CONTEXT_H
#define AFTERGLOW_CONTEXT_H

#include <afterglow/types.h>

AG_BEGIN

struct ag_context;

enum ag_log_level { AG_LOG_ERROR, AG_LOG_WARNING, AG_LOG_INFO, AG_LOG_DEBUG };

struct ag_context_desc {
    /// Called with one sentence without a newline, on the thread of the call. NULL: silent.
    void (*log)(void *user, enum ag_log_level level, const char *message);
    /// realloc-like; 0 bytes frees and returns NULL. NULL: the C library's.
    void *(*reallocate)(void *user, void *old, size_t bytes);
    void *user;
    enum ag_log_level log_up_to; ///< default AG_LOG_WARNING
    bool use_environment; ///< default true: read AFTERGLOW_SHADER_DIR and AFTERGLOW_VALIDATION
};

AG_API void ag_context_desc_default(struct ag_context_desc *desc);
/// desc may be NULL for the defaults. *out is NULL on failure.
AG_API enum ag_result ag_context_create(const struct ag_context_desc *desc,
                                        struct ag_context **out);
AG_API void ag_context_destroy(struct ag_context *context);
/// The newest error's sentence, "" if there was none. Valid until the next call on the context.
AG_API const char *ag_context_last_error(const struct ag_context *context);

AG_END

#endif
