// Pieces in the order of a gather.
#pragma once

#include "techniques/ort/cover.h"
#include "techniques/ort/pieces.h"

// Adds the tiles of a map that are not empty.
bool ort_tiles_add(struct ort_pieces *pieces, const struct ort_cover *cover, uint32_t map,
                   uint32_t rows);
// Sorts and places them; returns the number of bins.
uint32_t ort_tiles_pack(struct ort_pieces *pieces, uint32_t rows);
