// Elements of accessors, whatever their type (glTF 2.0, section 3.6.2).
#include "scene/export/gltf_doc.h"

#include <string.h>

struct elements {
    struct gltf_doc *doc;
    json_t *json; // of the accessor
    size_t size, count;
    uint8_t *bytes; // [count] tight
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

// ---- the new accessor

static double component_at(const uint8_t *bytes, size_t type)
{
    int16_t s = 0;
    uint16_t us = 0;
    uint32_t u = 0;
    float f = 0.0f;
    switch (type) {
    case 5120:
        return (double)(int8_t)bytes[0];
    case 5121:
        return (double)bytes[0];
    case 5122:
        memcpy(&s, bytes, sizeof s);
        return (double)s;
    case 5123:
        memcpy(&us, bytes, sizeof us);
        return (double)us;
    case 5125:
        memcpy(&u, bytes, sizeof u);
        return (double)u;
    default:
        memcpy(&f, bytes, sizeof f);
        return (double)f;
    }
}

// The least or the largest value of each component.
static void set_range(struct elements *e, json_t *accessor, const char *key, bool largest)
{
    const size_t type = number(accessor, "componentType", 0);
    const size_t size = type < 5122 ? 1 : type < 5125 ? 2 : 4;
    json_t *range = json_array();
    for (size_t at = 0; at < e->size; at += size) {
        double value = component_at(e->bytes + at, type);
        for (size_t i = 1; i < e->count; i++) {
            const double other = component_at(e->bytes + i * e->size + at, type);
            if (largest ? other > value : other < value) value = other;
        }
        json_t *json = type == 5126 ? json_real(value) : json_integer((json_int_t)value);
        if (json_array_append_new(range, json) != 0) e->doc->failed = true;
    }
    gltf_doc_set(e->doc, accessor, key, range);
}

// Elements of vertex attributes begin at multiples of 4 bytes.
static size_t add_view(struct elements *e)
{
    struct gltf_doc *doc = e->doc;
    const size_t stride = (e->size + 3) & ~(size_t)3;
    uint8_t *padded = host_alloc(doc->host, e->count, stride);
    if (!padded) {
        doc->failed = true;
        return 0;
    }
    for (size_t i = 0; i < e->count; i++)
        memcpy(padded + i * stride, e->bytes + i * e->size, e->size);
    const size_t view = gltf_doc_add_view(doc, padded, e->count * stride);
    if (stride != e->size)
        gltf_doc_set(doc, json_array_get(gltf_doc_array(doc, "bufferViews"), view), "byteStride",
                     json_integer((json_int_t)stride));
    host_free(doc->host, padded);
    return view;
}

static size_t add_elements(struct elements *e)
{
    struct gltf_doc *doc = e->doc;
    const size_t view = add_view(e);
    json_t *copy = json_deep_copy(e->json);
    json_object_del(copy, "sparse");
    json_object_del(copy, "byteOffset");
    gltf_doc_set(doc, copy, "bufferView", json_integer((json_int_t)view));
    gltf_doc_set(doc, copy, "count", json_integer((json_int_t)e->count));
    if (json_object_get(copy, "min")) set_range(e, copy, "min", false);
    if (json_object_get(copy, "max")) set_range(e, copy, "max", true);
    return gltf_doc_add(doc, "accessors", copy);
}

static bool gather_elements(struct elements *e, const uint32_t *source, size_t count)
{
    uint8_t *gathered = host_alloc(e->doc->host, count, e->size);
    if (!gathered) return false;
    for (size_t i = 0; i < count; i++)
        memcpy(gathered + i * e->size, e->bytes + source[i] * e->size, e->size);
    host_free(e->doc->host, e->bytes);
    e->bytes = gathered;
    e->count = count;
    return true;
}

bool gltf_doc_gather_accessor(struct gltf_doc *doc, size_t accessor, size_t given,
                              const uint32_t *source, size_t count, size_t *out)
{
    struct elements e = { .doc = doc,
                          .json = json_array_get(gltf_doc_array(doc, "accessors"), accessor),
                          .count = given };
    e.size = element_size(e.json);
    e.bytes = host_alloc(doc->host, given, e.size);
    if (!e.bytes) return false;
    const bool found =
        e.size > 0 && number(e.json, "count", 0) == given && read_base(&e) && read_sparse(&e);
    const bool ok = found && gather_elements(&e, source, count);
    if (ok) *out = add_elements(&e);
    host_free(doc->host, e.bytes);
    return found ? ok
                 : host_fail(doc->host, FAIL_FORMAT,
                             "glTF: accessor %zu has not %zu elements inside of the buffer",
                             accessor, given);
}
