// Writes JSON.
#include "json.h"
#include "whole_file.h"

#include "core/text.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const size_t JSON_FLAGS = JSON_INDENT(2) | JSON_PRESERVE_ORDER | JSON_REAL_PRECISION(12);

json_t *json_double(double value)
{
    return isfinite(value) ? json_real(value) : json_null();
}

json_t *json_float(float value)
{
    char text[64];
    if (!isfinite(value)) return json_null();
    for (int digits = 6; digits <= 9; digits++) {
        snprintf(text, sizeof text, "%.*g", digits, (double)value);
        if (strtof(text, NULL) == value) break;
    }
    return json_real(strtod(text, NULL));
}

json_t *json_floats(const float *values, int count)
{
    json_t *array = json_array();
    for (int i = 0; array && i < count; i++) json_array_append_new(array, json_float(values[i]));
    return array;
}

json_t *json_text(const char *text)
{
    static const char REPLACEMENT[] = "\xef\xbf\xbd";
    char *clean = malloc(3 * strlen(text) + 1);
    if (!clean) return NULL;
    size_t used = 0;
    while (*text) {
        size_t length = text_utf8_length(text);
        memcpy(clean + used, length ? text : REPLACEMENT, length ? length : 3);
        used += length ? length : 3;
        text += length ? length : 1;
    }
    json_t *string = json_stringn(clean, used);
    free(clean);
    return string;
}

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
