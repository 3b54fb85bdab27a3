/// Results, versions and the rules that hold for every call.
///
/// Ownership: an object is destroyed by the function that carries its name, before the object it
/// was made from; every destroy function accepts NULL. Descriptions are structs that a function
/// ag_…_desc_default() fills; they need only live until the call returns. Strings are UTF-8 and
/// copied. Threads: one thread at a time per context.
#ifndef AFTERGLOW_TYPES_H
#define AFTERGLOW_TYPES_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
#define AG_BEGIN extern "C" {
#define AG_END   }
#else
#define AG_BEGIN
#define AG_END
#endif

#if defined(AG_BUILD)
#define AG_API __attribute__((visibility("default")))
#else
#define AG_API
#endif

#define AG_VERSION_MAJOR 0
#define AG_VERSION_MINOR 1
#define AG_VERSION_PATCH 0

AG_BEGIN

/// Outcome of a call. Details are one sentence in the context's log and in ag_context_last_error().
enum ag_result {
    AG_OK = 0,
    AG_ERROR_ARGUMENT,    ///< a value is out of range, unknown or NULL
    AG_ERROR_FILE,        ///< a file cannot be opened, read or written
    AG_ERROR_FORMAT,      ///< a file's content is wrong
    AG_ERROR_UNSUPPORTED, ///< right, but this build or device cannot do it
    AG_ERROR_MEMORY,      ///< out of memory, or more than is allowed
    AG_ERROR_DEVICE,      ///< no usable GPU, or it was lost
    AG_ERROR_CANCELLED,   ///< a callback asked to stop
};

/// A few words for a result; never NULL.
AG_API const char *ag_result_string(enum ag_result result);
/// Version of the library that runs, as major·10000 + minor·100 + patch.
AG_API int ag_version(void);

AG_END

#endif
