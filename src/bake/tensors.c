// Named arrays: types, lookup, checks.
#include "bake/tensors.h"

#include <assert.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

_Static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "arrays are written as they lie");

static const struct {
    const char *name;
    size_t bytes;
} types[TENSOR_TYPE_COUNT] = {
    [TENSOR_F32] = { "F32", 4 }, [TENSOR_F16] = { "F16", 2 }, [TENSOR_U8] = { "U8", 1 },
    [TENSOR_U16] = { "U16", 2 }, [TENSOR_U32] = { "U32", 4 }, [TENSOR_I32] = { "I32", 4 },
    [TENSOR_F64] = { "F64", 8 },
};

const char *tensor_type_name(enum tensor_type type)
{
    return types[type].name;
}

size_t tensor_type_bytes(enum tensor_type type)
{
    return types[type].bytes;
}

bool tensor_extent(enum tensor_type type, int rank, const uint64_t *shape, size_t *out)
{
    size_t bytes = tensor_type_bytes(type);
    bool empty = false;
    for (int i = 0; i < rank; i++) empty = empty || shape[i] == 0;
    for (int i = 0; i < rank && !empty; i++)
        if (shape[i] > SIZE_MAX || !size_mul(bytes, (size_t)shape[i], &bytes)) return false;
    *out = empty ? 0 : bytes;
    return true;
}

static bool floats_are_finite(const float *values, size_t count)
{
    for (size_t i = 0; i < count; i++)
        if (!isfinite(values[i])) return false;
    return true;
}

static bool doubles_are_finite(const double *values, size_t count)
{
    for (size_t i = 0; i < count; i++)
        if (!isfinite(values[i])) return false;
    return true;
}

static bool halves_are_finite(const uint16_t *values, size_t count)
{
    static const unsigned EXPONENT = 0x7c00;
    for (size_t i = 0; i < count; i++)
        if ((values[i] & EXPONENT) == EXPONENT) return false;
    return true;
}

bool tensor_is_finite(const struct tensor *tensor)
{
    const size_t count = tensor->bytes / tensor_type_bytes(tensor->type);
    if (tensor->type == TENSOR_F32) return floats_are_finite(tensor->data, count);
    if (tensor->type == TENSOR_F64) return doubles_are_finite(tensor->data, count);
    return tensor->type != TENSOR_F16 || halves_are_finite(tensor->data, count);
}

bool tensor_is_same(const struct tensor *a, const struct tensor *b)
{
    return a && a->type == b->type && a->rank == b->rank &&
           memcmp(a->shape, b->shape, sizeof a->shape) == 0;
}

const struct tensor *tensors_find(const struct tensors *set, const char *name)
{
    for (size_t i = 0; i < set->count; i++)
        if (strcmp(set->at[i].name, name) == 0) return &set->at[i];
    return NULL;
}

const char *tensors_metadata(const struct tensors *set, const char *key)
{
    for (size_t i = 0; i < set->metadata_count; i++)
        if (strcmp(set->metadata[i].key, key) == 0) return set->metadata[i].value;
    return NULL;
}

enum { SHAPE_TEXT = TENSOR_MAX_RANK * 24 };

static void print_shape(int rank, const uint64_t *shape, char out[SHAPE_TEXT])
{
    size_t used = 0;
    snprintf(out, SHAPE_TEXT, "[]");
    for (int i = 0; i < rank && used < SHAPE_TEXT; i++) {
        const int wrote = snprintf(out + used, SHAPE_TEXT - used, "%s%llu%s", i ? ", " : "[",
                                   (unsigned long long)shape[i], i + 1 == rank ? "]" : "");
        used += wrote > 0 ? (size_t)wrote : 0;
    }
}

static bool has_shape(const struct tensor *tensor, int rank, const uint64_t *shape)
{
    return tensor->rank == rank &&
           (rank == 0 || memcmp(tensor->shape, shape, (size_t)rank * sizeof *shape) == 0);
}

const void *tensors_expect(struct host *host, const struct tensors *set, const char *name,
                           enum tensor_type type, int rank, const uint64_t *shape)
{
    const struct tensor *tensor = tensors_find(set, name);
    char has[SHAPE_TEXT], wanted[SHAPE_TEXT];
    if (!tensor) {
        host_fail(host, FAIL_FORMAT, "cannot use the bake: it has no tensor %s; bake again", name);
        return NULL;
    }
    if (tensor->type != type || !has_shape(tensor, rank, shape)) {
        print_shape(tensor->rank, tensor->shape, has);
        print_shape(rank, shape, wanted);
        host_fail(host, FAIL_FORMAT,
                  "cannot use the bake: tensor %s is %s %s, not %s %s; bake again", name,
                  tensor_type_name(tensor->type), has, tensor_type_name(type), wanted);
        return NULL;
    }
    if (!tensor_is_finite(tensor)) {
        host_fail(host, FAIL_FORMAT,
                  "cannot use the bake: tensor %s has values that are not finite; bake again",
                  name);
        return NULL;
    }
    return tensor->data;
}

struct hash128 tensors_content(const struct tensors *set)
{
    struct hash128 hash = { 0 };
    for (size_t i = 0; i < set->metadata_count; i++) {
        if (strcmp(set->metadata[i].key, TENSORS_CONTENT) == 0) continue;
        hash = hash128_add_text(hash, set->metadata[i].key);
        hash = hash128_add_text(hash, set->metadata[i].value);
    }
    // By element size, as in the file.
    for (size_t size = 4; size > 0; size /= 2)
        for (size_t i = 0; i < set->count; i++) {
            const struct tensor *at = &set->at[i];
            if (tensor_type_bytes(at->type) != size) continue;
            hash = hash128_add_text(hash, at->name);
            hash = hash128_add_text(hash, tensor_type_name(at->type));
            hash = hash128_add(hash, at->shape, (size_t)at->rank * sizeof at->shape[0]);
            hash = hash128_add(hash, at->data, at->bytes);
        }
    return hash;
}

bool tensors_check_content(struct host *host, const char *path, const struct tensors *set)
{
    char text[HASH128_TEXT];
    const char *written = tensors_metadata(set, TENSORS_CONTENT);
    hash128_print(tensors_content(set), text);
    return (written && strcmp(written, text) == 0) ||
           host_fail(host, FAIL_FORMAT,
                     "cannot use %s: it is damaged: its content differs from its checksum", path);
}
