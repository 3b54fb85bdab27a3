// Additions to a document, and GLB (glTF 2.0, section 4.4).
#include "scene/export/gltf_doc.h"

#include "core/files/file.h"

#include <stdlib.h>
#include <string.h>

bool gltf_doc_init(struct gltf_doc *doc, struct host *host)
{
    *doc = (struct gltf_doc){ .host = host, .root = json_object() };
    return doc->root || host_fail(host, FAIL_MEMORY, "glTF: out of memory");
}

void gltf_doc_finish(struct gltf_doc *doc)
{
    if (!doc->host) return;
    json_decref(doc->root);
    host_free(doc->host, doc->binary);
    host_free(doc->host, doc->places);
    host_free(doc->host, doc->off_lights);
    *doc = (struct gltf_doc){ 0 };
}

// ---- JSON

json_t *gltf_doc_array(struct gltf_doc *doc, const char *name)
{
    json_t *array = json_object_get(doc->root, name);
    if (json_is_array(array)) return array;
    array = json_array();
    gltf_doc_set(doc, doc->root, name, array);
    return json_object_get(doc->root, name);
}

size_t gltf_doc_add(struct gltf_doc *doc, const char *name, json_t *element)
{
    json_t *array = gltf_doc_array(doc, name);
    if (json_array_append_new(array, element) != 0) doc->failed = true;
    return json_array_size(array) - 1;
}

void gltf_doc_set(struct gltf_doc *doc, json_t *object, const char *key, json_t *value)
{
    if (json_object_set_new(object, key, value) != 0) doc->failed = true;
}

json_t *gltf_doc_child(struct gltf_doc *doc, json_t *object, const char *key)
{
    json_t *child = json_object_get(object, key);
    if (json_is_object(child)) return child;
    gltf_doc_set(doc, object, key, json_object());
    return json_object_get(object, key);
}

void gltf_doc_use_extension(struct gltf_doc *doc, const char *name)
{
    json_t *used = gltf_doc_array(doc, "extensionsUsed"), *value;
    size_t i;
    json_array_foreach(used, i, value)
    {
        const char *text = json_string_value(value);
        if (text && strcmp(text, name) == 0) return;
    }
    gltf_doc_add(doc, "extensionsUsed", json_string(name));
}

json_t *gltf_doc_text(const char *text)
{
    json_t *string = json_string(text);
    if (string) return string;
    string = json_string("");
    for (const char *c = text; string && *c; c++) {
        json_t *longer =
            json_sprintf("%s%c", json_string_value(string), (unsigned char)*c < 0x80 ? *c : '?');
        json_decref(string);
        string = longer;
    }
    return string;
}

json_t *gltf_doc_floats(const float *values, size_t count)
{
    json_t *array = json_array();
    for (size_t i = 0; array && i < count; i++)
        if (json_array_append_new(array, json_real((double)values[i])) != 0) {
            json_decref(array);
            return NULL;
        }
    return array;
}

// ---- the buffer

enum { ALIGNMENT = 4 };

static bool reserve(struct gltf_doc *doc, size_t end)
{
    if (end <= doc->capacity) return true;
    const size_t capacity = end > 2 * doc->capacity ? end : 2 * doc->capacity;
    uint8_t *larger = host_realloc(doc->host, doc->binary, capacity, 1);
    if (!larger) return false;
    doc->binary = larger;
    doc->capacity = capacity;
    return true;
}

size_t gltf_doc_add_view(struct gltf_doc *doc, const void *data, size_t size)
{
    const size_t offset = doc->size, end = (offset + size + ALIGNMENT - 1) & ~(size_t)3;
    if (end < offset || !reserve(doc, end)) {
        doc->failed = true;
        return 0;
    }
    if (size > 0) memcpy(doc->binary + offset, data, size);
    memset(doc->binary + offset + size, 0, end - offset - size);
    doc->size = end;
    return gltf_doc_add(doc, "bufferViews",
                        json_pack("{s:i, s:I, s:I}", "buffer", 0, "byteOffset", (json_int_t)offset,
                                  "byteLength", (json_int_t)size));
}

size_t gltf_doc_add_accessor(struct gltf_doc *doc, const void *data, enum gltf_component component,
                             const char *type, size_t count)
{
    const size_t width = strcmp(type, "MAT4") == 0     ? 16
                         : strcmp(type, "SCALAR") == 0 ? 1
                                                       : (size_t)(type[3] - '0'); // VEC2 to VEC4
    const size_t view =
        gltf_doc_add_view(doc, data, count * width * (component == GLTF_USHORT ? 2 : 4));
    return gltf_doc_add(doc, "accessors",
                        json_pack("{s:I, s:i, s:s, s:I}", "bufferView", (json_int_t)view,
                                  "componentType", (int)component, "type", type, "count",
                                  (json_int_t)count));
}

// ---- GLB

static const uint32_t MAGIC = 0x46546c67, CHUNK_JSON = 0x4e4f534a, CHUNK_BIN = 0x004e4942;

static void put_u32(struct file_writer *file, uint32_t value)
{
    const uint8_t bytes[4] = { (uint8_t)value, (uint8_t)(value >> 8), (uint8_t)(value >> 16),
                               (uint8_t)(value >> 24) };
    file_write(file, bytes, sizeof bytes);
}

static bool write_chunks(struct gltf_doc *doc, const char *path, const char *json)
{
    const size_t text = strlen(json), padded = (text + 3) & ~(size_t)3;
    const size_t total = 12 + 8 + padded + (doc->size > 0 ? 8 + doc->size : 0);
    struct file_writer file = { 0 };
    if (total < text || total > UINT32_MAX)
        return host_fail(doc->host, FAIL_UNSUPPORTED, "%s: glTF of more than 4 GiB", path);
    if (!file_begin(&file, doc->host, path)) return false;
    put_u32(&file, MAGIC);
    put_u32(&file, 2);
    put_u32(&file, (uint32_t)total);
    put_u32(&file, (uint32_t)padded);
    put_u32(&file, CHUNK_JSON);
    file_write(&file, json, text);
    file_write(&file, "   ", padded - text);
    if (doc->size > 0) {
        put_u32(&file, (uint32_t)doc->size);
        put_u32(&file, CHUNK_BIN);
        file_write(&file, doc->binary, doc->size);
    }
    return file_commit(&file);
}

// The first buffer is the binary chunk; others have no data (EXT_meshopt_compression).
static void state_size(struct gltf_doc *doc)
{
    if (doc->size == 0) return;
    json_t *buffers = gltf_doc_array(doc, "buffers");
    if (json_array_size(buffers) == 0) gltf_doc_add(doc, "buffers", json_object());
    gltf_doc_set(doc, json_array_get(buffers, 0), "byteLength",
                 json_integer((json_int_t)doc->size));
}

bool gltf_doc_write(struct gltf_doc *doc, const char *path)
{
    state_size(doc);
    char *json = doc->failed ? NULL : json_dumps(doc->root, JSON_COMPACT);
    if (!json) return host_fail(doc->host, FAIL_MEMORY, "%s: out of memory", path);
    const bool ok = write_chunks(doc, path, json);
    free(json);
    return ok;
}
