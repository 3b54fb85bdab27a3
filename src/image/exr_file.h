// One open OpenEXR file, for exr_read.c and exr_write.c: the library's context, its callbacks, and
// its errors as log messages.
#pragma once

#include "image/exr.h"

#include "core/files/file.h"

#include <openexr.h>

enum {
    EXR_CHANNELS_MAX = 1024, // in a file
    EXR_NAME_MAX = 200,      // of a layer; the format allows 255 for a channel
};

// One open file; also the user data of the library's callbacks.
struct exr_file {
    struct host *host;
    const char *path;
    exr_context_t context;
    struct file_bytes bytes;   // reading, or written to memory
    size_t capacity;           // of bytes, writing
    struct file_writer writer; // writing
    char message[256];         // the first error that the library reported
};

// Callbacks and size limits shared by reading and writing.
exr_context_initializer_t exr_initializer(struct exr_file *file);
// Closes the library's context. The writer is left to file_commit or file_abort.
void exr_file_finish(struct exr_file *file);
// Log the library's message, or the meaning of the code where there is none; return false.
bool exr_fail_reading(struct exr_file *file, exr_result_t code);
bool exr_fail_writing(struct exr_file *file, exr_result_t code);
// Whether the layer is stored in the channels without a prefix.
bool exr_is_plain(const char *layer);
