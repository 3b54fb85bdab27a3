// XXH3, whose output is fixed since xxHash 0.8.0 and the same on every machine.
#include "core/hash.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

#define XXH_INLINE_ALL // no library to link
#include <xxhash.h>

uint64_t hash_bytes(const void *data, size_t size, uint64_t seed)
{
    return XXH3_64bits_withSeed(data, size, seed);
}

// XXH3-128 of (the hash before, that of the piece, its size).
struct hash128 hash128_add(struct hash128 before, const void *data, size_t size)
{
    const XXH128_hash_t piece = XXH3_128bits(data, size);
    const uint64_t words[5] = { before.high, before.low, piece.high64, piece.low64, size };
    const XXH128_hash_t all = XXH3_128bits(words, sizeof words);
    return (struct hash128){ all.high64, all.low64 };
}

struct hash128 hash128_add_text(struct hash128 before, const char *text)
{
    return hash128_add(before, text, strlen(text));
}

void hash128_print(struct hash128 hash, char out[HASH128_TEXT])
{
    snprintf(out, HASH128_TEXT, "%016" PRIx64 "%016" PRIx64, hash.high, hash.low);
}
