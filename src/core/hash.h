// Content hashes (xxHash, 64 bits), for caches and for tests of reproducibility.
#pragma once

#include <stddef.h>
#include <stdint.h>

uint64_t hash_bytes(const void *data, size_t size, uint64_t seed);
