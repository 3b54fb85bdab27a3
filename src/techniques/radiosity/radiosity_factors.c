// Form factors on the GPU, in tiles of rows. The entries of a tile are one after another, those of
// its rows side by side: invocations of neighbouring rows read neighbouring words, and a processor
// reads them in the order of memory.
#include "techniques/radiosity/radiosity_state.h"

#include <stdlib.h>

// Texels of a block's table: 256 MB. Rows are put in order within windows.
enum { BLOCK_TEXELS = 1 << 24, TEXEL_WORDS = 4, WINDOW = 64 * RADIOSITY_TILE };

// Rows to upload. pack: writes the words of an entry.
struct source_rows {
    const char *name;
    const uint32_t *source; // of entries; NULL: their numbers in the row
    const uint16_t *factor;
    const uint32_t *first;    // [rows + 1] entries of rows; NULL: each has `sources`
    const uint32_t *base;     // [rows] of the sources; NULL: 0
    size_t sources, in_texel; // entries of a row at most, of a texel
    size_t stride;            // halves of an entry
    uint32_t rows;
    void (*pack)(const struct source_rows *from, size_t entry, uint32_t *words);
};

static uint32_t pack(uint32_t node, uint16_t factor)
{
    return node | (uint32_t)factor << RADIOSITY_NODE_BITS;
}

static void pack_texel(const struct source_rows *from, size_t entry, uint32_t *words)
{
    const uint16_t *factor = from->factor + 3 * entry;
    words[0] = pack((uint32_t)(entry % from->sources), factor[0]);
    words[1] = factor[1] | (uint32_t)factor[2] << 16;
}

static void pack_source(const struct source_rows *from, size_t entry, uint32_t *words)
{
    words[0] = pack(from->source[entry], from->factor[entry]);
}

// ---- the order of rows

struct row {
    uint32_t index, entries;
};

struct tile {
    uint32_t first, texels; // in the table of its block; of a row
};

struct layout {
    struct row *rows; // [tiles][RADIOSITY_TILE], beyond the last one without entries
    struct tile *tiles;
    uint32_t tile_count;
};

static size_t first_entry(const struct source_rows *from, size_t row)
{
    return from->first ? from->first[row] : row * from->sources;
}

static uint32_t entries_of(const struct source_rows *from, size_t row)
{
    size_t count = from->sources;
    if (from->first) return from->first[row + 1] - from->first[row];
    while (count > 0 && from->factor[(row * from->sources + count - 1) * from->stride] == 0)
        count--;
    return (uint32_t)count;
}

static int by_entries(const void *a, const void *b)
{
    const struct row *p = a, *q = b;
    if (p->entries != q->entries) return p->entries > q->entries ? -1 : 1;
    return p->index < q->index ? -1 : p->index > q->index;
}

static void order_rows(const struct source_rows *from, struct row *rows)
{
    for (uint32_t i = 0; i < from->rows; i++) rows[i] = (struct row){ i, entries_of(from, i) };
    for (uint32_t i = 0; i < from->rows; i += WINDOW)
        qsort(rows + i, from->rows - i < WINDOW ? from->rows - i : WINDOW, sizeof *rows,
              by_entries);
}

static bool layout_init(struct layout *out, struct radiosity *s, const struct source_rows *from)
{
    out->tile_count = (from->rows + RADIOSITY_TILE - 1) / RADIOSITY_TILE;
    out->rows = host_alloc(s->host, (size_t)out->tile_count * RADIOSITY_TILE, sizeof *out->rows);
    out->tiles = host_alloc(s->host, light_map_table_capacity(out->tile_count), sizeof *out->tiles);
    if (!out->rows || !out->tiles) return false;
    order_rows(from, out->rows);
    return true;
}

static const struct row *rows_of(const struct layout *l, size_t tile)
{
    return &l->rows[tile * RADIOSITY_TILE];
}

// ---- blocks

static void pack_row(const struct source_rows *from, const struct row *row, uint32_t *words)
{
    const size_t entry_words = TEXEL_WORDS / from->in_texel;
    for (size_t k = 0; k < row->entries; k++) {
        const size_t texel = k / from->in_texel * RADIOSITY_TILE;
        from->pack(from, first_entry(from, row->index) + k,
                   words + TEXEL_WORDS * texel + k % from->in_texel * entry_words);
    }
}

static uint32_t texels_of(const struct source_rows *from, const struct layout *l, size_t tile)
{
    uint32_t most = 0;
    for (size_t r = 0; r < RADIOSITY_TILE; r++) {
        const uint32_t entries = rows_of(l, tile)[r].entries;
        most = entries > most ? entries : most;
    }
    return (most + (uint32_t)from->in_texel - 1) / (uint32_t)from->in_texel;
}

// The tiles of a block from the first one on; returns its texels.
static size_t find_block(const struct source_rows *from, struct layout *l, uint32_t first,
                         uint32_t *end)
{
    size_t texels = 0;
    for (*end = first; *end < l->tile_count; ++*end) {
        const uint32_t row = texels_of(from, l, *end);
        if (*end > first && texels + row * RADIOSITY_TILE > BLOCK_TEXELS) break;
        l->tiles[*end] = (struct tile){ (uint32_t)texels, row };
        texels += row * RADIOSITY_TILE;
    }
    return texels;
}

