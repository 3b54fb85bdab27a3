// Accessors of a glTF file (glTF 2.0, section 3.6). Offsets, strides and counts are checked against
// the size of the data before reading or allocating.
#include "scene/import/gltf/gltf.h"

#include <math.h>
#include <string.h>

enum component_type {
    COMPONENT_BYTE = 5120,
    COMPONENT_UBYTE,
    COMPONENT_SHORT,
    COMPONENT_USHORT,
    COMPONENT_UINT = 5125,
    COMPONENT_FLOAT,
};

struct accessor {
    struct gltf_object object;
    size_t count, offset;
    int width; // components
    enum component_type component;
    bool normalized;
    int view; // -1: zeros, with sparse values
};

static size_t component_size(enum component_type type)
{
    switch (type) {
    case COMPONENT_BYTE:
    case COMPONENT_UBYTE:
        return 1;
    case COMPONENT_SHORT:
    case COMPONENT_USHORT:
        return 2;
    case COMPONENT_UINT:
    case COMPONENT_FLOAT:
        return 4;
    }
    return 0;
}

static int width_of(const char *type)
{
    static const struct {
        const char *name;
        int width;
    } types[] = { { "SCALAR", 1 }, { "VEC2", 2 }, { "VEC3", 3 }, { "VEC4", 4 }, { "MAT4", 16 } };
    for (size_t i = 0; type && i < sizeof types / sizeof *types; i++) {
        if (strcmp(type, types[i].name) == 0) return types[i].width;
    }
    return 0;
}

static bool read_accessor(struct gltf *gltf, int index, struct accessor *out)
{
    struct gltf_object object = gltf_element(gltf, gltf->accessors, "accessor", (size_t)index);
    *out = (struct accessor){
        .object = object,
        .count = gltf_size(object, "count", 0, UINT32_MAX - 1),
        .offset = gltf_size(object, "byteOffset", 0, SIZE_MAX / 4),
        .width = width_of(gltf_string(object, "type")),
        .component = (enum component_type)gltf_size(object, "componentType", 0, 65535),
        .normalized = gltf_bool(object, "normalized", false),
        .view = gltf_index(object, "bufferView", gltf->views),
    };
    if (gltf->failed) return false;
    if (out->count == 0) return gltf_wrong(object, "has no elements");
    if (component_size(out->component) == 0) return gltf_wrong(object, "unknown componentType");
    if (out->width == 0) {
        return gltf_wrong(object, "its type is none of SCALAR, VEC2, VEC3, VEC4, MAT4");
    }
    if (out->view < 0 && !gltf_has(object, "sparse")) {
        return gltf_wrong(object, "has no data: no bufferView (only a compressed copy?)");
    }
    return true;
}

bool gltf_view(struct gltf *gltf, int index, struct gltf_view *out)
{
    struct gltf_object object = gltf_element(gltf, gltf->views, "bufferView", (size_t)index);
    struct gltf_object root = { gltf, gltf->root, "file", 0 };
    int buffer = gltf_index(object, "buffer", gltf_array(root, "buffers"));
    size_t offset = gltf_size(object, "byteOffset", 0, SIZE_MAX / 4);
    size_t length = gltf_size(object, "byteLength", 0, SIZE_MAX / 4);
    size_t stride = gltf_size(object, "byteStride", 0, 65535);
    if (gltf->failed) return false;
    if (buffer < 0) return gltf_wrong(object, "has no buffer");
    size_t size = gltf->buffers[buffer].size;
    if (offset > size || length > size - offset) {
        return gltf_wrong(object, "bytes %zu to %zu are not in buffer %d of %zu bytes", offset,
                          offset + length, buffer, size);
    }
    *out = (struct gltf_view){ gltf->buffers[buffer].data + offset, length, stride };
    return true;
}

