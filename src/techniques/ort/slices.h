// Vertical slices of boxes: pieces that fit into bins.
#pragma once

#include "techniques/ort/cover.h"
#include "techniques/ort/pieces.h"

// Cuts a box of the map that the cover has now into slices of power-of-two widths and adds them.
// Each is cropped again in y, and none is higher than a bin.
bool ort_slices_add(struct ort_pieces *pieces, const struct ort_cover *cover, uint32_t map,
                    const struct ort_box *box);
