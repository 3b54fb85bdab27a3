// Checks before Assimp reads a file. Its readers of X and FBX recurse into nested blocks and
// allocate the array lengths that a file states; both are bounded here.
#include "scene/import/assimp/assimp.h"

#include <string.h>

enum { MAX_DEPTH = 64 };

static bool too_deep(struct import *import)
{
    return host_fail(import->host, FAIL_FORMAT, "%s: blocks nested deeper than %d", import->path,
                     MAX_DEPTH);
}

static bool check_braces(struct import *import, const struct file_bytes *bytes)
{
    int depth = 0;
    for (size_t i = 0; i < bytes->size; i++) {
        if (bytes->data[i] == '{' && ++depth > MAX_DEPTH) return too_deep(import);
        if (bytes->data[i] == '}' && depth > 0) depth--;
    }
    return true;
}

// --- Binary FBX: records of end offset, property count, property bytes, name, properties, nested
// records.

struct fbx_cursor {
    struct import *import;
    const uint8_t *data;
    size_t size, at;
    bool wide; // 64-bit offsets, since version 7500
};

static uint64_t fbx_unsigned(struct fbx_cursor *c, int bytes)
{
    uint64_t value = 0;
    for (int i = 0; i < bytes; i++) value |= (uint64_t)c->data[c->at + (size_t)i] << (8 * i);
    c->at += (size_t)bytes;
    return value;
}

static bool fbx_cut(struct fbx_cursor *c)
{
    return host_fail(c->import->host, FAIL_FORMAT, "%s: FBX record at byte %zu is damaged",
                     c->import->path, c->at);
}

// One property; arrays are charged to the memory budget.
static bool fbx_property(struct fbx_cursor *c)
{
    static const struct {
        char type;
        uint8_t size;
    } scalars[] = { { 'Y', 2 }, { 'C', 1 }, { 'I', 4 }, { 'F', 4 },
                    { 'D', 8 }, { 'L', 8 }, { 'B', 1 } };
    if (c->at >= c->size) return fbx_cut(c);
    char type = (char)c->data[c->at++];
    for (size_t i = 0; i < sizeof scalars / sizeof *scalars; i++) {
        if (type != scalars[i].type) continue;
        if (scalars[i].size > c->size - c->at) return fbx_cut(c);
        c->at += scalars[i].size;
        return true;
    }
    bool text = type == 'S' || type == 'R';
    if (!text && !(type && strchr("fdlibc", type))) return fbx_cut(c);
    if (c->size - c->at < (text ? 4 : 12)) return fbx_cut(c);
    uint64_t length = fbx_unsigned(c, 4);
    if (!text) {
        if (!import_charge(c->import, (size_t)length, 8)) return false;
        c->at += 4; // encoding
        length = fbx_unsigned(c, 4);
    }
    if (length > c->size - c->at) return fbx_cut(c);
    c->at += (size_t)length;
    return true;
}

// The header of a record and its properties; *end is 0 for the null record at the end of a list.
static bool fbx_record(struct fbx_cursor *c, uint64_t *end)
{
    int word = c->wide ? 8 : 4;
    if (c->size - c->at < 3 * (size_t)word + 1) return fbx_cut(c);
    *end = fbx_unsigned(c, word);
    uint64_t properties = fbx_unsigned(c, word);
    c->at += (size_t)word; // bytes of the properties
    size_t name = (size_t)fbx_unsigned(c, 1);
    if (name > c->size - c->at) return fbx_cut(c);
    c->at += name;
    if (*end == 0) return true;
    for (uint64_t i = 0; i < properties; i++) {
        if (!fbx_property(c)) return false;
    }
    if (*end < c->at || *end > c->size) return fbx_cut(c);
    return true;
}

static bool check_fbx_records(struct import *import, const struct file_bytes *bytes)
{
    enum { HEADER = 27 };
    struct fbx_cursor c = { import, bytes->data, bytes->size, HEADER - 4, false };
    if (bytes->size < HEADER) return fbx_cut(&c);
    c.wide = fbx_unsigned(&c, 4) >= 7500;
    uint64_t ends[MAX_DEPTH];
    int depth = 0;
    while (c.at < c.size) {
        uint64_t end = 0;
        while (depth > 0 && c.at == ends[depth - 1]) depth--;
        if (!fbx_record(&c, &end)) return false;
        if (end == 0) {
            if (depth == 0) return true; // the footer follows
            if (c.at != ends[depth - 1]) return fbx_cut(&c);
            continue;
        }
        if (depth > 0 && end > ends[depth - 1]) return fbx_cut(&c);
        if (end == c.at) continue;
        if (depth == MAX_DEPTH) return too_deep(import);
        ends[depth++] = end;
    }
    return true;
}

bool assimp_check_input(struct import *import, const struct file_bytes *bytes,
                        const char *extension)
{
    static const char fbx_magic[] = "Kaydara FBX Binary  ";
    if (strcmp(extension, "fbx") == 0) {
        bool binary = bytes->size >= sizeof fbx_magic &&
                      memcmp(bytes->data, fbx_magic, sizeof fbx_magic) == 0;
        return binary ? check_fbx_records(import, bytes) : check_braces(import, bytes);
    }
    if (strcmp(extension, "x") != 0) return true;
    if (bytes->size < 16 || memcmp(bytes->data, "xof ", 4) != 0) {
        return host_fail(import->host, FAIL_FORMAT, "%s: not an X file", import->path);
    }
    if (memcmp(bytes->data + 8, "txt ", 4) != 0) {
        return host_fail(import->host, FAIL_UNSUPPORTED,
                         "%s: binary and compressed X files are not supported; save it as text",
                         import->path);
    }
    return check_braces(import, bytes);
}