// The first byte of `count` elements at `offset` of a view, and their stride.
static bool view_elements(struct gltf *gltf, struct gltf_object object, int view, size_t offset,
                          size_t count, size_t element, const uint8_t **data, size_t *stride)
{
    struct gltf_view bytes;
    if (!gltf_view(gltf, view, &bytes)) return false;
    *stride = bytes.stride ? bytes.stride : element;
    if (*stride < element) {
        return gltf_wrong(object, "byteStride %zu is less than an element's %zu bytes", *stride,
                          element);
    }
    size_t last;
    if (!size_mul(*stride, count - 1, &last) || !size_add(last, offset, &last) ||
        !size_add(last, element, &last) || last > bytes.size) {
        return gltf_wrong(object, "%zu elements do not fit into bufferView %d of %zu bytes", count,
                          view, bytes.size);
    }
    *data = bytes.data + offset;
    return true;
}

// glTF 2.0, section 3.6.2.2: c / 127 and so on, the most negative clamped to -1.
static float component_as_float(const uint8_t *bytes, enum component_type type, bool normalized)
{
    int8_t i8;
    int16_t i16;
    uint16_t u16;
    uint32_t u32;
    float f32;
    switch (type) {
    case COMPONENT_BYTE:
        memcpy(&i8, bytes, 1);
        return normalized ? fmaxf((float)i8 / 127.0f, -1.0f) : (float)i8;
    case COMPONENT_UBYTE:
        return normalized ? (float)bytes[0] / 255.0f : (float)bytes[0];
    case COMPONENT_SHORT:
        memcpy(&i16, bytes, 2);
        return normalized ? fmaxf((float)i16 / 32767.0f, -1.0f) : (float)i16;
    case COMPONENT_USHORT:
        memcpy(&u16, bytes, 2);
        return normalized ? (float)u16 / 65535.0f : (float)u16;
    case COMPONENT_UINT:
        memcpy(&u32, bytes, 4);
        return (float)u32;
    case COMPONENT_FLOAT:
        memcpy(&f32, bytes, 4);
        return f32;
    }
    return 0.0f;
}

static uint32_t component_as_integer(const uint8_t *bytes, enum component_type type)
{
    uint16_t u16;
    uint32_t u32;
    switch (type) {
    case COMPONENT_UBYTE:
        return bytes[0];
    case COMPONENT_USHORT:
        memcpy(&u16, bytes, 2);
        return u16;
    case COMPONENT_UINT:
        memcpy(&u32, bytes, 4);
        return u32;
    default:
        return 0;
    }
}

// Converts `count` elements; slots[i] is the output index of element i, i itself for NULL.
static void convert_floats(const struct accessor *accessor, const uint8_t *data, size_t stride,
                           const uint32_t *slots, size_t count, float *out)
{
    size_t width = (size_t)accessor->width, size = component_size(accessor->component);
    for (size_t i = 0; i < count; i++) {
        float *to = out + (slots ? slots[i] : i) * width;
        const uint8_t *from = data + i * stride;
        if (accessor->component == COMPONENT_FLOAT) {
            memcpy(to, from, width * sizeof *to);
            continue;
        }
        for (size_t k = 0; k < width; k++) {
            to[k] = component_as_float(from + k * size, accessor->component, accessor->normalized);
        }
    }
}

static bool is_unsigned(enum component_type type)
{
    return type == COMPONENT_UBYTE || type == COMPONENT_USHORT || type == COMPONENT_UINT;
}

// Sparse indices must be strictly ascending and within the accessor.
static bool check_slots(const struct accessor *accessor, const uint32_t *slots, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        if (slots[i] >= accessor->count || (i > 0 && slots[i] <= slots[i - 1])) {
            return gltf_wrong(accessor->object,
                              "sparse index %zu (%u of %zu) is out of order or range", i, slots[i],
                              accessor->count);
        }
    }
    return true;
}

