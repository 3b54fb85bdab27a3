// An image in strips: adjacent pixels of a tile's row, whose samples tasks of a bake trace, each on
// its own.
#include "trace/reference_state.h"

#include <assert.h>
#include <math.h>
#include <string.h>

// After the sums of a strip's pixels.
enum { PIXEL_VALUES = sizeof(struct pixel_sums) / sizeof(double) };
_Static_assert((int)REFERENCE_STRIP == (int)REFERENCE_TILE &&
                   (int)REFERENCE_STRIP_VALUES == REFERENCE_TILE * PIXEL_VALUES + 1,
               "a strip is a row of a tile, and its rays");
static const size_t RAYS = REFERENCE_STRIP_VALUES - 1;

// Tile by tile, so that those of a task are near each other; some lie below the image.
size_t reference_strip_count(const struct reference *r)
{
    return reference_tile_count(r) * REFERENCE_TILE;
}

// The pixels of a strip; width 0: it lies below the image.
static struct reference_row row_of(const struct reference *r, size_t strip)
{
    const size_t tile = strip / REFERENCE_TILE;
    struct reference_row row = { .x = (int)(tile % (size_t)r->tiles_x) * REFERENCE_TILE,
                                 .y = (int)(tile / (size_t)r->tiles_x) * REFERENCE_TILE +
                                      (int)(strip % REFERENCE_TILE) };
    const int left = r->width - row.x;
    if (row.y < r->height) row.width = left < REFERENCE_TILE ? left : REFERENCE_TILE;
    return row;
}

void reference_trace_strip(const struct reference *r, size_t strip, int from, int to,
                           double *values)
{
    assert(r->trained || !r->options.guiding);
    struct pixel_sums sums[REFERENCE_TILE];
    struct reference_row row = row_of(r, strip);
    uint64_t rays = 0;
    row.from = from;
    row.to = to;
    const unsigned before = embree_flush_denormals();
    memcpy(sums, values, sizeof sums);
    reference_trace_row(r, &row, sums, &rays);
    memcpy(values, sums, sizeof sums);
    embree_restore_denormals(before);
    values[RAYS] += (double)rays;
}

static bool are_finite(const double *values)
{
    for (size_t i = 0; i < REFERENCE_STRIP_VALUES; i++)
        if (!isfinite(values[i])) return false;
    return values[RAYS] >= 0.0 && values[RAYS] < 0x1p53;
}

bool reference_set_strips(struct reference *r, int samples, const double *values)
{
    for (size_t strip = 0; strip < reference_strip_count(r); strip++)
        if (!are_finite(&values[strip * REFERENCE_STRIP_VALUES]))
            return host_fail(r->host, FAIL_FORMAT, "samples of a reference: not finite");
    for (size_t strip = 0; strip < reference_strip_count(r); strip++) {
        const double *of_strip = &values[strip * REFERENCE_STRIP_VALUES];
        const struct reference_row row = row_of(r, strip);
        struct reference_tile *tile = &r->tiles[strip / REFERENCE_TILE];
        if (strip % REFERENCE_TILE == 0) *tile = (struct reference_tile){ .samples = samples };
        tile->rays += (uint64_t)of_strip[RAYS];
        if (row.width > 0)
            memcpy(&r->sums[(size_t)row.y * (size_t)r->width + (size_t)row.x], of_strip,
                   (size_t)row.width * sizeof *r->sums);
    }
    return true;
}
