// Writes JSON.
#include "json.h"
#include "whole_file.h"

#include "core/text.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const size_t JSON_FLAGS = JSON_INDENT(2) | JSON_PRESERVE_ORDER | JSON_REAL_PRECISION(12);
static const size_t COMPACT = JSON_COMPACT | JSON_PRESERVE_ORDER | JSON_REAL_PRECISION(9);

// jansson escapes C0 controls; C1 and bidirectional ones are escaped here. They occur in strings
// only, where JSON allows it. Chunks end between characters.
static int write_escaped(const char *text, size_t size, void *user)
{
    FILE *file = user;
    for (size_t i = 0, length; i < size; i += length) {
        char character[5] = { 0 }, shown[16];
        length = text_utf8_length(text + i);
        if (length == 0 || length > size - i) length = 1;
        memcpy(character, text + i, length);
        const bool plain = (unsigned char)text[i] < 0x7f;
        if (!plain) ag_printable(character, shown, sizeof shown);
        fputs(plain ? character : shown, file);
    }
    return ferror(file) ? -1 : 0;
}

static bool dump(const json_t *document, size_t flags, FILE *file)
{
    return json_dump_callback(document, write_escaped, file, flags) == 0 &&
           fputc('\n', file) != EOF;
}

enum status json_print(json_t *document)
{
    if (!document) return fail("cannot write JSON on standard output: out of memory");
    bool ok = dump(document, JSON_FLAGS, stdout);
    json_decref(document);
    return ok ? DONE : fail("cannot write standard output: %s", strerror(errno));
}

struct document {
    const json_t *json;
    size_t flags;
};

static enum status write_document(FILE *file, const void *what)
{
    const struct document *document = what;
    if (!dump(document->json, document->flags, file) && !ferror(file))
        return fail("cannot write JSON: out of memory");
    return DONE;
}

static enum status write_with(const json_t *json, size_t flags, const char *path)
{
    const struct document document = { json, flags };
    if (!json) return fail("cannot write %s: out of memory", path);
    return whole_file_write(path, write_document, &document);
}

enum status json_write(const json_t *document, const char *path)
{
    return write_with(document, JSON_FLAGS, path);
}

enum status json_write_compact(const json_t *document, const char *path)
{
    return write_with(document, COMPACT, path);
}
