// The sample point of a texel: its middle, or where that is inside geometry, a point beside it. A
// texel of a ledge whose larger part is in a wall still has light.
#include "trace/texels/inside.h"
#include "trace/texels/texels.h"
#include "trace/trace_scene.h"

#include <limits.h>
#include <math.h>

enum { ACROSS = 8, MOST_TRIANGLES = 16 };

struct probe {
    const struct trace_scene *scene;
    vec3s from, normal;
};

static struct probe probe_at(const struct trace_scene *scene, const struct charts *charts,
                             uint32_t texel, vec3s at)
{
    const struct chart_triangle *of = chart_triangle_of(charts, texel);
    const vec3s normal = chart_texel_normal(charts, texel);
    const float reach = trace_mesh_of(scene, of->instance)->facets[of->triangle].reach;
    return (struct probe){ scene, glms_vec3_muladds(normal, reach, at), normal };
}

static int count_backs(const struct probe *p)
{
    return inside_backs(p->scene, p->from, p->normal, 0, INSIDE_RAYS);
}

static int count_crossings(const struct probe *p)
{
    return inside_crossings(p->scene, p->from, p->normal);
}

bool texel_is_inside(const struct trace_scene *scene, const struct charts *charts, uint32_t texel,
                     vec3s at)
{
    const struct probe p = probe_at(scene, charts, texel, at);
    return inside_solid(scene, p.from, p.normal);
}

static vec3s point_of(const struct chart_triangle *t, float u, float v)
{
    vec3s p = glms_vec3_scale(t->corner[0], 1.0f - u - v);
    p = glms_vec3_muladds(t->corner[1], u, p);
    return glms_vec3_muladds(t->corner[2], v, p);
}

struct search {
    const struct trace_scene *scene;
    const struct charts *charts;
    const struct chart_triangle *triangle;
    uint32_t texel;
    int tried;
    int count; // of points in the texel's triangle
    struct {
        vec3s at;
        int crossings;
    } points[ACROSS * ACROSS];
};

static void try_point(struct search *s, float u, float v)
{
    const vec3s at = point_of(s->triangle, u, v);
    s->tried++;
    if (s->count == ACROSS * ACROSS) return;
    const struct probe p = probe_at(s->scene, s->charts, s->texel, at);
    s->points[s->count].at = at;
    s->points[s->count++].crossings = count_crossings(&p);
}

// Triangles of the texel in the plane of its own one, which is the first. Returns their number.
static int triangles_of(const struct search *s, const struct chart_texel *t,
                        const struct chart *chart, const struct chart_triangle *out[MOST_TRIANGLES])
{
    static const float COPLANAR = 0.9999f;
    int count = 0;
    out[count++] = s->triangle;
    for (uint32_t i = 0; i < chart->triangle_count && count < MOST_TRIANGLES; i++) {
        const struct chart_triangle *c = &s->charts->triangles[chart->first_triangle + i];
        const vec2s low = glms_vec2_minv(glms_vec2_minv(c->place[0], c->place[1]), c->place[2]);
        const vec2s high = glms_vec2_maxv(glms_vec2_maxv(c->place[0], c->place[1]), c->place[2]);
        if (c == s->triangle || high.x < (float)t->x || low.x > (float)t->x + 1.0f ||
            high.y < (float)t->y || low.y > (float)t->y + 1.0f ||
            glms_vec3_dot(c->normal, s->triangle->normal) < COPLANAR)
            continue;
        out[count++] = c;
    }
    return count;
}

static void try_grid(struct search *s, const struct chart_texel *t, const struct chart *chart,
                     int across)
{
    const struct chart_triangle *const own = s->triangle, *of[MOST_TRIANGLES];
    const int count = triangles_of(s, t, chart, of);
    s->tried = 1; // the middle
    for (int i = 0; i < across * across; i++) {
        const float x = (float)t->x + ((float)(i % across) + 0.5f) / (float)across;
        const float y = (float)t->y + ((float)(i / across) + 0.5f) / (float)across;
        float u, v;
        int k = 0;
        while (k < count && !texel_weigh(of[k], x, y, &u, &v)) k++;
        if (k == count) continue;
        s->triangle = of[k];
        try_point(s, u, v);
    }
    s->triangle = own;
}

// A single-texel chart has no extent in the atlas: tries the middles of its triangles.
static void try_triangles(struct search *s, const struct chart *chart)
{
    const uint32_t step = 1 + chart->triangle_count / (ACROSS * ACROSS);
    s->tried = 1;
    for (uint32_t i = 0; i < chart->triangle_count; i += step) {
        s->triangle = &s->charts->triangles[chart->first_triangle + i];
        try_point(s, 1.0f / 3.0f, 1.0f / 3.0f);
    }
}

static void try_texel(struct search *s, const struct chart_texel *t, const struct chart *chart,
                      int across)
{
    if (chart->single_texel)
        try_triangles(s, chart);
    else
        try_grid(s, t, chart, across);
}

static int least_crossings(const struct search *s)
{
    int least = INT_MAX;
    for (int i = 0; i < s->count; i++)
        if (s->points[i].crossings < least) least = s->points[i].crossings;
    return least;
}

vec3s texel_above(const struct charts *charts, uint32_t texel, vec3s at)
{
    static const float HEIGHT = 0.25f; // in texels
    return glms_vec3_muladds(chart_texel_normal(charts, texel), HEIGHT / charts->texels_per_m, at);
}

bool texel_sees(const struct trace_scene *scene, const struct charts *charts, uint32_t texel,
                vec3s from, vec3s to)
{
    const vec3s way = glms_vec3_sub(to, from);
    return glms_vec3_norm2(way) == 0.0f ||
           !trace_occluded(scene, texel_above(charts, texel, from), way, 1.0f);
}

