#include "techniques/ort/pieces.h"

#include "core/host.h"

static bool grow(struct ort_pieces *pieces)
{
    if (pieces->count > UINT32_MAX / 2 - 64)
        return host_fail(pieces->host, FAIL_MEMORY, "bins: more than %u pieces of transfer maps",
                         pieces->count);
    const uint32_t capacity = 2 * pieces->count + 64;
    struct ort_piece *at = host_realloc(pieces->host, pieces->at, capacity, sizeof *at);
    if (!at) return false;
    pieces->at = at;
    pieces->capacity = capacity;
    return true;
}

bool ort_pieces_add(struct ort_pieces *pieces, struct ort_piece piece)
{
    if (pieces->count == pieces->capacity && !grow(pieces)) return false;
    pieces->at[pieces->count++] = piece;
    return true;
}
