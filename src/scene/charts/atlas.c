// A row of places is tested by 64 at a time: places that a run of set bits would need are the
// row's bits, shifted by all offsets of the run. Large charts are placed on a grid of squares.
#include "scene/charts/atlas.h"

#include <string.h>

bool atlas_init(struct atlas *out, struct host *host, uint32_t width, uint32_t height)
{
    bool ok = true;
    *out = (struct atlas){ .host = host, .width = width, .height = height };
    for (uint32_t l = 0; l < ATLAS_LEVELS; l++) {
        struct atlas_level *level = &out->level[l];
        level->columns = width >> l;
        level->rows = height >> l;
        level->words = level->columns / 64 + 1;
        level->bits = host_alloc(host, (size_t)(level->rows + 1) * level->words, sizeof(uint64_t));
        ok = ok && level->bits;
    }
    out->blocked = host_alloc(host, out->level[0].words, sizeof *out->blocked);
    out->row = host_alloc(host, out->level[0].words, sizeof *out->row);
    out->any = host_alloc(host, out->level[0].words, sizeof *out->any);
    if (ok && out->blocked && out->row && out->any) return true;
    atlas_finish(out);
    return false;
}

void atlas_finish(struct atlas *atlas)
{
    if (!atlas->host) return;
    for (uint32_t l = 0; l < ATLAS_LEVELS; l++) host_free(atlas->host, atlas->level[l].bits);
    host_free(atlas->host, atlas->blocked);
    host_free(atlas->host, atlas->row);
    host_free(atlas->host, atlas->any);
    *atlas = (struct atlas){ 0 };
}

void atlas_copy(struct atlas *to, const struct atlas *from)
{
    for (uint32_t l = 0; l < ATLAS_LEVELS; l++) {
        const struct atlas_level *level = &from->level[l];
        memcpy(to->level[l].bits, level->bits,
               (size_t)(level->rows + 1) * level->words * sizeof *level->bits);
        memcpy(to->level[l].lowest, level->lowest, sizeof level->lowest);
    }
}

// ---- rows

static uint64_t word_at(const uint64_t *bits, uint32_t words, uint32_t word)
{
    return word < words ? bits[word] : 0;
}

// The bits from `by` on, or those and the bits.
static void shift(uint64_t *bits, uint32_t words, uint32_t by, bool keep)
{
    const uint32_t whole = by / 64, part = by % 64;
    for (uint32_t i = 0; i < words; i++) {
        uint64_t shifted = word_at(bits, words, i + whole) >> part;
        if (part > 0) shifted |= word_at(bits, words, i + whole + 1) << (64 - part);
        bits[i] = keep ? bits[i] | shifted : shifted;
    }
}

// Columns at which the bits first … first + count − 1 of equal rows would meet a taken one.
static void block_run(struct atlas *atlas, uint32_t words, uint32_t first, uint32_t count)
{
    uint32_t covered = 1;
    memcpy(atlas->row, atlas->any, words * sizeof *atlas->any);
    if (first > 0) shift(atlas->row, words, first, false);
    for (; 2 * covered <= count; covered *= 2) shift(atlas->row, words, covered, true);
    if (covered < count) shift(atlas->row, words, count - covered, true);
    for (uint32_t i = 0; i < words; i++) atlas->blocked[i] |= atlas->row[i];
}

static bool bit_at(const uint64_t *bits, uint32_t x)
{
    return bits[x / 64] >> x % 64 & 1;
}

// Rows first … end − 1 of the footprint, which are equal.
static void block_rows(struct atlas *atlas, const uint64_t *taken, uint32_t words,
                       const struct footprint *f, uint32_t first, uint32_t end)
{
    memcpy(atlas->any, taken, words * sizeof *taken);
    for (uint32_t row = first + 1; row < end; row++) {
        taken += words;
        for (uint32_t i = 0; i < words; i++) atlas->any[i] |= taken[i];
    }
    for (uint32_t x = 0; x < f->width;) {
        uint32_t last = x;
        while (last < f->width && bit_at(f->bits[first], last)) last++;
        if (last > x) block_run(atlas, words, x, last - x);
        x = last + 1;
    }
}

static bool is_equal_row(const struct footprint *f, uint32_t a, uint32_t b)
{
    for (int i = 0; i < FOOTPRINT_WORDS; i++)
        if (f->bits[a][i] != f->bits[b][i]) return false;
    return true;
}

// The first column at which the footprint is free in row y. False: none.
static bool find_in_row(struct atlas *atlas, const struct atlas_level *level,
                        const struct footprint *f, uint32_t y, uint32_t *x)
{
    const uint32_t words = level->words;
    if (f->width > level->columns) return false;
    memset(atlas->blocked, 0, words * sizeof *atlas->blocked);
    for (uint32_t row = 0, end; row < f->height; row = end) {
        for (end = row + 1; end < f->height && is_equal_row(f, row, end);) end++;
        block_rows(atlas, &level->bits[(size_t)(y + row) * words], words, f, row, end);
    }
    for (uint32_t i = 0; i < words; i++) {
        if (atlas->blocked[i] == UINT64_MAX) continue;
        *x = 64 * i + (uint32_t)__builtin_ctzll(~atlas->blocked[i]);
        return *x + f->width <= level->columns;
    }
    return false;
}

// ---- squares

static struct footprint square_of(uint32_t edge)
{
    struct footprint square = { .width = edge, .height = edge };
    for (uint32_t y = 0; y < edge; y++)
        for (uint32_t x = 0; x < edge; x++) square.bits[y][x / 64] |= (uint64_t)1 << x % 64;
    return square;
}

// No footprint that contains the square is free below this row: places are taken, never freed.
static uint32_t lowest_row(struct atlas *atlas, struct atlas_level *level, uint32_t edge)
{
    const struct footprint square = square_of(edge);
    uint32_t *lowest = &level->lowest[edge], x;
    for (; *lowest + edge <= level->rows; ++*lowest)
        if (find_in_row(atlas, level, &square, *lowest, &x)) break;
    return *lowest;
}

// ---- places

void atlas_find(struct atlas *atlas, const struct footprint_grid *grid, uint32_t turns,
                struct atlas_place *best)
{
    const uint32_t l = footprint_level(grid);
    struct atlas_level *level = &atlas->level[l];
    struct footprint f;
    footprint_make(&f, grid, turns, l);
    const uint32_t low = lowest_row(atlas, level, f.square);
    for (uint32_t y = low > f.square_y ? low - f.square_y : 0; y + f.height <= level->rows; y++) {
        uint32_t x;
        if ((y + f.height) << l >= best->top) return;
        if (!find_in_row(atlas, level, &f, y, &x)) continue;
        *best = (struct atlas_place){ x << l, y << l, turns, (y + f.height) << l };
        return;
    }
}

static void take(struct atlas *atlas, uint32_t x, uint32_t y)
{
    for (uint32_t l = 0; l < ATLAS_LEVELS; l++) {
        struct atlas_level *level = &atlas->level[l];
        const uint32_t column = x >> l, row = y >> l;
        level->bits[(size_t)row * level->words + column / 64] |= (uint64_t)1 << column % 64;
    }
}

void atlas_take(struct atlas *atlas, const struct footprint_grid *grid,
                const struct atlas_place *place)
{
    const bool across = place->turns % 2 == 1;
    const uint32_t width = across ? grid->height : grid->width;
    const uint32_t height = across ? grid->width : grid->height;
    for (uint32_t y = 0; y < height; y++)
        for (uint32_t x = 0; x < width; x++)
            if (footprint_takes(grid, place->turns, x, y)) take(atlas, place->x + x, place->y + y);
}
