// Content hashes (XXH3, 64 bits), for cache keys and reproducibility tests.
#pragma once

#include <stddef.h>
#include <stdint.h>

uint64_t hash_bytes(const void *data, size_t size, uint64_t seed);
