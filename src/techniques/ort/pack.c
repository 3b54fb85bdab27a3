// Sunshine-Hill & Faloutsos 2006, section 5.2. Areas of a bin have power-of-two widths, as pieces
// have, and are filled from the top down: the packing is one-dimensional.
//
// The paper leaves the order open. Here widths descend. An area is halved only when no piece has
// its width; then no piece is wider either, and no area is ever too narrow. Pieces are cut where an
// area ends, and a new bin begins only when all areas are full. Only the last bin has empty areas,
// at most one of each width, and the number of bins is the least possible.
//
// Pieces of equal width follow each other by their column in the maps: a shader reads all pieces of
// a column together, and finds them in few parts of memory.
#include "techniques/ort/pack.h"

#include "core/host.h"

#include <stdlib.h>

enum { WIDTHS = 8 };
_Static_assert(ORT_RUN << (WIDTHS - 1) == ORT_BIN_SIDE, "a width for each power of two");

// From y to the bottom of a bin; ORT_RUN << level texels wide.
struct area {
    uint32_t bin, x, y, level;
};

// Areas of a bin have different levels, but for two halves of the narrowest one.
enum { MOST_AREAS = WIDTHS + 1 };

struct packing {
    struct ort_pieces *pieces;
    // Lists of pieces without a place, of equal level and height: 1 + a piece; 0: the end.
    uint32_t first[WIDTHS][ORT_BIN_SIDE + 1];
    uint32_t *next; // [next_capacity]
    uint32_t next_capacity;
    uint32_t highest[WIDTHS];      // no piece in the lists of a level is higher
    struct area areas[MOST_AREAS]; // a stack, the widest first
    uint32_t area_count;
    uint32_t bins, cuts;
};

// ---- pieces without a place, by level and height

static uint32_t level_of(uint32_t width)
{
    uint32_t level = 0;
    while ((uint32_t)ORT_RUN << level < width) level++;
    return level;
}

static bool add_piece(struct packing *p, uint32_t piece)
{
    if (piece >= p->next_capacity) {
        uint32_t *next = host_realloc(p->pieces->host, p->next, p->pieces->capacity, sizeof *next);
        if (!next) return false;
        p->next = next;
        p->next_capacity = p->pieces->capacity;
    }
    const uint32_t level = level_of(p->pieces->at[piece].width);
    const uint32_t height = p->pieces->at[piece].height;
    p->next[piece] = p->first[level][height];
    p->first[level][height] = piece + 1;
    if (height > p->highest[level]) p->highest[level] = height;
    return true;
}

static bool has_pieces(struct packing *p, uint32_t level)
{
    uint32_t *highest = &p->highest[level];
    while (*highest > 0 && !p->first[level][*highest]) --*highest;
    return *highest > 0;
}

// Removes the highest piece of a level that is at most as high as an area. false: there is none.
static bool pop_piece(struct packing *p, uint32_t level, uint32_t most, uint32_t *piece)
{
    uint32_t height = p->highest[level] < most ? p->highest[level] : most;
    while (height > 0 && !p->first[level][height]) height--;
    if (height == 0) return false;
    *piece = p->first[level][height] - 1;
    p->first[level][height] = p->next[*piece];
    return true;
}

// ---- areas

// Removes the narrowest area, and halves it until it has the width of a level. The other halves
// stay. A bin begins when there is no area.
static struct area pop_area(struct packing *p, uint32_t level)
{
    if (p->area_count == 0)
        p->areas[p->area_count++] = (struct area){ .bin = p->bins++, .level = WIDTHS - 1 };
    struct area area = p->areas[--p->area_count];
    while (area.level > level) {
        area.level--;
        struct area half = area;
        half.x += (uint32_t)ORT_RUN << area.level;
        p->areas[p->area_count++] = half;
    }
    return area;
}

// Cuts a piece to a height. The rest is another piece, without a place.
static bool cut_piece(struct packing *p, uint32_t piece, uint32_t height)
{
    struct ort_piece rest = p->pieces->at[piece];
    rest.y += height;
    rest.height -= height;
    p->pieces->at[piece].height = height;
    p->cuts++;
    return ort_pieces_add(p->pieces, rest) && add_piece(p, p->pieces->count - 1);
}

// Finds the piece for an area of a height: the best fit, else the highest one, which is cut.
static bool choose_piece(struct packing *p, uint32_t level, uint32_t height, uint32_t *piece)
{
    if (pop_piece(p, level, height, piece)) return true;
    return pop_piece(p, level, ORT_BIN_SIDE, piece) && cut_piece(p, *piece, height);
}

// Packs all pieces in the lists of a level.
static bool pack_level(struct packing *p, uint32_t level)
{
    while (has_pieces(p, level)) {
        uint32_t piece = 0;
        struct area area = pop_area(p, level);
        if (!choose_piece(p, level, ORT_BIN_SIDE - area.y, &piece)) return false;
        struct ort_piece *at = &p->pieces->at[piece];
        at->bin = area.bin;
        at->bin_x = area.x;
        at->bin_y = area.y;
        area.y += at->height;
        if (area.y < ORT_BIN_SIDE) p->areas[p->area_count++] = area;
    }
    return true;
}

static int compare_columns(const void *a, const void *b)
{
    const struct ort_piece *p = a, *q = b;
    if (p->width != q->width) return p->width > q->width ? -1 : 1;
    if (p->x != q->x) return p->x < q->x ? -1 : 1;
    if (p->map != q->map) return p->map < q->map ? -1 : 1;
    return p->y < q->y ? -1 : p->y > q->y;
}

static int compare_places(const void *a, const void *b)
{
    const struct ort_piece *p = a, *q = b;
    if (p->bin != q->bin) return p->bin < q->bin ? -1 : 1;
    if (p->bin_x != q->bin_x) return p->bin_x < q->bin_x ? -1 : 1;
    return p->bin_y < q->bin_y ? -1 : p->bin_y > q->bin_y;
}

// Pieces of equal width and column, which are sorted, from `first` on. Returns their end.
static uint32_t add_column(struct packing *p, uint32_t first, uint32_t count, bool *ok)
{
    const struct ort_piece column = p->pieces->at[first];
    uint32_t i = first;
    for (; *ok && i < count; i++) {
        const struct ort_piece *piece = &p->pieces->at[i];
        if (piece->width != column.width || piece->x != column.x) break;
        *ok = add_piece(p, i);
    }
    return i;
}

static bool pack_all(struct packing *p)
{
    const uint32_t count = p->pieces->count; // rests of cut pieces come behind
    bool ok = true;
    for (uint32_t i = 0; ok && i < count;) {
        const uint32_t level = level_of(p->pieces->at[i].width);
        i = add_column(p, i, count, &ok);
        ok = ok && pack_level(p, level);
    }
    return ok;
}

static void sort(struct ort_pieces *pieces, int (*compare)(const void *, const void *))
{
    if (pieces->count > 0) // else qsort gets NULL
        qsort(pieces->at, pieces->count, sizeof *pieces->at, compare);
}

bool ort_pack(struct ort_pieces *pieces, uint32_t *bin_count, uint32_t *cuts)
{
    struct packing *p = host_alloc(pieces->host, 1, sizeof *p);
    bool ok = p;
    if (p) {
        p->pieces = pieces;
        sort(pieces, compare_columns);
        ok = pack_all(p);
    }
    if (ok) {
        sort(pieces, compare_places);
        *bin_count = p->bins;
        *cuts = p->cuts;
    }
    if (p) host_free(pieces->host, p->next);
    host_free(pieces->host, p);
    return ok;
}