static bool apply_sparse(struct gltf *gltf, const struct accessor *accessor, float *out)
{
    struct gltf_object sparse = gltf_child(accessor->object, "sparse");
    if (!sparse.json) return !gltf->failed;
    struct gltf_object indices = gltf_child(sparse, "indices");
    struct gltf_object values = gltf_child(sparse, "values");
    size_t count = gltf_size(sparse, "count", 0, accessor->count);
    int index_view = gltf_index(indices, "bufferView", gltf->views);
    int value_view = gltf_index(values, "bufferView", gltf->views);
    size_t index_offset = gltf_size(indices, "byteOffset", 0, SIZE_MAX / 4);
    size_t value_offset = gltf_size(values, "byteOffset", 0, SIZE_MAX / 4);
    enum component_type type = (enum component_type)gltf_size(indices, "componentType", 0, 65535);
    if (gltf->failed) return false;
    if (count == 0 || index_view < 0 || value_view < 0 || !is_unsigned(type)) {
        return gltf_wrong(accessor->object, "sparse values are incomplete");
    }
    const uint8_t *index_data, *value_data;
    size_t index_stride, value_stride;
    size_t element = (size_t)accessor->width * component_size(accessor->component);
    if (!view_elements(gltf, accessor->object, index_view, index_offset, count,
                       component_size(type), &index_data, &index_stride) ||
        !view_elements(gltf, accessor->object, value_view, value_offset, count, element,
                       &value_data, &value_stride)) {
        return false;
    }
    uint32_t *slots = host_alloc(gltf->import->host, count, sizeof *slots);
    if (!slots) return false;
    for (size_t i = 0; i < count; i++) {
        slots[i] = component_as_integer(index_data + i * index_stride, type);
    }
    bool ok = check_slots(accessor, slots, count);
    if (ok) convert_floats(accessor, value_data, value_stride, slots, count, out);
    host_free(gltf->import->host, slots);
    return ok;
}

static bool check_width(const struct accessor *accessor, int width)
{
    if (accessor->width == width) return true;
    return gltf_wrong(accessor->object, "has %d components, %d are needed", accessor->width, width);
}

size_t gltf_accessor_count(struct gltf *gltf, int index)
{
    struct accessor accessor;
    return read_accessor(gltf, index, &accessor) ? accessor.count : 0;
}

int gltf_accessor_width(struct gltf *gltf, int index)
{
    struct accessor accessor;
    return read_accessor(gltf, index, &accessor) ? accessor.width : 0;
}

float *gltf_floats_of(struct gltf *gltf, int index, int width)
{
    struct accessor accessor;
    if (!read_accessor(gltf, index, &accessor) || !check_width(&accessor, width)) return NULL;
    if (gltf->cached[index].array) return gltf->cached[index].array;
    size_t element = (size_t)width * component_size(accessor.component);
    const uint8_t *data = NULL;
    size_t stride = 0;
    // Checks the data before allocating.
    if (accessor.view >= 0 && !view_elements(gltf, accessor.object, accessor.view, accessor.offset,
                                             accessor.count, element, &data, &stride)) {
        return NULL;
    }
    float *out = import_alloc(gltf->import, accessor.count, (size_t)width * sizeof *out);
    if (!out) gltf->failed = true;
    if (!out) return NULL;
    if (data) convert_floats(&accessor, data, stride, NULL, accessor.count, out);
    if (!apply_sparse(gltf, &accessor, out)) return NULL;
    gltf->cached[index] = (struct gltf_cached){ out, width };
    return out;
}

uint32_t *gltf_integers_of(struct gltf *gltf, int index, int width)
{
    struct accessor accessor;
    if (!read_accessor(gltf, index, &accessor) || !check_width(&accessor, width)) return NULL;
    if (!is_unsigned(accessor.component) || accessor.view < 0 ||
        gltf_has(accessor.object, "sparse")) {
        gltf_wrong(accessor.object, "is used for indices or joints, but is sparse or not of "
                                    "unsigned integers");
        return NULL;
    }
    size_t size = component_size(accessor.component), stride;
    const uint8_t *data;
    if (!view_elements(gltf, accessor.object, accessor.view, accessor.offset, accessor.count,
                       size * (size_t)width, &data, &stride)) {
        return NULL;
    }
    uint32_t *out = import_alloc(gltf->import, accessor.count, (size_t)width * sizeof *out);
    if (!out) gltf->failed = true;
    for (size_t i = 0; out && i < accessor.count * (size_t)width; i++) {
        const uint8_t *from = data + i / (size_t)width * stride + i % (size_t)width * size;
        out[i] = component_as_integer(from, accessor.component);
    }
    return out;
}