static bool upload_block(struct radiosity *s, const struct source_rows *from, struct layout *l,
                         uint32_t first, struct radiosity_block *block)
{
    uint32_t end;
    const size_t texels = find_block(from, l, first, &end);
    uint32_t *words =
        host_alloc(s->host, light_map_table_capacity(texels), TEXEL_WORDS * sizeof *words);
    for (uint32_t t = first; words && t < end; t++)
        for (uint32_t r = 0; r < RADIOSITY_TILE; r++)
            pack_row(from, &rows_of(l, t)[r], words + TEXEL_WORDS * (l->tiles[t].first + r));
    block->first = first * RADIOSITY_TILE;
    block->count = end < l->tile_count ? (end - first) * RADIOSITY_TILE : from->rows - block->first;
    return light_map_table_upload(s->host, s->gpu, from->name, GPU_RGBA32U, words, texels,
                                  &block->table);
}

static bool upload_blocks(struct radiosity *s, const struct source_rows *from, struct layout *l,
                          struct radiosity_rows *out)
{
    const size_t row = (from->sources + from->in_texel - 1) / from->in_texel;
    const size_t most = from->rows * row / (BLOCK_TEXELS - row * RADIOSITY_TILE) + 2;
    out->blocks = host_alloc(s->host, most, sizeof *out->blocks);
    bool ok = out->blocks != NULL;
    for (uint32_t first = 0; ok && first < from->rows;) {
        struct radiosity_block *block = &out->blocks[out->count++];
        ok = upload_block(s, from, l, first / RADIOSITY_TILE, block);
        first += block->count;
    }
    return ok;
}

static bool upload_order(struct radiosity *s, const struct source_rows *from,
                         const struct layout *l, gpu_image *out)
{
    const size_t words = from->base ? 2 : 1;
    uint32_t *order =
        host_alloc(s->host, light_map_table_capacity(from->rows), words * sizeof *order);
    for (size_t i = 0; order && i < from->rows; i++) {
        order[words * i] = l->rows[i].index;
        if (from->base) order[words * i + 1] = from->base[l->rows[i].index];
    }
    return light_map_table_upload(s->host, s->gpu, "order", from->base ? GPU_RG32U : GPU_R32U,
                                  order, from->rows, out);
}

static float mean_entries(const struct source_rows *from, const struct layout *l)
{
    double sum = 0.0;
    for (size_t i = 0; i < from->rows; i++) sum += l->rows[i].entries;
    return (float)(sum / from->rows);
}

static bool upload_rows(struct radiosity *s, const struct source_rows *from,
                        struct radiosity_rows *out)
{
    struct layout l = { 0 };
    bool ok = layout_init(&l, s, from) && upload_blocks(s, from, &l, out) &&
              upload_order(s, from, &l, &out->order);
    if (ok) {
        out->mean_entries = mean_entries(from, &l);
        ok = light_map_table_upload(s->host, s->gpu, "tiles", GPU_RG32U, l.tiles, l.tile_count,
                                    &out->tiles);
        l.tiles = NULL;
    }
    host_free(s->host, l.tiles);
    host_free(s->host, l.rows);
    return ok;
}

bool radiosity_upload_factors(struct radiosity *s, const struct radiosity_sources *from)
{
    const size_t sources = (size_t)s->options.sources;
    const struct source_rows texels = { .name = "factors",
                                        .factor = from->factor,
                                        .base = from->strata->of,
                                        .sources = sources,
                                        .in_texel = RADIOSITY_PAIR,
                                        .stride = 3,
                                        .rows = s->map.texel_count,
                                        .pack = pack_texel };
    const struct source_rows strata = { .name = "shares",
                                        .source = from->strata->node,
                                        .factor = from->strata->share,
                                        .first = from->strata->first,
                                        .sources = from->strata->most,
                                        .in_texel = RADIOSITY_QUAD,
                                        .stride = 1,
                                        .rows = from->strata->count,
                                        .pack = pack_source };
    const struct source_rows clusters = { .name = "cluster_factors",
                                          .source = from->cluster_source,
                                          .factor = from->cluster_factor,
                                          .sources = 2 * sources,
                                          .in_texel = RADIOSITY_QUAD,
                                          .stride = 1,
                                          .rows = s->map.cluster_count,
                                          .pack = pack_source };
    s->stratum_count = from->strata->count;
    return upload_rows(s, &texels, &s->tables.factors) &&
           upload_rows(s, &strata, &s->tables.shares) &&
           upload_rows(s, &clusters, &s->tables.cluster_factors);
}

void radiosity_destroy_rows(struct radiosity *s, struct radiosity_rows *rows)
{
    for (uint32_t i = 0; i < rows->count; i++) gpu_image_destroy(s->gpu, &rows->blocks[i].table);
    host_free(s->host, rows->blocks);
    *rows = (struct radiosity_rows){ 0 };
}
