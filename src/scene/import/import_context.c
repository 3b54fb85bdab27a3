// Memory budget, names, notes and paths of an import.
#include "scene/import/import_context.h"

#include "core/text.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

static const size_t ALLOWANCE_BYTES = (size_t)256 << 20; // budget of an empty file
// An 8-bit index becomes a flat-shaded vertex with tangent.
static const size_t BYTES_PER_SOURCE_BYTE = 64;

size_t import_limit(const struct import *import, size_t allowance)
{
    size_t limit;
    if (!size_mul(import->source_bytes, BYTES_PER_SOURCE_BYTE, &limit) ||
        !size_add(limit, allowance, &limit)) {
        limit = SIZE_MAX;
    }
    return limit;
}

bool import_charge(struct import *import, size_t count, size_t size)
{
    size_t bytes, limit = import_limit(import, ALLOWANCE_BYTES);
    if (!size_mul(count, size, &bytes) || bytes > limit - import->spent) {
        return host_fail(import->host, FAIL_MEMORY,
                         "%s: needs more memory than its %zu bytes justify", import->path,
                         import->source_bytes);
    }
    import->spent += bytes;
    return true;
}

void *import_alloc(struct import *import, size_t count, size_t size)
{
    if (!import_charge(import, count, size)) return NULL;
    return arena_alloc(&import->scene->arena, count, size);
}

struct import_text import_printable(const char *text)
{
    struct import_text out;
    text_escape(text, out.s, sizeof out.s);
    return out;
}

const char *import_name(struct import *import, const char *text, const char *fallback, size_t i)
{
    char made[64];
    snprintf(made, sizeof made, "%s %zu", fallback, i);
    if (!text || !text[0]) text = made;
    const size_t size = text_escape(text, NULL, 0) + 1;
    char *name = import_alloc(import, size, 1);
    if (name) text_escape(text, name, size);
    return name;
}

void import_note(struct import *import, const char *format, ...)
{
    char note[IMPORT_NOTE_SIZE];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(note, sizeof note, format, arguments);
    va_end(arguments);
    for (int i = 0; i < import->note_count; i++) {
        if (strcmp(import->notes[i], note) == 0) return;
    }
    if (import->note_count == IMPORT_MAX_NOTES) return;
    if (import->note_count == IMPORT_MAX_NOTES - 1) snprintf(note, sizeof note, "and more");
    memcpy(import->notes[import->note_count++], note, sizeof note);
}

void import_log_notes(struct import *import)
{
    if (import->note_count == 0) return;
    char list[IMPORT_MAX_NOTES * (IMPORT_NOTE_SIZE + 2)] = "";
    size_t length = 0;
    for (int i = 0; i < import->note_count; i++) {
        int n =
            snprintf(list + length, sizeof list - length, "%s%s", i ? ", " : "", import->notes[i]);
        length += (size_t)n;
    }
    host_log(import->host, LOG_WARNING, "%s: ignored: %s", import->path, list);
}

static int hex_digit(char c)
{
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    if (c >= 'A' && c <= 'F') return c - 'A' + 10;
    return -1;
}

// In place. False for an incomplete escape or an escaped zero byte.
static bool percent_decode(char *text)
{
    char *to = text;
    for (const char *from = text; *from; from++) {
        if (*from != '%') {
            *to++ = *from;
            continue;
        }
        int high = hex_digit(from[1]);
        int low = high < 0 ? -1 : hex_digit(from[2]);
        if (low < 0 || high * 16 + low == 0) return false;
        *to++ = (char)(high * 16 + low);
        from += 2;
    }
    *to = 0;
    return true;
}

// Appends the segments of `uri` to `out`, which is long enough. False for refused paths.
static bool append_segments(char *out, const char *uri)
{
    if (uri[0] == '/' || uri[0] == '\\' || !uri[0]) return false;
    size_t length = strlen(out), start = length;
    while (*uri) {
        size_t n = strcspn(uri, "/\\");
        bool last = uri[n] == 0;
        if (n == 2 && uri[0] == '.' && uri[1] == '.') return false;
        if (memchr(uri, ':', n)) return false;
        if (n > 0 && !(n == 1 && uri[0] == '.')) {
            if (length > start) out[length++] = '/';
            memcpy(out + length, uri, n);
            length += n;
            out[length] = 0;
        }
        uri += last ? n : n + 1;
    }
    return length > start;
}

char *import_resolve_quietly(struct import *import, const char *uri, bool decode_percent)
{
    const char *slash = strrchr(import->path, '/');
    size_t folder_length = slash ? (size_t)(slash - import->path) + 1 : 0;
    char *decoded = host_strdup(import->host, uri);
    char *resolved = host_alloc(import->host, folder_length + strlen(uri) + 1, 1);
    if (!decoded || !resolved) goto fail;
    memcpy(resolved, import->path, folder_length);
    if (decode_percent && !percent_decode(decoded)) goto fail;
    if (!append_segments(resolved, decoded)) goto fail;
    host_free(import->host, decoded);
    return resolved;
fail:
    host_free(import->host, decoded);
    host_free(import->host, resolved);
    return NULL;
}

char *import_resolve(struct import *import, const char *uri)
{
    char *path = import_resolve_quietly(import, uri, true);
    if (!path) {
        host_fail(import->host, FAIL_FORMAT,
                  "%s: refers to \"%s\": only relative paths without \"..\" are allowed",
                  import->path, import_printable(uri).s);
    }
    return path;
}
