// The light x of places beside seams minimises Σ l (a·x)² + λ Σ (x − x₀)², with a·x the difference
// of both charts' lookups at a point, l its length along the edge and x₀ the light of the place's
// texel. The solution is λ (λ I + Σ l a aᵀ)⁻¹ x₀, whose rows decay within some texels: each is
// found by conjugate gradients on the places around.
#include "trace/texels/close.h"

#include "core/parallel.h"

#include <math.h>
#include <stdlib.h>

enum { MOST_LOCAL = 96, STEPS = 64 };

// ---- points

struct opening {
    const struct charts *charts;
    const struct trace_scene *trace;
    struct chart_seams *seams;
    bool *open;
};

// Into the triangle of one chart, along its surface: half a texel.
static vec3s beside(const struct opening *o, const struct chart_seam_point *point, int chart)
{
    const struct charts *charts = o->charts;
    const struct chart_triangle *t = &charts->triangles[point->triangle[chart]];
    vec3s inward = glms_vec3_add(glms_vec3_add(t->corner[0], t->corner[1]), t->corner[2]);
    inward = glms_vec3_sub(glms_vec3_scale(inward, 1.0f / 3.0f), point->position);
    const float reach = fminf(0.5f / charts->texels_per_m, glms_vec3_norm(inward));
    const float up = (point->back ? -0.25f : 0.25f) / charts->texels_per_m;
    const vec3s at = glms_vec3_muladds(vec3_unit(inward), reach, point->position);
    return glms_vec3_muladds(t->normal, up, at);
}

static void test_point(void *user, size_t i)
{
    const struct opening *o = user;
    const vec3s from = beside(o, &o->seams->points[i], 0), to = beside(o, &o->seams->points[i], 1);
    o->open[i] = !trace_occluded(o->trace, from, glms_vec3_sub(to, from), 1.0f);
}

// A wall that stands on a seam divides it.
static bool remove_divided(struct seam_closing *c, const struct trace_scene *trace)
{
    struct chart_seams *seams = &c->seams;
    struct opening o = { c->charts, trace, seams,
                         host_alloc(c->host, seams->point_count, sizeof *o.open) };
    if (!o.open) return false;
    parallel_for(seams->point_count, 64, test_point, &o);
    uint32_t count = 0;
    for (uint32_t i = 0; i < seams->point_count; i++)
        if (o.open[i]) seams->points[count++] = seams->points[i];
    seams->point_count = count;
    host_free(c->host, o.open);
    return true;
}

static bool list_points(struct seam_closing *c)
{
    const struct chart_seams *seams = &c->seams;
    const size_t entries = CHART_SEAM_PLACES * (size_t)seams->point_count;
    c->first = host_alloc(c->host, (size_t)seams->count + 2, sizeof *c->first);
    c->points = host_alloc(c->host, entries, sizeof *c->points);
    if (!c->first || !c->points) return false;
    // Counts are two rows late, so that filling leaves each row's first.
    for (size_t i = 0; i < entries; i++) c->first[seams->points[i / 8].place[i % 8] + 2]++;
    for (uint32_t i = 0; i < seams->count; i++) c->first[i + 2] += c->first[i + 1];
    for (size_t i = 0; i < entries; i++)
        c->points[c->first[seams->points[i / 8].place[i % 8] + 1]++] = (uint32_t)(i / 8);
    return true;
}

bool seam_closing_init(struct seam_closing *out, struct host *host, const struct charts *charts,
                       const struct trace_scene *trace)
{
    *out = (struct seam_closing){ .host = host, .charts = charts, .trace = trace };
    const bool ok = charts_seams_init(&out->seams, charts, CHART_SEAM_POINTS) &&
                    remove_divided(out, trace) && list_points(out);
    if (!ok) seam_closing_finish(out);
    return ok;
}

void seam_closing_finish(struct seam_closing *closing)
{
    if (!closing->host) return;
    host_free(closing->host, closing->first);
    host_free(closing->host, closing->points);
    charts_seams_finish(&closing->seams);
    *closing = (struct seam_closing){ 0 };
}

// ---- places around one

struct seam_closing_scratch {
    struct host *host;
    uint32_t *local;            // [places] number in `place`, from 1; all 0 between the calls
    bool *has;                  // [points] it is in `point`; likewise
    uint32_t *point;            // [points] those at near places
    uint32_t place[MOST_LOCAL]; // near ones, the nearest first
    double x[MOST_LOCAL], r[MOST_LOCAL], d[MOST_LOCAL], q[MOST_LOCAL]; // of conjugate gradients
};

struct seam_closing_scratch *seam_closing_scratch_create(struct host *host,
                                                         const struct seam_closing *closing)
{
    const struct chart_seams *seams = &closing->seams;
    struct seam_closing_scratch *scratch = host_alloc(host, 1, sizeof *scratch);
    if (!scratch) return NULL;
    scratch->host = host;
    scratch->local = host_alloc(host, seams->count, sizeof *scratch->local);
    scratch->has = host_alloc(host, seams->point_count, sizeof *scratch->has);
    scratch->point = host_alloc(host, seams->point_count, sizeof *scratch->point);
    if (scratch->local && scratch->has && scratch->point) return scratch;
    seam_closing_scratch_destroy(scratch);
    return NULL;
}

void seam_closing_scratch_destroy(struct seam_closing_scratch *scratch)
{
    if (!scratch) return;
    host_free(scratch->host, scratch->local);
    host_free(scratch->host, scratch->has);
    host_free(scratch->host, scratch->point);
    host_free(scratch->host, scratch);
}

struct near {
    const struct seam_closing *closing;
    struct seam_closing_scratch *scratch;
    uint32_t places, points;
};

