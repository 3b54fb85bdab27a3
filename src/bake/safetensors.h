// safetensors files: eight bytes with the header's length, a JSON header with name, type, shape and
// offsets of every tensor, then the little-endian arrays.
// (https://github.com/huggingface/safetensors, format version 1)
#pragma once

#include "bake/tensors.h"

enum { SAFETENSORS_MAX_HEADER = 16 << 20 };

// Writes beside `path` and renames. Tensors are stored by element size, the largest first, then in
// the order of the set, so that each one is aligned. FAIL_ARGUMENT for a name twice or invalid
// UTF-8.
bool safetensors_write(struct host *host, const char *path, const struct tensors *set);

struct safetensors {
    struct tensors set;
    void *memory; // private
};
// Reads a file as untrusted input: the header is at most 16 MiB of valid JSON with known types,
// offsets are contiguous, in order and end with the file, every extent is that of its shape, names
// are unique, data is aligned. Otherwise FAIL_FORMAT with one sentence; nothing is allocated beyond
// a small multiple of the file's size. Free with safetensors_finish, which accepts zero.
bool safetensors_read(struct host *host, const char *path, struct safetensors *out);
void safetensors_finish(struct host *host, struct safetensors *file);
