#include "techniques/ort/slices.h"

// The first or last rows of a slice that are occupied.
static bool crop_rows(const struct ort_cover *cover, struct ort_box *slice)
{
    struct ort_box box = *slice;
    if (!ort_cover_crop(cover, &box)) return false;
    slice->from[ORT_Y] = box.from[ORT_Y];
    slice->to[ORT_Y] = box.to[ORT_Y];
    return true;
}

static bool add_slice(struct ort_pieces *pieces, const struct ort_cover *cover, uint32_t map,
                      struct ort_box slice)
{
    const uint32_t bottom = slice.to[ORT_Y];
    while (crop_rows(cover, &slice)) {
        const uint32_t top = slice.from[ORT_Y];
        if (slice.to[ORT_Y] - top > ORT_BIN_SIDE) {
            slice.to[ORT_Y] = top + ORT_BIN_SIDE;
            crop_rows(cover, &slice);
        }
        const struct ort_piece piece = { .map = map,
                                         .x = slice.from[ORT_X] * ORT_RUN,
                                         .y = slice.from[ORT_Y],
                                         .width = (slice.to[ORT_X] - slice.from[ORT_X]) * ORT_RUN,
                                         .height = slice.to[ORT_Y] - slice.from[ORT_Y] };
        if (!ort_pieces_add(pieces, piece)) return false;
        slice.from[ORT_Y] = slice.to[ORT_Y];
        slice.to[ORT_Y] = bottom;
    }
    return true;
}

bool ort_slices_add(struct ort_pieces *pieces, const struct ort_cover *cover, uint32_t map,
                    const struct ort_box *box)
{
    struct ort_box slice = *box;
    uint32_t width = ORT_BIN_SIDE / ORT_RUN;
    while (slice.from[ORT_X] < box->to[ORT_X]) {
        while (width > box->to[ORT_X] - slice.from[ORT_X]) width /= 2;
        slice.to[ORT_X] = slice.from[ORT_X] + width;
        if (!add_slice(pieces, cover, map, slice)) return false;
        slice.from[ORT_X] = slice.to[ORT_X];
    }
    return true;
}
