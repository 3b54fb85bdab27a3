// Which texels a change reaches. Texels are pooled in cells of space: paths of one texel are too
// few, and a chart may be smaller than the change. Cells of four sizes, each twice the last: small
// ones find shadows at contacts, large ones weak light.
//
// A cell is baked again where its mean has changed by more than the noise of a full bake: by the
// standard error of the mean of BLOCK texels, or by a hundredth where that is more.
#include "lightmap/update/update.h"

#include <math.h>
#include <stdlib.h>

enum { TINY, SMALL, MIDDLE, LARGE, LEVELS };
enum { EDGE = 2, BLOCK = 16 }; // EDGE: of tiny cells, texels
// The noise of a full bake is larger in cells of fewer texels than a block.
static const double LEVEL_THRESHOLD[LEVELS] = { 2.0, 1.5, 1.0, 1.0 };
static const double PART_THRESHOLD = 0.5; // of a middle cell in a large one that has changed
static const double SUSPECT_THRESHOLD = 0.25;
static const double LEAST_CHANGE = 0.01, SIGNIFICANT = 2.0;

// ---- cells

enum { CELL_BITS = 20 };

// The cell of a point; kind: of the surface's direction.
static uint64_t cell_of(const int at[3], unsigned kind)
{
    uint64_t key = kind;
    for (int k = 0; k < 3; k++)
        key = key << CELL_BITS |
              ((uint64_t)(at[k] + (1 << (CELL_BITS - 1))) & ((1u << CELL_BITS) - 1));
    return key;
}

static void place_in_grid(vec3s position, float edge_m, int at[3])
{
    const float most = (float)(1 << (CELL_BITS - 1)) - 2.0f;
    for (int k = 0; k < 3; k++)
        at[k] = (int)fminf(fmaxf(floorf(position.raw[k] / edge_m), -most), most);
}

// The axis of the largest component, and its sign.
static unsigned direction_of(vec3s normal)
{
    int axis = 0;
    for (int k = 1; k < 3; k++)
        if (fabsf(normal.raw[k]) > fabsf(normal.raw[axis])) axis = k;
    return 2u * (unsigned)axis + (normal.raw[axis] < 0.0f);
}

struct member {
    uint64_t cell;
    uint32_t row;
};

static int compare_members(const void *x, const void *y)
{
    const struct member *a = x, *b = y;
    if (a->cell != b->cell) return a->cell < b->cell ? -1 : 1;
    return a->row < b->row ? -1 : a->row > b->row;
}

struct reach {
    const struct charts *charts;
    const struct update_probe *probes;
    uint8_t *again;
    struct member *members; // [side_texel_count]
    double block;           // paths of a block
    float edge_m;           // of small cells
};
enum { AGAIN = 1, PERHAPS, BESIDE }; // marks of a row

static void sort_into_cells(struct reach *r, float edge_m)
{
    const uint32_t rows = r->charts->side_texel_count;
    for (uint32_t i = 0; i < rows; i++) {
        int at[3];
        place_in_grid(chart_texel_of(r->charts, i)->position, edge_m, at);
        r->members[i] =
            (struct member){ cell_of(at, direction_of(chart_texel_normal(r->charts, i))), i };
    }
    qsort(r->members, rows, sizeof *r->members, compare_members);
}

static uint32_t end_of_cell(const struct reach *r, uint32_t first)
{
    uint32_t end = first;
    while (end < r->charts->side_texel_count && r->members[end].cell == r->members[first].cell)
        end++;
    return end;
}

// ---- the change of a cell

// Weights of the channels' changes, each by its amount: a change of colour alone counts, too.
static double amount(const double v[3])
{
    const float weights[3] = { 0.2126f, 0.7152f, 0.0722f };
    double sum = 0.0;
    for (int c = 0; c < 3; c++) sum += (double)weights[c] * fabs(v[c]);
    return sum;
}

// Sums over the texels of a cell that have estimates.
struct cell_sums {
    double change[3], value[3], square, variance;
    int count;
};

static struct cell_sums add_up(const struct reach *r, uint32_t first, uint32_t end)
{
    struct cell_sums s = { 0 };
    for (uint32_t i = first; i < end; i++) {
        const struct update_probe *p = &r->probes[r->members[i].row];
        const double change[3] = { (double)p->change[0], (double)p->change[1],
                                   (double)p->change[2] };
        if (p->touched > 0.0f) continue;
        for (int c = 0; c < 3; c++) {
            s.change[c] += change[c];
            s.value[c] += (double)p->value[c];
        }
        s.square += amount(change) * amount(change);
        s.variance += (double)p->variance;
        s.count++;
    }
    return s;
}

// How far a cell has changed, in thresholds; 0: it has no estimates.
static double change_of(const struct reach *r, uint32_t first, uint32_t end, bool *significant)
{
    const struct cell_sums s = add_up(r, first, end);
    *significant = false;
    if (s.count == 0) return 0.0;
    const double mean = amount(s.change) / s.count;
    const double error = sqrt(s.variance / s.count / r->block);
    const double threshold = fmax(error, LEAST_CHANGE * amount(s.value) / s.count);
    // The standard error of the estimate: few paths that meet the change are chance.
    const double chance = sqrt(fmax(s.square / s.count - mean * mean, 0.0) / s.count);
    *significant = mean > SIGNIFICANT * chance;
    if (threshold > 0.0) return mean / threshold;
    return mean > 0.0 ? (double)INFINITY : 0.0;
}

