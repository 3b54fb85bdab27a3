// One open OpenEXR file, for exr_read.c and exr_write.c: the library's context, the callbacks that
// tie it to the host, and its errors as sentences.
#pragma once

#include "image/exr.h"

#include "core/file.h"

#include <openexr.h>

enum {
    EXR_CHANNELS_MAX = 1024, // in a file
    EXR_NAME_MAX = 200,      // of a layer; the format allows 255 for a channel
};

// One open file and what the library's callbacks need.
struct exr_file {
    struct host *host;
    const char *path;
    exr_context_t context;
    struct file_bytes bytes;   // reading
    struct file_writer writer; // writing
    char message[256];         // the first error that the library reported
};

// Gives the callbacks and bounds that reading and writing share.
exr_context_initializer_t exr_initializer(struct exr_file *file);
// Closes what is open; a file that was being written is left to file_commit or file_abort.
void exr_file_finish(struct exr_file *file);
// Both return false, with what the library said or, where it said nothing, what the code means.
bool exr_fail_reading(struct exr_file *file, exr_result_t code);
bool exr_fail_writing(struct exr_file *file, exr_result_t code);
// Text from a file or a caller, fit for one line of a log.
void exr_copy_printable(char *out, size_t size, const char *text);
// Whether the layer stands in the plain channels, which have no prefix.
bool exr_is_plain(const char *layer);
