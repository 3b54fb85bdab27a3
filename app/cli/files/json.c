// Writes JSON.
#include "json.h"
#include "whole_file.h"

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

// Length of the UTF-8 character at `s`, 0 if invalid (Unicode 15, table 3-7).
static size_t utf8_length(const unsigned char *s)
{
    if (s[0] < 0x80) return 1;
    size_t length = s[0] < 0xc2 ? 0 : s[0] < 0xe0 ? 2 : s[0] < 0xf0 ? 3 : s[0] < 0xf5 ? 4 : 0;
    for (size_t i = 1; i < length; i++)
        if ((s[i] & 0xc0) != 0x80) return 0;
    bool wrong = (s[0] == 0xe0 && s[1] < 0xa0) || (s[0] == 0xed && s[1] > 0x9f) ||
                 (s[0] == 0xf0 && s[1] < 0x90) || (s[0] == 0xf4 && s[1] > 0x8f);
    return wrong ? 0 : length;
}

json_t *json_text(const char *text)
{
    static const char REPLACEMENT[] = "\xef\xbf\xbd";
    char *clean = malloc(3 * strlen(text) + 1);
    if (!clean) return NULL;
    size_t used = 0;
    while (*text) {
        size_t length = utf8_length((const unsigned char *)text);
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
        length = utf8_length((const unsigned char *)text + i);
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
