// In each row the squared distances to all chosen offsets are parabolas of one shape, and their
// lower envelope has the spans (Felzenszwalb & Huttenlocher 2012, section 2.1). Differs from the
// paper: parabolas meet between integers, so that nothing is rounded and ties are decided by the
// index.
#include "techniques/ort/bake/regions.h"

#include <assert.h>
#include <stdlib.h>

struct site {
    int64_t x, y;
    uint32_t region;
};

// The nearest site from x on, until the next part of the envelope.
struct part {
    const struct site *site;
    int64_t x;
};

struct rows {
    struct host *host;
    int64_t width, height; // the largest offsets
    struct site *sites;    // by x, then region
    uint32_t count;
    struct part *envelope;
};

static int by_x(const void *a, const void *b)
{
    const struct site *p = a, *q = b;
    if (p->x != q->x) return p->x < q->x ? -1 : 1;
    return (p->region > q->region) - (p->region < q->region);
}

static int64_t floor_divide(int64_t a, int64_t b) // b > 0
{
    return a / b - (a % b < 0);
}

// The first x at which `right` is nearer than `left`, in row y, for left->x ≤ right->x. INT64_MIN:
// everywhere, INT64_MAX: nowhere.
static int64_t first_nearer(const struct site *left, const struct site *right, int64_t y)
{
    const int64_t left_rise = left->y - y, right_rise = right->y - y;
    // Right is nearer where 2x · between exceeds `twice`.
    const int64_t between = right->x - left->x;
    const int64_t twice =
        right->x * right->x + right_rise * right_rise - left->x * left->x - left_rise * left_rise;
    const bool wins_ties = right->region < left->region;
    if (between == 0) return twice < 0 || (twice == 0 && wins_ties) ? INT64_MIN : INT64_MAX;
    return floor_divide(wins_ties ? twice - 1 : twice, 2 * between) + 1;
}

// Returns the number of parts of row y, the first of which begins at the left end.
static uint32_t find_envelope(const struct rows *rows, int64_t y)
{
    struct part *parts = rows->envelope;
    uint32_t count = 0;
    for (uint32_t i = 0; i < rows->count; i++) {
        const struct site *site = &rows->sites[i];
        int64_t x = -rows->width;
        while (count > 0) {
            x = first_nearer(parts[count - 1].site, site, y);
            if (x > parts[count - 1].x) break;
            count--;
            x = -rows->width;
        }
        if (x <= rows->width) parts[count++] = (struct part){ site, x };
    }
    return count;
}

static bool rows_init(struct rows *rows, const struct ort_offset *offsets)
{
    rows->sites = host_alloc(rows->host, rows->count, sizeof *rows->sites);
    rows->envelope = host_alloc(rows->host, rows->count, sizeof *rows->envelope);
    if (!rows->sites || !rows->envelope) return false;
    for (uint32_t i = 0; i < rows->count; i++)
        rows->sites[i] = (struct site){ offsets[i].x, offsets[i].y, i };
    qsort(rows->sites, rows->count, sizeof *rows->sites, by_x);
    return true;
}

// Counts the spans of region i at first[i + 1], then sums them up.
static bool count_spans(const struct rows *rows, struct ort_regions *out)
{
    uint64_t total = 0;
    for (int64_t y = -rows->height; y <= rows->height; y++) {
        const uint32_t parts = find_envelope(rows, y);
        for (uint32_t i = 0; i < parts; i++) out->first[rows->envelope[i].site->region + 1]++;
        total += parts;
    }
    if (total > UINT32_MAX)
        return host_fail(rows->host, FAIL_MEMORY, "Voronoi regions of %u offsets: too many spans",
                         rows->count);
    for (uint32_t i = 0; i < rows->count; i++) out->first[i + 1] += out->first[i];
    return true;
}

// Moves first[i] from the begin of region i to its end.
static void write_spans(const struct rows *rows, struct ort_regions *out)
{
    for (int64_t y = -rows->height; y <= rows->height; y++) {
        const uint32_t parts = find_envelope(rows, y);
        for (uint32_t i = 0; i < parts; i++) {
            const struct part *part = &rows->envelope[i];
            const int64_t end = i + 1 < parts ? part[1].x - 1 : rows->width;
            out->spans[out->first[part->site->region]++] =
                (struct ort_span){ (int32_t)y, (int32_t)part->x, (int32_t)end };
        }
    }
    for (uint32_t i = rows->count; i > 0; i--) out->first[i] = out->first[i - 1];
    out->first[0] = 0;
}

static bool find_regions(struct rows *rows, const struct ort_offset *offsets,
                         struct ort_regions *out)
{
    out->first = host_alloc(rows->host, (size_t)rows->count + 1, sizeof *out->first);
    if (!out->first || !rows_init(rows, offsets) || !count_spans(rows, out)) return false;
    out->spans = host_alloc(rows->host, out->first[rows->count], sizeof *out->spans);
    if (!out->spans) return false;
    write_spans(rows, out);
    return true;
}

bool ort_regions_init(struct ort_regions *out, struct host *host, const struct ort_offset *offsets,
                      uint32_t count, uint32_t width, uint32_t height)
{
    assert(count > 0 && width > 0 && width <= ORT_MOST_SIDE);
    assert(height > 0 && height <= ORT_MOST_SIDE);
    struct rows rows = {
        .host = host, .width = (int64_t)width - 1, .height = (int64_t)height - 1, .count = count
    };
    *out = (struct ort_regions){ .host = host, .count = count };
    const bool ok = find_regions(&rows, offsets, out);
    host_free(host, rows.sites);
    host_free(host, rows.envelope);
    if (!ok) ort_regions_finish(out);
    return ok;
}

void ort_regions_finish(struct ort_regions *regions)
{
    if (!regions->host) return;
    host_free(regions->host, regions->first);
    host_free(regions->host, regions->spans);
    *regions = (struct ort_regions){ 0 };
}
