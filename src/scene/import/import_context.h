// What every importer shares: where it reads, what it may spend, what it left out. Internal to
// src/scene.
#pragma once

#include "core/file.h"
#include "scene/scene.h"

enum { IMPORT_MAX_NOTES = 24, IMPORT_NOTE_SIZE = 96 };

struct import {
    struct host *host;
    struct scene *scene; // being filled
    const char *path;    // as the caller gave it, for messages
    size_t source_bytes; // of the file and of what it refers to, read so far
    size_t spent;        // bytes made from them
    char notes[IMPORT_MAX_NOTES][IMPORT_NOTE_SIZE]; // things left out, each once
    int note_count;
};

// A file may ask for a multiple of its own size, above an allowance for small ones: a few bytes
// that describe gigabytes are an error (FAIL_MEMORY), not a request.
bool import_charge(struct import *import, size_t count, size_t size);
// Zeroed memory from the scene's arena, charged. NULL on failure.
void *import_alloc(struct import *import, size_t count, size_t size);

// Remembers a thing that is left out ("line primitives"); said once in one warning by
// import_log_notes.
void import_note(struct import *import, const char *format, ...)
    __attribute__((format(printf, 2, 3)));
void import_log_notes(struct import *import);

// The path of a file that the imported one refers to: relative to its folder, percent escapes
// decoded, "." and empty segments dropped. Absolute paths, schemes and ".." are refused: a scene
// reads in its own folder and below. Owned by the caller.
char *import_resolve(struct import *import, const char *uri);
// The same without a failure on record, for what a scene can do without.
char *import_resolve_quietly(struct import *import, const char *uri, bool decode_percent);

// Text from a file, cut and made printable for a message.
struct import_text {
    char s[64];
};
struct import_text import_printable(const char *text);

// Copies the text into the scene's arena, made printable; `fallback` and the index where it is NULL
// or empty.
const char *import_name(struct import *import, const char *text, const char *fallback, size_t i);
