// Files: whole reads, and writes that are never seen half done (written beside, then renamed).
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

// A file being written: `path` gets the content only at file_commit; file_abort leaves nothing
// behind. Both accept a zeroed writer. Exactly one of them ends it. The temporary file lies in the
// same folder.
struct file_writer {
    struct host *host;
    char *path;
    char *temporary_path;
    FILE *
        stream; // may be NULL where a library writes to temporary_path itself (see file_begin_path)
};

bool file_begin(struct file_writer *writer, struct host *host, const char *path);
// As file_begin, but the stream is closed: a library writes to writer->temporary_path.
bool file_begin_path(struct file_writer *writer, struct host *host, const char *path);
bool file_commit(struct file_writer *writer);
void file_abort(struct file_writer *writer);

// The part of a path after its last dot, without the dot, lower case, at most 15 characters; "" if
// none.
void file_extension(const char *path, char out[16]);
