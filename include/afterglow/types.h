/// Results, versions and rules for all functions.
///
/// Ownership: ag_X_destroy gives back what ag_X_create or another function returned in `out`; the
/// program does not use it afterwards. All destroy functions accept NULL, and objects are destroyed
/// in any order: one that others use stays, with its memory, until the last of them is destroyed. A
/// renderer uses a device and a scene, a view its renderer, a preparation a device, a bake,
/// reference or light map a scene, and each of them and devices, scenes, environments, images and
/// probes their context. Descriptions: ag_X_desc_default fills a struct ag_X_desc with the
/// defaults. It and all pointers in it are needed only during the call. Strings: UTF-8; arguments
/// are copied. ABI: structs with `reserved` keep their size; new members take its place, and 0 is
/// what they were without. A description whose reserved words are not 0 is refused: the program
/// needs a newer library. ag_X_desc_default sets them. A program links only with a library of the
/// same minor version (ag_context_create). Errors: on failure *out is NULL, and
/// ag_context_last_error() has one sentence.
///
/// Threads: the comment of each function ends with the threads that may call it.
///
/// - "Thread: the context's": one thread at a time uses a context and all of its objects, from the
///   beginning of a call to its end. Another thread may follow, after a mutex or a join. Different
///   contexts are independent.
/// - "Thread: any": at any time, on several threads at once. These functions use no context.
///
/// A scene can be transferred from the context of a loading thread to that of a renderer
/// (ag_scene_transfer). Callbacks run on the calling thread, unless their comment differs.
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

/// Marks functions that the next minor version is without.
#if defined(AG_BUILD)
#define AG_DEPRECATED
#else
#define AG_DEPRECATED __attribute__((deprecated))
#endif

#if defined(AG_BUILD)
#define AG_API __attribute__((visibility("default")))
#else
#define AG_API
#endif

/// Version of the headers. Within 0.x a minor version may change the binary interface; a patch only
/// adds to it.
#define AG_VERSION_MAJOR 0
#define AG_VERSION_MINOR 1
#define AG_VERSION_PATCH 0
/// As a number, in the form of ag_version().
#define AG_VERSION         (AG_VERSION_MAJOR * 10000 + AG_VERSION_MINOR * 100 + AG_VERSION_PATCH)
#define AG_STRING_OF(text) #text
#define AG_STRING(text)    AG_STRING_OF(text)
#define AG_VERSION_STRING                                                                          \
    AG_STRING(AG_VERSION_MAJOR) "." AG_STRING(AG_VERSION_MINOR) "." AG_STRING(AG_VERSION_PATCH)

AG_BEGIN

/// Result of a call.
enum ag_result {
    AG_OK = 0,
    AG_ERROR_ARGUMENT,    ///< a value is out of range, unknown or NULL
    AG_ERROR_FILE,        ///< a file cannot be opened, read or written
    AG_ERROR_FORMAT,      ///< a file's content is wrong
    AG_ERROR_UNSUPPORTED, ///< valid, but not supported by this build or device
    AG_ERROR_MEMORY,      ///< out of memory, or over a limit
    AG_ERROR_DEVICE,      ///< no usable GPU, or the device was lost
    AG_ERROR_CANCELLED,   ///< a callback returned false
};

/// A short static description; never NULL. Thread: any.
AG_API const char *ag_result_string(enum ag_result result);
/// Version of the linked library: major·10000 + minor·100 + patch. Thread: any.
AG_API int ag_version(void);
/// Copies `text` to `out` of `size` bytes, truncated between characters, so that it can be shown:
/// control characters, also C1 and bidirectional ones, become \uXXXX, bytes that are not UTF-8
/// \xXX. Log messages and names of scenes are escaped already; paths are not. Returns the length.
/// Thread: any.
AG_API size_t ag_printable(const char *text, char *out, size_t size);

AG_END

#endif