static void mark(struct reach *r, uint32_t first, uint32_t end, uint8_t value)
{
    for (uint32_t i = first; i < end; i++)
        if (r->again[r->members[i].row] != AGAIN) r->again[r->members[i].row] = value;
}

static bool has_mark(const struct reach *r, uint32_t first, uint32_t end, uint8_t value)
{
    for (uint32_t i = first; i < end; i++)
        if (r->again[r->members[i].row] == value) return true;
    return false;
}

// Large cells only say that some of their parts may have changed.
static void mark_level(struct reach *r, int level)
{
    sort_into_cells(r, r->edge_m * (float)(1 << level));
    for (uint32_t i = 0, end; i < r->charts->side_texel_count; i = end) {
        bool significant;
        end = end_of_cell(r, i);
        const double change = change_of(r, i, end, &significant);
        if (change > LEVEL_THRESHOLD[level] && significant)
            mark(r, i, end, level == LARGE ? PERHAPS : AGAIN);
        else if (level == MIDDLE && has_mark(r, i, end, PERHAPS))
            mark(r, i, end, change > PART_THRESHOLD ? AGAIN : 0);
    }
}

// ---- neighbours

static int compare_cells(const void *key, const void *member)
{
    const uint64_t a = *(const uint64_t *)key, b = ((const struct member *)member)->cell;
    return a < b ? -1 : a > b;
}

static bool has_changed(const struct update_probe *p)
{
    return p->change[0] != 0.0f || p->change[1] != 0.0f || p->change[2] != 0.0f;
}

// Marks texels of the cell of which a path has met the change.
static void mark_cell(struct reach *r, uint64_t cell)
{
    const uint32_t rows = r->charts->side_texel_count;
    const struct member *found =
        bsearch(&cell, r->members, rows, sizeof *r->members, compare_cells);
    if (!found) return;
    uint32_t i = (uint32_t)(found - r->members);
    while (i > 0 && r->members[i - 1].cell == cell) i--;
    for (const uint32_t end = end_of_cell(r, i); i < end; i++)
        if (has_changed(&r->probes[r->members[i].row])) mark(r, i, i + 1, BESIDE);
}

static void mark_neighbours(struct reach *r, const int at[3], unsigned kind)
{
    for (int k = 0; k < 27; k++) {
        const int near[3] = { at[0] + k % 3 - 1, at[1] + k / 3 % 3 - 1, at[2] + k / 9 - 1 };
        mark_cell(r, cell_of(near, kind));
    }
}

// Cells beside those that are baked again, so that no border lies where light changes most. Paths
// of most neighbours do not meet the change: these keep their light.
static void dilate(struct reach *r)
{
    const float edge_m = r->edge_m / EDGE;
    sort_into_cells(r, edge_m);
    for (uint32_t i = 0, end; i < r->charts->side_texel_count; i = end) {
        int at[3];
        end = end_of_cell(r, i);
        if (!has_mark(r, i, end, AGAIN)) continue;
        place_in_grid(chart_texel_of(r->charts, r->members[i].row)->position, edge_m, at);
        mark_neighbours(r, at, direction_of(chart_texel_normal(r->charts, r->members[i].row)));
    }
    for (uint32_t i = 0; i < r->charts->side_texel_count; i++) r->again[i] = r->again[i] != 0;
}

static bool reach_init(struct reach *r, struct host *host, const struct charts *charts,
                       const struct update_probe *probes, int samples, uint8_t *again)
{
    *r = (struct reach){ .charts = charts,
                         .probes = probes,
                         .again = again,
                         .block = (double)BLOCK * samples,
                         .edge_m = (float)EDGE / charts->texels_per_m };
    r->members = host_alloc(host, charts->side_texel_count, sizeof *r->members);
    return r->members;
}

bool update_suspects(struct host *host, const struct charts *charts,
                     const struct update_probe *probes, int samples, uint8_t *suspects)
{
    struct reach r;
    if (!reach_init(&r, host, charts, probes, samples, suspects)) return false;
    sort_into_cells(&r, r.edge_m * (float)(1 << MIDDLE));
    for (uint32_t i = 0, end; i < charts->side_texel_count; i = end) {
        bool significant;
        end = end_of_cell(&r, i);
        if (change_of(&r, i, end, &significant) > SUSPECT_THRESHOLD) mark(&r, i, end, AGAIN);
    }
    host_free(host, r.members);
    return true;
}

bool update_reach(struct host *host, const struct charts *charts, const struct update_probe *probes,
                  int samples, uint8_t *again)
{
    const uint32_t rows = charts->side_texel_count;
    struct reach r;
    if (!reach_init(&r, host, charts, probes, samples, again)) return false;
    for (uint32_t i = 0; i < rows; i++) again[i] = probes[i].touched > 0.0f;
    for (int level = LARGE; level >= TINY; level--) mark_level(&r, level);
    dilate(&r);
    host_free(host, r.members);
    return true;
}
