#include "techniques/ort/tiles.h"

#include <stdlib.h>

bool ort_tiles_add(struct ort_pieces *pieces, const struct ort_cover *cover, uint32_t map,
                   uint32_t rows)
{
    for (uint32_t run = 0; run < cover->runs; run++)
        for (uint32_t y = 0; y < cover->height; y += rows) {
            const uint32_t end = cover->height - y < rows ? cover->height : y + rows;
            if (ort_cover_count(cover, &(struct ort_box){ { run, y }, { run + 1, end } }) == 0)
                continue;
            const struct ort_piece tile = {
                .map = map, .x = run * ORT_RUN, .y = y, .width = ORT_RUN, .height = end - y
            };
            if (!ort_pieces_add(pieces, tile)) return false;
        }
    return true;
}

static int compare(const void *a, const void *b)
{
    const struct ort_piece *p = a, *q = b;
    if (p->x != q->x) return p->x < q->x ? -1 : 1;
    if (p->y != q->y) return p->y < q->y ? -1 : 1;
    return p->map < q->map ? -1 : p->map > q->map;
}

uint32_t ort_tiles_pack(struct ort_pieces *pieces, uint32_t rows)
{
    const uint32_t in_column = ORT_BIN_SIDE / rows, in_bin = in_column * (ORT_BIN_SIDE / ORT_RUN);
    if (pieces->count > 0) // else qsort gets NULL
        qsort(pieces->at, pieces->count, sizeof *pieces->at, compare);
    for (uint32_t i = 0; i < pieces->count; i++) {
        struct ort_piece *tile = &pieces->at[i];
        tile->bin = i / in_bin;
        tile->bin_x = i % in_bin / in_column * ORT_RUN;
        tile->bin_y = i % in_column * rows;
    }
    return (pieces->count + in_bin - 1) / in_bin;
}
