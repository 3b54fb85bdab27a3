// Writes JSON.
#include "json.h"
#include "whole_file.h"

#include "core/text.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const size_t JSON_FLAGS = JSON_INDENT(2) | JSON_PRESERVE_ORDER | JSON_REAL_PRECISION(12);

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

static bool dump(const json_t *document, FILE *file)
{
    return json_dump_callback(document, write_escaped, file, JSON_FLAGS) == 0 &&
           fputc('\n', file) != EOF;
}

enum status json_print(json_t *document)
{
    if (!document) return fail("cannot write JSON on standard output: out of memory");
    bool ok = dump(document, stdout);
    json_decref(document);
    return ok ? DONE : fail("cannot write standard output: %s", strerror(errno));
}

static enum status write_document(FILE *file, const void *what)
{
    const json_t *document = what;
    if (!dump(document, file) && !ferror(file)) return fail("cannot write JSON: out of memory");
    return DONE;
}

enum status json_write(const json_t *document, const char *path)
{
    if (!document) return fail("cannot write %s: out of memory", path);
    return whole_file_write(path, write_document, document);
}
