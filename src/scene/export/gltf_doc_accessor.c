// Elements of accessors, whatever their type (glTF 2.0, section 3.6.2).
#include "scene/export/gltf_doc.h"

#include <string.h>

struct elements {
    struct gltf_doc *doc;
    json_t *json; // of the accessor
    size_t size, count;
    uint8_t *bytes; // [count + more] tight
};

static size_t number(const json_t *object, const char *key, size_t fallback)
{
    const json_t *value = json_object_get(object, key);
    if (!value) return fallback;
    return json_is_integer(value) && json_integer_value(value) >= 0
               ? (size_t)json_integer_value(value)
               : SIZE_MAX;
}

static size_t element_size(const json_t *accessor)
{
    static const char *const types[] = { "SCALAR", "VEC2", "VEC3", "VEC4" };
    const size_t component = number(accessor, "componentType", 0);
    const size_t bytes = component == 5120 || component == 5121   ? 1
                         : component == 5122 || component == 5123 ? 2
                         : component == 5125 || component == 5126 ? 4
                                                                  : 0;
    const char *type = json_string_value(json_object_get(accessor, "type"));
    for (size_t i = 0; type && i < 4; i++)
        if (strcmp(type, types[i]) == 0) return bytes * (i + 1);
    return 0;
}

// The first byte of `count` elements in a view, NULL where they are not inside of the buffer.
static const uint8_t *find(const struct gltf_doc *doc, size_t view, size_t offset, size_t size,
                           size_t count, size_t *stride)
{
    const json_t *json = json_array_get(json_object_get(doc->root, "bufferViews"), view);
    const size_t first = number(json, "byteOffset", 0), length = number(json, "byteLength", 0);
    *stride = number(json, "byteStride", size);
    if (!json || number(json, "buffer", SIZE_MAX) != 0 || *stride < size || count == 0) return NULL;
    if (first > doc->size || length > doc->size - first || offset > length) return NULL;
    if (*stride > length || (count - 1) > (length - offset) / *stride) return NULL;
    if ((count - 1) * *stride + size > length - offset) return NULL;
    return doc->binary + first + offset;
}

static bool read_base(struct elements *e)
{
    size_t stride;
    const json_t *view = json_object_get(e->json, "bufferView");
    if (!view) return true; // zeros
    const uint8_t *from = find(e->doc, number(e->json, "bufferView", SIZE_MAX),
                               number(e->json, "byteOffset", 0), e->size, e->count, &stride);
    for (size_t i = 0; from && i < e->count; i++)
        memcpy(e->bytes + i * e->size, from + i * stride, e->size);
    return from;
}

static size_t index_at(const uint8_t *bytes, size_t size)
{
    uint32_t value = 0;
    memcpy(&value, bytes, size); // little-endian
    return value;
}

static bool read_sparse(struct elements *e)
{
    const json_t *sparse = json_object_get(e->json, "sparse");
    if (!sparse) return true;
    const json_t *indices = json_object_get(sparse, "indices");
    const json_t *values = json_object_get(sparse, "values");
    const size_t count = number(sparse, "count", 0);
    const size_t type = number(indices, "componentType", 0);
    const size_t size = type == 5121 ? 1 : type == 5123 ? 2 : 4;
    size_t step, stride;
    const uint8_t *at = find(e->doc, number(indices, "bufferView", SIZE_MAX),
                             number(indices, "byteOffset", 0), size, count, &step);
    const uint8_t *from = find(e->doc, number(values, "bufferView", SIZE_MAX),
                               number(values, "byteOffset", 0), e->size, count, &stride);
    if (!at || !from) return false;
    for (size_t i = 0; i < count; i++) {
        const size_t index = index_at(at + i * step, size);
        if (index >= e->count) return false;
        memcpy(e->bytes + index * e->size, from + i * stride, e->size);
    }
    return true;
}

// Elements of vertex attributes begin at multiples of 4 bytes.
static size_t add_elements(struct elements *e, size_t count)
{
    struct gltf_doc *doc = e->doc;
    const size_t stride = (e->size + 3) & ~(size_t)3;
    uint8_t *padded = host_alloc(doc->host, count, stride);
    if (!padded) {
        doc->failed = true;
        return 0;
    }
    for (size_t i = 0; i < count; i++) memcpy(padded + i * stride, e->bytes + i * e->size, e->size);
    const size_t view = gltf_doc_add_view(doc, padded, count * stride);
    if (stride != e->size)
        gltf_doc_set(doc, json_array_get(gltf_doc_array(doc, "bufferViews"), view), "byteStride",
                     json_integer((json_int_t)stride));
    host_free(doc->host, padded);
    json_t *copy = json_deep_copy(e->json);
    json_object_del(copy, "sparse");
    json_object_del(copy, "byteOffset");
    gltf_doc_set(doc, copy, "bufferView", json_integer((json_int_t)view));
    gltf_doc_set(doc, copy, "count", json_integer((json_int_t)count));
    return gltf_doc_add(doc, "accessors", copy);
}

bool gltf_doc_extend_accessor(struct gltf_doc *doc, size_t accessor, size_t count,
                              const uint32_t *more, size_t more_count, size_t *out)
{
    struct elements e = { .doc = doc,
                          .json = json_array_get(gltf_doc_array(doc, "accessors"), accessor),
                          .count = count };
    e.size = element_size(e.json);
    e.bytes = host_alloc(doc->host, count + more_count, e.size);
    if (!e.bytes) return false;
    const bool ok =
        e.size > 0 && number(e.json, "count", 0) == count && read_base(&e) && read_sparse(&e);
    if (ok) {
        for (size_t i = 0; i < more_count; i++)
            memcpy(e.bytes + (count + i) * e.size, e.bytes + more[i] * e.size, e.size);
        *out = add_elements(&e, count + more_count);
    }
    host_free(doc->host, e.bytes);
    return ok || host_fail(doc->host, FAIL_FORMAT,
                           "glTF: accessor %zu has not %zu elements inside of the buffer", accessor,
                           count);
}
