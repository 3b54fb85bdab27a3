#include "scene/charts/seams.h"

#include "core/hash.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

// Light differs on both sides of an edge, unless its facets are coplanar or the mesh has the same
// normals there for both.
static const float COPLANAR = 0.9999f, SMOOTH = 0.966f, SAME_NORMAL = 0.999f;

// ---- edges

struct edge {
    uint64_t key;  // hash of both ends
    uint32_t side; // 3 · triangle + k, in charts.triangles
};

struct end {
    vec3s position, normal; // normal: in the frame of the mesh
    vec2s place;
};

static bool precedes(vec3s a, vec3s b)
{
    for (int k = 0; k < 3; k++)
        if (a.raw[k] != b.raw[k]) return a.raw[k] < b.raw[k];
    return false;
}

// The ends of a triangle's side, in an order that depends on their positions alone. Adding 0 turns
// −0 into 0, which is equal.
static void ends_of(const struct charts *charts, uint32_t side, struct end end[2])
{
    const struct chart_triangle *t = &charts->triangles[side / 3];
    const uint32_t a = side % 3, b = (a + 1) % 3;
    end[0] = (struct end){ glms_vec3_adds(t->corner[a], 0.0f), t->vertex_normal[a], t->place[a] };
    end[1] = (struct end){ glms_vec3_adds(t->corner[b], 0.0f), t->vertex_normal[b], t->place[b] };
    if (!precedes(end[1].position, end[0].position)) return;
    const struct end first = end[0];
    end[0] = end[1];
    end[1] = first;
}

static uint64_t key_of(const struct charts *charts, uint32_t side)
{
    struct end end[2];
    ends_of(charts, side, end);
    const vec3s at[2] = { end[0].position, end[1].position };
    return hash_bytes(at, sizeof at, 0);
}

static int compare_edges(const void *a, const void *b)
{
    const struct edge *p = a, *q = b;
    if (p->key != q->key) return p->key < q->key ? -1 : 1;
    return p->side < q->side ? -1 : p->side > q->side;
}

static struct edge *sorted_edges(struct host *host, const struct charts *charts)
{
    const uint32_t count = 3 * charts->triangle_count;
    struct edge *edges = host_alloc(host, count, sizeof *edges);
    for (uint32_t i = 0; edges && i < count; i++) edges[i] = (struct edge){ key_of(charts, i), i };
    if (edges) qsort(edges, count, sizeof *edges, compare_edges);
    return edges;
}

// ---- points

struct making {
    struct chart_seams *out;
    const struct charts *charts;
    const struct edge *edges;
    float per_texel;
    uint32_t *number; // [sides × height × width] of a place; CHART_NONE: none yet. NULL: count only
};

// Ends of one edge on both charts.
struct seam {
    struct end end[2][2]; // [chart][end]
    uint32_t triangle[2];
};

static bool is_smooth(const struct charts *charts, const struct seam *seam)
{
    const struct chart_triangle *a = &charts->triangles[seam->triangle[0]];
    const struct chart_triangle *b = &charts->triangles[seam->triangle[1]];
    if (glms_vec3_dot(a->normal, b->normal) >= COPLANAR) return true;
    bool same = a->instance == b->instance && glms_vec3_dot(a->normal, b->normal) >= SMOOTH;
    for (int k = 0; k < 2; k++)
        same &= glms_vec3_dot(seam->end[0][k].normal, seam->end[1][k].normal) >= SAME_NORMAL;
    return same;
}

static bool is_seam(const struct charts *charts, uint32_t a, uint32_t b, struct seam *seam)
{
    seam->triangle[0] = a / 3;
    seam->triangle[1] = b / 3;
    ends_of(charts, a, seam->end[0]);
    ends_of(charts, b, seam->end[1]);
    bool apart = false;
    for (int k = 0; k < 2; k++) {
        const vec3s p = seam->end[0][k].position, q = seam->end[1][k].position;
        if (memcmp(&p, &q, sizeof p) != 0) return false;
        apart |= glms_vec2_distance(seam->end[0][k].place, seam->end[1][k].place) > 1e-3f;
    }
    return apart && is_smooth(charts, seam);
}

static uint32_t number_of(const struct making *m, uint32_t x, uint32_t y, bool back)
{
    const struct charts *charts = m->charts;
    const uint32_t place = ((back ? charts->height : 0) + y) * charts->width + x;
    if (m->number[place] == CHART_NONE) {
        m->number[place] = m->out->count;
        m->out->places[m->out->count++] = place;
    }
    return m->number[place];
}

