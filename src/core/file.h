// Files: whole-file reads and atomic writes (temporary file in the same folder, then rename).
#pragma once

#include "core/host.h"

#include <stdint.h>
#include <stdio.h>

struct file_bytes {
    uint8_t *data; // one zero byte follows the last
    size_t size;
};

// Reads a regular file of at most max_bytes (0: 4 GiB). Failure names the path. Free with
// file_bytes_finish.
bool file_read(struct host *host, const char *path, size_t max_bytes, struct file_bytes *out);
void file_bytes_finish(struct host *host, struct file_bytes *bytes);

// A file being written: file_commit replaces `path`, file_abort removes the temporary file. End
// each writer with exactly one of them; both accept a zeroed writer.
struct file_writer {
    struct host *host;
    char *path;
    char *temporary_path;
    FILE *stream;
};

bool file_begin(struct file_writer *writer, struct host *host, const char *path);
bool file_commit(struct file_writer *writer);
void file_abort(struct file_writer *writer);

// The file extension: lower case, without the dot, at most 15 characters; "" where there is none.
void file_extension(const char *path, char out[16]);
