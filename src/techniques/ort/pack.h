// Pieces in bins.
#pragma once

#include "techniques/ort/pieces.h"

// Places all pieces, cuts some into two of less height, and sorts them.
bool ort_pack(struct ort_pieces *pieces, uint32_t *bin_count, uint32_t *cuts);
