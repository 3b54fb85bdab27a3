// The state of an import that all importers share: file, memory budget, ignored features. Internal
// to src/scene/import.
#pragma once

#include "core/files/file.h"
#include "scene/import/import.h"

enum { IMPORT_MAX_NOTES = 24, IMPORT_NOTE_SIZE = 96 };

struct import {
    struct host *host;
    struct scene *scene;               // being filled
    const char *path;                  // as given by the caller
    const struct import_bytes *memory; // where a file in memory has its other files; else NULL
    size_t source_bytes; // size of the file and of the files it refers to, read so far
    size_t spent;        // bytes charged to the budget
    bool converted;      // glTF made by the importer program from another format
    char notes[IMPORT_MAX_NOTES][IMPORT_NOTE_SIZE]; // ignored features, each once
    int note_count;
};

// The most that a file of source_bytes may need: the allowance plus a multiple of its size.
size_t import_limit(const struct import *import, size_t allowance);
// Charges count × size bytes to the memory budget. A small file that describes gigabytes fails
// (FAIL_MEMORY).
bool import_charge(struct import *import, size_t count, size_t size);
// Charges and allocates zeroed memory from the scene's arena. NULL on failure.
void *import_alloc(struct import *import, size_t count, size_t size);

// Reads a file that import_resolve named; its size counts as source bytes. `missing` NULL: there
// must be one; else *missing tells, without a failure. A symbolic link that leads out of the folder
// is a failure, unless host->follow_links.
bool import_read(struct import *import, const char *path, struct file_bytes *out, bool *missing);

// The failure of a file that a symbolic link leads out of the scene's folder. False.
bool import_fail_link(struct import *import, const char *path);

// Notes a feature that is ignored ("line primitives"); import_log_notes lists all in one warning.
void import_note(struct import *import, const char *format, ...)
    __attribute__((format(printf, 2, 3)));
void import_log_notes(struct import *import);

// The path of a file that the imported one refers to: relative to its folder, percent escapes
// decoded, "." and empty segments removed. Absolute paths, schemes and ".." are refused: a scene
// reads only from its own folder and below. Owned by the caller.
char *import_resolve(struct import *import, const char *uri);
// The same without a failure message, for optional files.
char *import_resolve_quietly(struct import *import, const char *uri, bool decode_percent);

// Text from a file for a message: truncated, control characters replaced.
struct import_text {
    char s[64];
};
struct import_text import_printable(const char *text);

// Copies the text into the scene's arena, control characters escaped (core/text.h); "fallback i"
// when it is NULL or empty.
const char *import_name(struct import *import, const char *text, const char *fallback, size_t i);