static void add_place(struct near *n, uint32_t place)
{
    if (n->scratch->local[place] > 0 || n->places == MOST_LOCAL) return;
    n->scratch->place[n->places++] = place;
    n->scratch->local[place] = n->places;
}

// Places that share points with it, breadth first. Farther ones keep their light.
static void find_near(struct near *n, uint32_t place)
{
    const struct seam_closing *c = n->closing;
    add_place(n, place);
    for (uint32_t i = 0; i < n->places; i++) {
        const uint32_t at = n->scratch->place[i];
        for (uint32_t k = c->first[at]; k < c->first[at + 1]; k++) {
            const uint32_t point = c->points[k];
            if (n->scratch->has[point]) continue;
            n->scratch->has[point] = true;
            n->scratch->point[n->points++] = point;
            for (int j = 0; j < CHART_SEAM_PLACES; j++)
                add_place(n, c->seams.points[point].place[j]);
        }
    }
}

static void forget(struct near *n)
{
    for (uint32_t i = 0; i < n->places; i++) n->scratch->local[n->scratch->place[i]] = 0;
    for (uint32_t i = 0; i < n->points; i++) n->scratch->has[n->scratch->point[i]] = false;
}

// ---- conjugate gradients

// q = (λ I + Σ l a aᵀ) d
static void apply(const struct near *n)
{
    const double *d = n->scratch->d;
    double *q = n->scratch->q;
    for (uint32_t i = 0; i < n->places; i++) q[i] = SEAM_CLOSING_LAMBDA * d[i];
    for (uint32_t i = 0; i < n->points; i++) {
        const struct chart_seam_point *p = &n->closing->seams.points[n->scratch->point[i]];
        double sum = 0.0;
        for (int k = 0; k < CHART_SEAM_PLACES; k++) {
            const uint32_t at = n->scratch->local[p->place[k]];
            if (at > 0) sum += (double)p->weight[k] * d[at - 1];
        }
        for (int k = 0; k < CHART_SEAM_PLACES; k++) {
            const uint32_t at = n->scratch->local[p->place[k]];
            if (at > 0) q[at - 1] += (double)p->length * sum * (double)p->weight[k];
        }
    }
}

static double dot(const double *a, const double *b, uint32_t count)
{
    double sum = 0.0;
    for (uint32_t i = 0; i < count; i++) sum += a[i] * b[i];
    return sum;
}

// x = λ (λ I + Σ l a aᵀ)⁻¹ e, with e of the first place.
static void solve(const struct near *n)
{
    struct seam_closing_scratch *m = n->scratch;
    for (uint32_t i = 0; i < n->places; i++) m->x[i] = m->r[i] = m->d[i] = 0.0;
    m->r[0] = m->d[0] = SEAM_CLOSING_LAMBDA;
    double square = SEAM_CLOSING_LAMBDA * SEAM_CLOSING_LAMBDA;
    for (int step = 0; step < STEPS && square > 1e-10 * SEAM_CLOSING_LAMBDA * SEAM_CLOSING_LAMBDA;
         step++) {
        apply(n);
        const double alpha = square / dot(m->d, m->q, n->places);
        for (uint32_t i = 0; i < n->places; i++) {
            m->x[i] += alpha * m->d[i];
            m->r[i] -= alpha * m->q[i];
        }
        const double next = dot(m->r, m->r, n->places);
        for (uint32_t i = 0; i < n->places; i++) m->d[i] = m->r[i] + next / square * m->d[i];
        square = next;
    }
}

// ---- rows

static int by_texel(const void *a, const void *b)
{
    const struct chart_share *p = a, *q = b;
    return p->texel < q->texel ? -1 : p->texel > q->texel;
}

static int by_weight(const void *a, const void *b)
{
    const struct chart_share *p = a, *q = b;
    if (fabsf(p->weight) != fabsf(q->weight)) return fabsf(p->weight) > fabsf(q->weight) ? -1 : 1;
    return by_texel(a, b);
}

// A gutter's light is that of its texel.
static uint32_t merge(const struct near *n, struct chart_share *row)
{
    const struct seam_closing *c = n->closing;
    uint32_t count = 0, merged = 0;
    for (uint32_t i = 0; i < n->places; i++) {
        const uint32_t place = c->seams.places[n->scratch->place[i]];
        const uint32_t texel = chart_texel_of_place(c->charts, place);
        if (texel != CHART_NONE)
            row[count++] = (struct chart_share){ texel, (float)n->scratch->x[i] };
    }
    qsort(row, count, sizeof *row, by_texel);
    for (uint32_t i = 0; i < count; i++) {
        if (merged > 0 && row[merged - 1].texel == row[i].texel)
            row[merged - 1].weight += row[i].weight;
        else
            row[merged++] = row[i];
    }
    qsort(row, merged, sizeof *row, by_weight);
    return merged;
}

// Uniform light stays: the remainder is added to the largest weight.
static void write_row(const struct chart_share *row, uint32_t count, struct chart_share *out)
{
    float rest = 1.0f;
    for (uint32_t i = 0; i < CHART_SEAM_ENTRIES; i++) {
        out[i] = i < count ? row[i] : (struct chart_share){ 0 };
        rest -= out[i].weight;
    }
    out[0].weight += rest;
}

void seam_close(const struct seam_closing *closing, struct seam_closing_scratch *scratch,
                uint32_t place, struct chart_share out[CHART_SEAM_ENTRIES])
{
    struct near near = { closing, scratch, 0, 0 };
    struct chart_share row[MOST_LOCAL];
    find_near(&near, place);
    solve(&near);
    write_row(row, merge(&near, row), out);
    forget(&near);
}
