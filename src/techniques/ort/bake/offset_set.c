#include "techniques/ort/bake/offset_set.h"

#include "core/rng.h"

bool ort_offset_set_init(struct ort_offset_set *out, struct host *host, size_t most)
{
    // At most half full.
    size_t size = 16;
    while (size / 2 < most && size <= SIZE_MAX / 4) size *= 2;
    *out = (struct ort_offset_set){ .host = host, .mask = size - 1 };
    out->keys = host_alloc(host, size, sizeof *out->keys);
    return out->keys != NULL;
}

void ort_offset_set_finish(struct ort_offset_set *set)
{
    if (set->keys) host_free(set->host, set->keys);
    *set = (struct ort_offset_set){ 0 };
}

// Never 0: no offset has the least x.
static uint64_t key_of(struct ort_offset offset)
{
    return (uint64_t)(uint32_t)offset.y << 32 | ((uint32_t)offset.x ^ 0x80000000u);
}

// The place of a key, or the free one where it belongs.
static size_t find(const struct ort_offset_set *set, uint64_t key)
{
    size_t at = (size_t)rng_mix(key) & set->mask;
    while (set->keys[at] != 0 && set->keys[at] != key) at = (at + 1) & set->mask;
    return at;
}

bool ort_offset_set_has(const struct ort_offset_set *set, struct ort_offset offset)
{
    return set->keys[find(set, key_of(offset))] != 0;
}

bool ort_offset_set_add(struct ort_offset_set *set, struct ort_offset offset)
{
    const uint64_t key = key_of(offset);
    uint64_t *at = &set->keys[find(set, key)];
    if (*at == key) return false;
    *at = key;
    return true;
}
