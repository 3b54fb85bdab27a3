// Lists of pieces for the workgroups of the gather, sorted by part and workgroup.
#include "techniques/ort/bins.h"
#include "techniques/ort/ort_state.h"

#include "core/half.h"

struct entry {
    uint32_t row;    // scale as a half << 16 | row in the bin less that in the map, 16 bits
    uint32_t column; // bin << 16 | level << 12 | column of runs in the bin
    uint32_t rows;   // rows << 16 | first row
    uint32_t offset; // y << 16 | x
};

struct list {
    uint32_t first, count;
};

struct lists {
    const struct ort *state;
    const struct ort_maps *maps;
    const struct ort_bins *bins;
    const float *scale;
    struct list *lists; // [parts][columns][blocks]
    struct entry *entries;
};

static struct entry entry_of(const struct lists *l, const struct ort_piece *p, uint32_t column)
{
    const int32_t *offset = l->maps->offset + 2 * (size_t)p->map;
    const uint32_t in_bin = p->bin_x / ORT_RUN + column - p->x / ORT_RUN;
    return (struct entry){ (uint32_t)half_from_float(l->scale[p->map]) << 16 |
                               ((p->bin_y - p->y) & 0xffffu),
                           p->bin << 16 | (uint32_t)l->maps->level[p->map] << 12 | in_bin,
                           p->height << 16 | p->y,
                           (uint32_t)offset[1] << 16 | ((uint32_t)offset[0] & 0xffffu) };
}

// Counts the pieces of each list, or writes them where there are entries.
static void add_piece(struct lists *l, const struct ort_piece *p)
{
    const struct ort_map *map = &l->state->map;
    const uint32_t columns = ort_columns(map), blocks = ort_blocks(l->state);
    const uint32_t parts = (uint32_t)l->state->options.parts;
    const uint32_t part = (uint32_t)((uint64_t)p->bin * parts / l->bins->bin_count);
    const uint32_t rows = l->state->rows, end = (p->x + p->width) / ORT_RUN;
    for (uint32_t column = p->x / ORT_RUN; column < end && column < columns; column++)
        for (uint32_t b = p->y / rows; b <= (p->y + p->height - 1) / rows; b++) {
            struct list *list = &l->lists[((size_t)part * columns + column) * blocks + b];
            if (l->entries) l->entries[list->first + list->count] = entry_of(l, p, column);
            list->count++;
        }
}

static void add_pieces(struct lists *l)
{
    for (uint32_t i = 0; i < l->bins->piece_count; i++) add_piece(l, &l->bins->pieces[i]);
}

static size_t start_lists(struct lists *l, size_t count)
{
    size_t entries = 0;
    for (size_t i = 0; i < count; i++) {
        l->lists[i].first = (uint32_t)entries;
        entries += l->lists[i].count;
        l->lists[i].count = 0;
    }
    return entries;
}

bool ort_upload_lists(struct ort *s, const struct ort_maps *maps, const struct ort_bins *bins,
                      const float *scale)
{
    const size_t count = (size_t)s->options.parts * ort_columns(&s->map) * ort_blocks(s);
    struct lists l = { s,
                       maps,
                       bins,
                       scale,
                       host_alloc(s->host, light_map_table_capacity(count), sizeof *l.lists),
                       NULL };
    size_t entries = 0;
    if (l.lists) {
        add_pieces(&l);
        entries = start_lists(&l, count);
        l.entries = host_alloc(s->host, light_map_table_capacity(entries), sizeof *l.entries);
    }
    if (l.entries) add_pieces(&l);
    const bool ok = light_map_table_upload(s->host, s->gpu, "entries", GPU_RGBA32U, l.entries,
                                           entries, &s->tables.entries);
    return light_map_table_upload(s->host, s->gpu, "lists", GPU_RG32U, l.lists, count,
                                  &s->tables.lists) &&
           ok;
}
