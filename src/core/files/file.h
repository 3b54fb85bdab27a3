// Files: reads into memory and atomic writes (temporary file in the same folder, then rename).
// Symbolic links are followed, except in the folder host->no_links_in: there a link is not read,
// and a write replaces the link.
#pragma once

#include "core/host.h"
#include "core/files/temporary.h"

#include <stdint.h>
#include <stdio.h>

struct file_bytes {
    uint8_t *data; // one zero byte follows the last
    size_t size;
};

// Reads a regular file of at most max_bytes (0: 4 GiB). Failure names the path. Free with
// file_bytes_finish.
bool file_read(struct host *host, const char *path, size_t max_bytes, struct file_bytes *out);
// Its first bytes, or all of a shorter one; the file may have any size.
bool file_read_start(struct host *host, const char *path, size_t bytes, struct file_bytes *out);
// A copy of bytes in memory, of at most 4 GiB.
bool file_bytes_copy(struct host *host, const void *data, size_t size, struct file_bytes *out);
void file_bytes_finish(struct host *host, struct file_bytes *bytes);

// A file being written: file_commit replaces `path`, file_abort removes the temporary file. End
// each writer with exactly one of them; both accept a zeroed writer.
struct file_writer {
    struct host *host;
    char *display_path; // as given, for messages
    char *path;         // symbolic links resolved
    struct temporary temporary;
    FILE *stream;
    int why; // errno of the first failed write
};

// Warns of files that interrupted writers of the same path left, and removes them.
bool file_begin(struct file_writer *writer, struct host *host, const char *path);
// Appends to the stream. False: `why` is set, and file_commit will fail.
bool file_write(struct file_writer *writer, const void *data, size_t bytes);
bool file_commit(struct file_writer *writer);
void file_abort(struct file_writer *writer);

// The file extension: lower case, without the dot, at most 15 characters; "" where there is none.
void file_extension(const char *path, char out[16]);
