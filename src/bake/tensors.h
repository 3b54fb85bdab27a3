// A set of named arrays with metadata: the content of a bake, in memory or read from a file.
#pragma once

#include "core/hash.h"
#include "core/host.h"

#include <stdint.h>

enum tensor_type {
    TENSOR_F32,
    TENSOR_F16,
    TENSOR_U8,
    TENSOR_U16,
    TENSOR_U32,
    TENSOR_I32,
    TENSOR_F64
};
enum { TENSOR_TYPE_COUNT = TENSOR_F64 + 1, TENSOR_MAX_RANK = 8 };

struct tensor {
    const char *name; // a path: "cube/1/U_b"
    enum tensor_type type;
    int rank;                        // 0: one element
    uint64_t shape[TENSOR_MAX_RANK]; // the last axis is contiguous
    const void *data;                // little-endian, aligned for its type
    size_t bytes;                    // product of the shape times the size of an element
};

struct tensor_metadata {
    const char *key, *value;
};

struct tensors {
    const struct tensor *at;
    size_t count;
    const struct tensor_metadata *metadata;
    size_t metadata_count;
};

const char *tensor_type_name(enum tensor_type type); // as in a file: "F32"
size_t tensor_type_bytes(enum tensor_type type);
// Product of the shape times the element's size; false on overflow.
bool tensor_extent(enum tensor_type type, int rank, const uint64_t *shape, size_t *out);
// Floats: has no NaN and no infinity. Other types are always finite.
bool tensor_is_finite(const struct tensor *tensor);

bool tensor_is_same(const struct tensor *a, const struct tensor *b); // type and shape; NULL: no

// NULL: none.
const struct tensor *tensors_find(const struct tensors *set, const char *name);
const char *tensors_metadata(const struct tensors *set, const char *key);
// The data of a tensor that must have this type and shape, and finite values. NULL: host_fail names
// the tensor and the difference. For `load` of a technique.
const void *tensors_expect(struct host *host, const struct tensors *set, const char *name,
                           enum tensor_type type, int rank, const uint64_t *shape);
// Its shape is the last arguments.
#define TENSORS_EXPECT(host, set, name, type, ...)                                                 \
    tensors_expect(host, set, name, type, sizeof((const uint64_t[]){ __VA_ARGS__ }) / 8,           \
                   (const uint64_t[]){ __VA_ARGS__ })

// ---- a checksum in the metadata of a file

#define TENSORS_CONTENT "afterglow.content"
// The hash of all arrays and metadata but that entry.
struct hash128 tensors_content(const struct tensors *set);
// FAIL_FORMAT: the entry differs from the content; `path` is for the message.
bool tensors_check_content(struct host *host, const char *path, const struct tensors *set);
