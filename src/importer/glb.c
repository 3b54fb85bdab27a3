// Builds a glTF file: arrays of JSON objects, and one buffer of aligned views.
#include "importer/importer.h"

#include <stdlib.h>
#include <string.h>

static json_t *need(json_t *value)
{
    if (!value) output_fail("memory", "out of memory, or a number that is not finite");
    return value;
}

void glb_set(json_t *object, const char *key, json_t *value)
{
    if (json_object_set_new(object, key, need(value)) != 0) output_fail("memory", "out of memory");
}

struct glb glb_begin(void)
{
    struct glb glb = { .root = need(json_object()) };
    glb_set(glb.root, "asset", need(json_pack("{s:s}", "version", "2.0")));
    return glb;
}

size_t glb_count(const struct glb *glb, const char *array)
{
    return json_array_size(json_object_get(glb->root, array));
}

size_t glb_add(struct glb *glb, const char *array, json_t *element)
{
    json_t *list = json_object_get(glb->root, array);
    if (!list) glb_set(glb->root, array, list = json_array());
    if (json_array_append_new(list, need(element)) != 0) output_fail("memory", "out of memory");
    return json_array_size(list) - 1;
}

size_t glb_add_view(struct glb *glb, const void *data, size_t size)
{
    size_t offset = glb->size, end = (offset + size + 3) & ~(size_t)3;
    if (end < offset) output_fail("memory", "out of memory");
    if (end > glb->capacity) {
        glb->capacity = end > 2 * glb->capacity ? end : 2 * glb->capacity;
        glb->binary = realloc(glb->binary, glb->capacity);
        if (!glb->binary) output_fail("memory", "out of memory");
    }
    if (size > 0) memcpy(glb->binary + offset, data, size);
    memset(glb->binary + offset + size, 0, end - offset - size);
    glb->size = end;
    return glb_add(glb, "bufferViews",
                   json_pack("{s:i, s:I, s:I}", "buffer", 0, "byteOffset", (json_int_t)offset,
                             "byteLength", (json_int_t)size));
}

size_t glb_add_accessor(struct glb *glb, const void *data, int component, const char *type,
                        size_t count)
{
    size_t width = strcmp(type, "MAT4") == 0     ? 16
                   : strcmp(type, "SCALAR") == 0 ? 1
                                                 : (size_t)(type[3] - '0'); // VEC2, VEC3, VEC4
    size_t view = glb_add_view(glb, data, count * width * (component == GLB_USHORT ? 2 : 4));
    return glb_add(glb, "accessors",
                   json_pack("{s:I, s:i, s:s, s:I}", "bufferView", (json_int_t)view,
                             "componentType", component, "type", type, "count", (json_int_t)count));
}

json_t *glb_text(const char *text)
{
    json_t *string = json_string(text);
    if (string) return string;
    char *ascii = allocate(strlen(text) + 1, 1);
    for (size_t i = 0; text[i]; i++) ascii[i] = (unsigned char)text[i] < 0x80 ? text[i] : '?';
    string = need(json_string(ascii));
    free(ascii);
    return string;
}

json_t *glb_floats(const float *values, size_t count)
{
    json_t *array = need(json_array());
    for (size_t i = 0; i < count; i++)
        json_array_append_new(array, need(json_real((double)values[i])));
    return array;
}

void glb_write(struct glb *glb)
{
    if (glb->size > 0)
        glb_add(glb, "buffers", json_pack("{s:I}", "byteLength", (json_int_t)glb->size));
    char *text = json_dumps(glb->root, JSON_COMPACT);
    if (!text) output_fail("memory", "out of memory");
    output_glb(text, glb->binary, glb->size);
}
