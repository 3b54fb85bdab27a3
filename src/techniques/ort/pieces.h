// The growing list of pieces.
#pragma once

#include "techniques/ort/bins.h"

struct ort_pieces {
    struct host *host;
    struct ort_piece *at;
    uint32_t count, capacity;
};

bool ort_pieces_add(struct ort_pieces *pieces, struct ort_piece piece);
