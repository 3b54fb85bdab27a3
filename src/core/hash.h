// Content hashes (XXH3, 64 and 128 bits), for cache keys and reproducibility tests.
#pragma once

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

uint64_t hash_bytes(const void *data, size_t size, uint64_t seed);

struct hash128 {
    uint64_t high, low;
};
enum { HASH128_TEXT = 33 }; // 32 hexadecimal digits and the zero

// The hash of everything added before (zero: nothing) followed by these bytes. Pieces do not run
// into each other: "ab" + "c" differs from "a" + "bc".
struct hash128 hash128_add(struct hash128 before, const void *data, size_t size);
struct hash128 hash128_add_text(struct hash128 before, const char *text);
static inline bool hash128_same(struct hash128 a, struct hash128 b)
{
    return a.high == b.high && a.low == b.low;
}
void hash128_print(struct hash128 hash, char out[HASH128_TEXT]);