// A wall divides the texel if the first open point does not see all others: keeps those on the side
// that has more of them. The order stays.
static void keep_larger_side(struct search *s)
{
    bool seen[ACROSS * ACROSS];
    int seen_count = 0, kept = 0;
    for (int i = 0; i < s->count; i++) {
        seen[i] = texel_sees(s->scene, s->charts, s->texel, s->points[0].at, s->points[i].at);
        seen_count += seen[i];
    }
    const bool side = 2 * seen_count >= s->count;
    for (int i = 0; i < s->count; i++)
        if (seen[i] == side) s->points[kept++] = s->points[i];
    s->count = kept;
}

static void keep_open(struct search *s, int most)
{
    int kept = 0;
    for (int i = 0; i < s->count; i++)
        if (s->points[i].crossings <= most) s->points[kept++] = s->points[i];
    s->count = kept;
}

// The point nearest to the mean of all points with at most `most` crossings on one side of walls,
// and the share that those on all sides have.
static struct texel_point middle_of(struct search *s, int most)
{
    vec3s middle = vec3_of(0, 0, 0);
    struct texel_point point = { .share = 0.0f };
    float nearest = INFINITY;
    keep_open(s, most);
    point.share = (float)s->count / (float)s->tried;
    keep_larger_side(s);
    for (int i = 0; i < s->count; i++) middle = glms_vec3_add(middle, s->points[i].at);
    middle = glms_vec3_divs(middle, (float)s->count);
    for (int i = 0; i < s->count; i++) {
        const float distance2 = glms_vec3_distance2(s->points[i].at, middle);
        if (distance2 >= nearest) continue;
        nearest = distance2;
        point.position = s->points[i].at;
    }
    return point;
}

// The part of the segment a…b that is in the texel; false: none is.
static bool clip(const struct chart_texel *t, vec2s a, vec2s b, float range[2])
{
    const float low[2] = { (float)t->x, (float)t->y };
    range[0] = 0.0f;
    range[1] = 1.0f;
    for (int axis = 0; axis < 2; axis++) {
        const float along = b.raw[axis] - a.raw[axis];
        const float from = low[axis] - a.raw[axis], to = from + 1.0f;
        if (along == 0.0f && (from > 0.0f || to < 0.0f)) return false;
        if (along == 0.0f) continue;
        range[0] = fmaxf(range[0], fminf(from / along, to / along));
        range[1] = fminf(range[1], fmaxf(from / along, to / along));
    }
    return range[0] < range[1];
}

// Points of the texel at `inset` texels from the triangle's edge k, towards the opposite corner.
static void try_edge(struct search *s, const struct chart_texel *t, int k, float inset)
{
    const vec2s a = s->triangle->place[(k + 1) % 3], b = s->triangle->place[(k + 2) % 3];
    const vec2s c = s->triangle->place[k], ab = glms_vec2_sub(b, a), ac = glms_vec2_sub(c, a);
    const float height = fabsf(ab.x * ac.y - ab.y * ac.x) / glms_vec2_norm(ab);
    const float inwards = fminf(inset / height, 1.0f / 3.0f);
    float range[2];
    if (!clip(t, a, b, range)) return;
    for (int i = 0; i < ACROSS; i++) {
        const float part = ((float)i + 0.5f) / ACROSS;
        const float along = range[0] + (range[1] - range[0]) * part;
        float weight[3];
        weight[k] = inwards;
        weight[(k + 1) % 3] = (1.0f - inwards) * (1.0f - along);
        weight[(k + 2) % 3] = (1.0f - inwards) * along;
        try_point(s, weight[1], weight[2]);
    }
}

// A ledge that is thinner than the grid's steps is open along the edges of its triangles. Returns
// the part of the texel that such points stand for; 0: none is open.
static float try_edges(struct search *s, const struct chart_texel *t, int most)
{
    static const float INSET[] = { 1.0f / 32, 1.0f / 128 };
    for (int i = 0; i < 2; i++) {
        s->tried = s->count = 0;
        for (int k = 0; k < 3; k++) try_edge(s, t, k, INSET[i]);
        if (least_crossings(s) <= most) return 2.0f * INSET[i];
    }
    return 0.0f;
}

// Points of a texel are compared with each other: rooms whose walls are single sheets have fewer
// crossings than the open.
struct texel_point texel_find_point(const struct trace_scene *scene, const struct charts *charts,
                                    uint32_t texel)
{
    const struct chart_texel *t = chart_texel_of(charts, texel);
    struct search s = { .scene = scene,
                        .charts = charts,
                        .triangle = &charts->triangles[t->triangle],
                        .texel = texel };
    const struct chart *chart = &charts->charts[s.triangle->chart];
    const struct texel_point middle = { t->position, 1.0f };
    const struct probe p = probe_at(scene, charts, texel, t->position);
    const int backs = count_backs(&p), crossings = count_crossings(&p);
    if (backs == 0 && crossings <= INSIDE_CROSSINGS / 2) return middle;
    const bool inside = is_inside(backs, INSIDE_RAYS) || crossings > INSIDE_CROSSINGS / 2;
    const int most =
        crossings - INSIDE_CROSSINGS / 2 - 1; // of points that are outside of one solid more
    try_texel(&s, t, chart, inside ? ACROSS : ACROSS / 2);
    if (least_crossings(&s) <= most) return middle_of(&s, most);
    if (!inside) return middle;
    const float part = chart->single_texel ? 0.0f : try_edges(&s, t, most);
    if (part == 0.0f) return (struct texel_point){ t->position, 0.0f };
    struct texel_point point = middle_of(&s, most);
    point.share *= part;
    return point;
}