// The four places of a bilinear lookup, whose middles are at ½.
static void add_lookup(const struct making *m, struct chart_seam_point *point, int chart, vec2s at)
{
    const float x = floorf(at.x - 0.5f), y = floorf(at.y - 0.5f);
    const float u = at.x - 0.5f - x, v = at.y - 0.5f - y;
    const float sign = chart == 0 ? 1.0f : -1.0f;
    for (uint32_t k = 0; k < 4; k++) {
        const uint32_t i = k & 1, j = k >> 1;
        point->place[4 * chart + (int)k] =
            number_of(m, (uint32_t)x + i, (uint32_t)y + j, point->back);
        point->weight[4 * chart + (int)k] = sign * (i ? u : 1.0f - u) * (j ? v : 1.0f - v);
    }
}

static void add_point(const struct making *m, const struct seam *seam, float along, float length,
                      bool back)
{
    struct chart_seam_point point = { .length = length,
                                      .triangle = { seam->triangle[0], seam->triangle[1] },
                                      .back = back };
    point.position = glms_vec3_lerp(seam->end[0][0].position, seam->end[0][1].position, along);
    for (int c = 0; m->number && c < 2; c++)
        add_lookup(m, &point, c,
                   glms_vec2_lerp(seam->end[c][0].place, seam->end[c][1].place, along));
    if (m->number) m->out->points[m->out->point_count] = point;
    m->out->point_count++;
}

static void add_seam(const struct making *m, const struct seam *seam)
{
    const struct charts *charts = m->charts;
    float length = 0.0f;
    bool back = true;
    for (int c = 0; c < 2; c++) {
        const struct end *end = seam->end[c];
        length = fmaxf(length, glms_vec2_distance(end[0].place, end[1].place));
        back &= charts->charts[charts->triangles[seam->triangle[c]].chart].first_back != CHART_NONE;
    }
    const uint32_t count = (uint32_t)fmaxf(ceilf(m->per_texel * length), 1.0f);
    const float part = length / (float)count;
    for (uint32_t i = 0; i < count; i++) {
        const float along = ((float)i + 0.5f) / (float)count;
        add_point(m, seam, along, part, false);
        if (back) add_point(m, seam, along, part, true);
    }
}

// Sides on one edge that are compared with each other, at most: several sheets may meet there.
enum { MOST_SIDES = 4 };

static void add_seams(const struct making *m)
{
    const struct charts *charts = m->charts;
    const uint32_t count = 3 * charts->triangle_count;
    struct seam seam;
    for (uint32_t i = 0; i < count; i++)
        for (uint32_t k = i + 1; k < count && k < i + MOST_SIDES; k++) {
            if (m->edges[k].key != m->edges[i].key) break;
            if (is_seam(charts, m->edges[i].side, m->edges[k].side, &seam)) add_seam(m, &seam);
        }
}

static bool make_points(struct making *m)
{
    struct chart_seams *out = m->out;
    const size_t size = charts_place_count(m->charts);
    add_seams(m);
    const size_t places = CHART_SEAM_PLACES * (size_t)out->point_count;
    out->points = host_alloc(out->host, out->point_count, sizeof *out->points);
    out->places = host_alloc(out->host, places < size ? places : size, sizeof *out->places);
    uint32_t *number = host_alloc(out->host, size, sizeof *number);
    const bool ok = out->points && out->places && number;
    if (ok) {
        memset(number, 0xff, size * sizeof *number);
        m->number = number;
        out->point_count = 0;
        add_seams(m);
    }
    host_free(out->host, number);
    return ok;
}

bool charts_seams_init(struct chart_seams *out, const struct charts *charts, float per_texel)
{
    *out = (struct chart_seams){ .host = charts->host };
    struct edge *edges = sorted_edges(charts->host, charts);
    struct making making = { out, charts, edges, per_texel, NULL };
    const bool ok = edges && make_points(&making);
    host_free(charts->host, edges);
    if (!ok) charts_seams_finish(out);
    return ok;
}

void charts_seams_finish(struct chart_seams *seams)
{
    if (!seams->host) return;
    host_free(seams->host, seams->points);
    host_free(seams->host, seams->places);
    *seams = (struct chart_seams){ 0 };
}
