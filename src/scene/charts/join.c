// Small charts of one cell of a grid, the largest first: each joins the first chart before it with
// a similar normal that is visible from it.
#include "scene/charts/join.h"

#include "scene/charts/sight.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

struct small_chart {
    struct sight_place place; // the middle of the largest triangle; the chart's normal
    uint64_t cell;
    uint32_t chart, kind; // kind: charts of different ones stay apart
    float area_m2;
};

struct joining {
    struct grown *grown;
    const struct surface *surface;
    double texels_per_m;
    bool across;
    struct small_chart *small;
    uint32_t small_count;
    uint32_t *joined; // [charts] the chart that a chart is part of
    uint32_t *heads;  // [charts] small charts of a cell that are not part of others
};

// ---- small charts

static bool is_small(const struct grown_chart *chart)
{
    return chart->width <= 1.0 && chart->height <= 1.0;
}

enum { CELL_BITS = 21 };

// The cube of a grid whose edges are a texel.
static uint64_t cell_of(vec3s position, double texels_per_m)
{
    const double half = (double)(1 << (CELL_BITS - 1));
    uint64_t cell = 0;
    for (int k = 0; k < 3; k++) {
        const double at = floor((double)position.raw[k] * texels_per_m) + half;
        cell = cell << CELL_BITS | (uint64_t)fmin(fmax(at, 0.0), 2.0 * half - 1.0);
    }
    return cell;
}

static struct small_chart small_chart_of(const struct joining *j, uint32_t chart)
{
    const struct grown_chart *of = &j->grown->charts[chart];
    struct small_chart small = { .place.normal = of->normal, .chart = chart };
    float largest = 0.0f;
    for (uint32_t i = of->first_triangle; i < of->first_triangle + of->triangle_count; i++) {
        const struct surface_triangle *t = &j->surface->triangles[j->grown->order[i]];
        small.area_m2 += t->area_m2;
        if (!(t->area_m2 > largest)) continue;
        largest = t->area_m2;
        small.kind = j->across ? t->double_sided : 2 * (uint32_t)t->instance + t->double_sided;
        const vec3s sum = glms_vec3_add(t->corner[0], glms_vec3_add(t->corner[1], t->corner[2]));
        small.place.position = glms_vec3_scale(sum, 1.0f / 3.0f);
    }
    small.cell = cell_of(small.place.position, j->texels_per_m);
    return small;
}

static int compare_small(const void *a, const void *b)
{
    const struct small_chart *p = a, *q = b;
    if (p->cell != q->cell) return p->cell < q->cell ? -1 : 1;
    if (p->kind != q->kind) return p->kind < q->kind ? -1 : 1;
    if (p->area_m2 != q->area_m2) return p->area_m2 > q->area_m2 ? -1 : 1;
    return p->chart < q->chart ? -1 : p->chart > q->chart;
}

static bool find_small(struct joining *j)
{
    const struct grown *grown = j->grown;
    j->small = host_alloc(grown->host, grown->count, sizeof *j->small);
    j->joined = host_alloc(grown->host, grown->count, sizeof *j->joined);
    j->heads = host_alloc(grown->host, grown->count, sizeof *j->heads);
    if (!j->small || !j->joined || !j->heads) return false;
    for (uint32_t c = 0; c < grown->count; c++) {
        j->joined[c] = c;
        if (is_small(&grown->charts[c])) j->small[j->small_count++] = small_chart_of(j, c);
    }
    qsort(j->small, j->small_count, sizeof *j->small, compare_small);
    return true;
}

// ---- joining

// Charts that a small chart is tried with, at most: tests of visibility take time.
enum { MOST_TRIED = 8 };

// A texel has the irradiance of one normal. Charts with other normals share it only within this
// cosine, beyond which they would lack light from behind its plane.
static const float MIN_COSINE = 0.5f;

// Joins a chart to one of its cell and kind, or adds it to their heads.
static void join_small(struct joining *j, const struct sight *sight,
                       const struct small_chart *small, uint32_t *head_count)
{
    int tried = 0;
    for (uint32_t k = 0; k < *head_count && tried < MOST_TRIED; k++) {
        const struct small_chart *to = &j->small[j->heads[k]];
        if (glms_vec3_dot(to->place.normal, small->place.normal) < MIN_COSINE) continue;
        tried++;
        if (!sight_is_free(sight, &to->place, &small->place)) continue;
        j->joined[small->chart] = to->chart;
        return;
    }
    j->heads[(*head_count)++] = (uint32_t)(small - j->small);
}

static bool join_all(struct joining *j)
{
    struct sight sight;
    if (!sight_init(&sight, j->grown->host, j->surface)) return false;
    uint32_t heads = 0;
    for (uint32_t i = 0; i < j->small_count; i++) {
        const struct small_chart *small = &j->small[i];
        if (i > 0 && (small->cell != small[-1].cell || small->kind != small[-1].kind)) heads = 0;
        join_small(j, &sight, small, &heads);
    }
    sight_finish(&sight);
    return true;
}

// ---- joined charts

// Numbers the charts that are left, and moves them there. number: [charts].
static void number_charts(struct joining *j, uint32_t *number)
{
    struct grown *grown = j->grown;
    uint32_t count = 0;
    for (uint32_t c = 0; c < grown->count; c++) {
        if (j->joined[c] != c) continue;
        number[c] = count;
        grown->charts[count] = grown->charts[c];
        grown->charts[count].single_texel = is_small(&grown->charts[c]);
        grown->charts[count++].triangle_count = 0;
    }
    grown->count = count;
}

// Triangles stay in their order within a chart.
static void sort_triangles(struct grown *grown, const uint32_t *old, uint32_t count)
{
    uint32_t first = 0;
    for (uint32_t i = 0; i < count; i++) grown->charts[grown->chart_of[old[i]]].triangle_count++;
    for (uint32_t c = 0; c < grown->count; c++) {
        grown->charts[c].first_triangle = first;
        first += grown->charts[c].triangle_count;
        grown->charts[c].triangle_count = 0;
    }
    for (uint32_t i = 0; i < count; i++) {
        struct grown_chart *chart = &grown->charts[grown->chart_of[old[i]]];
        grown->order[chart->first_triangle + chart->triangle_count++] = old[i];
    }
}

static bool rebuild(struct joining *j)
{
    struct grown *grown = j->grown;
    const uint32_t count = j->surface->count;
    uint32_t *number = host_alloc(grown->host, grown->count, sizeof *number);
    uint32_t *old = host_alloc(grown->host, count, sizeof *old);
    const bool ok = number && old;
    if (ok) {
        memcpy(old, grown->order, count * sizeof *old);
        number_charts(j, number);
        for (uint32_t t = 0; t < count; t++)
            grown->chart_of[t] = number[j->joined[grown->chart_of[t]]];
        sort_triangles(grown, old, count);
    }
    host_free(grown->host, number);
    host_free(grown->host, old);
    return ok;
}

bool join_small_charts(struct grown *grown, const struct surface *surface, double texels_per_m,
                       bool across)
{
    struct joining j = {
        .grown = grown, .surface = surface, .texels_per_m = texels_per_m, .across = across
    };
    const bool ok = find_small(&j) && join_all(&j) && rebuild(&j);
    host_free(grown->host, j.small);
    host_free(grown->host, j.joined);
    host_free(grown->host, j.heads);
    return ok;
}
