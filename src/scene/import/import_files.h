// Files that an imported one refers to, each read once however often it is named. Internal to
// src/scene/import.
#pragma once

#include "scene/import/import_context.h"

struct import_file {
    char *path; // NULL: a free slot
    struct file_bytes bytes;
    bool missing; // there is no such file, or it may not be read
};

struct import_files {
    struct import *import;
    struct import_file *slots; // an open hash table by path
    size_t size;               // a power of two
};

// For at most `count` paths. import_files_finish accepts a zeroed one, and frees all bytes.
bool import_files_init(struct import_files *files, struct import *import, size_t count);
void import_files_finish(struct import_files *files);
// The file of a path that import_resolve gave, which is taken over; its size counts as source
// bytes. NULL after a failure to read it.
const struct import_file *import_files_read(struct import_files *files, char *path);
