// The one file that calls Qhull.
#include "techniques/ort/bake/delaunay.h"

#include <libqhull_r/qhull_ra.h>

#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// Points about 0, divided by the power of two that brings them into (−1, 1): both only rarely
// round, and squares neither overflow nor cancel.
static double *centred(struct host *host, const double *at, uint32_t count)
{
    double low[2] = { INFINITY, INFINITY }, high[2] = { -INFINITY, -INFINITY };
    double *out = host_alloc(host, count, 2 * sizeof *out);
    if (!out) return NULL;
    for (size_t i = 0; i < 2 * (size_t)count; i++) {
        low[i % 2] = fmin(low[i % 2], at[i]);
        high[i % 2] = fmax(high[i % 2], at[i]);
    }
    int exponent;
    frexp(0.5 * fmax(high[0] - low[0], high[1] - low[1]), &exponent);
    for (size_t i = 0; i < 2 * (size_t)count; i++)
        out[i] = ldexp(at[i] - 0.5 * (low[i % 2] + high[i % 2]), -exponent);
    return out;
}

// Appends a triangle counter-clockwise, unless it is flat.
static void add(struct ort_triangles *out, const double *at, const uint32_t corner[3])
{
    const double *a = &at[2 * corner[0]], *b = &at[2 * corner[1]], *c = &at[2 * corner[2]];
    const double area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
    if (area == 0.0) return;
    uint32_t *to = out->corners[out->count++];
    to[0] = corner[0];
    to[1] = corner[area > 0.0 ? 1 : 2];
    to[2] = corner[area > 0.0 ? 2 : 1];
}

static uint32_t count_facets(qhT *qh)
{
    uint32_t count = 0;
    facetT *facet;
    FORALLfacets if (!facet->upperdelaunay) count++;
    return count;
}

// False where a facet is no triangle of points.
static bool copy_facets(qhT *qh, const double *at, uint32_t count, struct ort_triangles *out)
{
    facetT *facet;
    vertexT *vertex, **vertexp;
    FORALLfacets
    {
        if (facet->upperdelaunay) continue;
        uint32_t corner[3], corners = 0;
        FOREACHvertex_(facet->vertices)
        {
            const int id = qh_pointid(qh, vertex->point);
            if (corners == 3 || id < 0 || (uint32_t)id >= count) return false;
            corner[corners++] = (uint32_t)id;
        }
        if (corners != 3) return false;
        add(out, at, corner);
    }
    return true;
}

static bool all_used(struct host *host, const struct ort_triangles *triangles, uint32_t count)
{
    uint32_t used_count = 0;
    bool *used = host_alloc(host, count, sizeof *used);
    if (!used) return false;
    for (size_t i = 0; i < 3 * (size_t)triangles->count; i++) {
        bool *one = &used[triangles->corners[i / 3][i % 3]];
        used_count += !*one;
        *one = true;
    }
    host_free(host, used);
    return used_count == count ||
           host_fail(host, FAIL_ARGUMENT, "triangulation of %u points: %u are too close to others",
                     count, count - used_count);
}

// `text`: what Qhull wrote, of which the first line is logged.
static bool fail(struct host *host, uint32_t count, int code, char *text)
{
    if (code == qh_ERRmem || !text)
        return host_fail(host, FAIL_MEMORY, "triangulation of %u points: out of memory", count);
    if (code == qh_ERRsingular || code == qh_ERRinput) // input: all have the same x or y
        return host_fail(host, FAIL_ARGUMENT, "triangulation: %u points lie on a line", count);
    text[strcspn(text, "\n")] = '\0';
    return host_fail(host, FAIL_ARGUMENT, "triangulation of %u points: %s", count, text);
}

static bool triangulate(qhT *qh, struct host *host, const double *at, uint32_t count,
                        struct ort_triangles *out)
{
    const size_t facets = count_facets(qh);
    out->corners = host_alloc(host, facets, sizeof *out->corners);
    if (!out->corners) return false;
    if (!copy_facets(qh, at, count, out))
        return host_fail(host, FAIL_ARGUMENT, "triangulation of %u points: a facet has no 3 points",
                         count);
    return all_used(host, out, count);
}

// Qt: simplices only, also of cocircular points. Qz: a point at infinity, so that all points may be
// cocircular. Qbb: the lifted coordinate is scaled to the range of the others.
static bool run(struct host *host, const double *at, double *lifted, uint32_t count,
                struct ort_triangles *out)
{
    char options[] = "qhull d Qbb Qt Qz", *text = NULL;
    size_t length;
    int long_bytes, long_count;
    FILE *messages = open_memstream(&text, &length);
    if (!messages)
        return host_fail(host, FAIL_MEMORY, "triangulation of %u points: out of memory", count);
    qhT qh;
    qh_zero(&qh, messages);
    const int code = qh_new_qhull(&qh, 2, (int)count, lifted, False, options, NULL, messages);
    bool ok = code == qh_ERRnone && triangulate(&qh, host, at, count, out);
    qh_freeqhull(&qh, !qh_ALL);
    qh_memfreeshort(&qh, &long_bytes, &long_count);
    fclose(messages);
    if (code != qh_ERRnone) ok = fail(host, count, code, text);
    free(text);
    return ok;
}

bool ort_delaunay(struct host *host, const double *at, uint32_t count, struct ort_triangles *out)
{
    *out = (struct ort_triangles){ 0 };
    if (count < 3 || count > INT_MAX / 8)
        return host_fail(host, FAIL_ARGUMENT, "triangulation: %u points; 3 to %d are possible",
                         count, INT_MAX / 8);
    double *lifted = centred(host, at, count);
    const bool ok = lifted && run(host, at, lifted, count, out);
    host_free(host, lifted);
    if (!ok) ort_triangles_finish(host, out);
    return ok;
}

void ort_triangles_finish(struct host *host, struct ort_triangles *triangles)
{
    host_free(host, triangles->corners);
    *triangles = (struct ort_triangles){ 0 };
}
