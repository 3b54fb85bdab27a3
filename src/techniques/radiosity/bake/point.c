// Where a texel is sampled: in its middle, or where that is inside of something, beside it. A texel
// of a ledge whose larger part is in a wall still has light.
#include "techniques/radiosity/bake/gather.h"

#include "core/rng.h"
#include "core/sampling.h"

#include <math.h>

enum { ACROSS = 8, PROBES = 16 };

static bool meets_back(const struct radiosity_scene *scene, vec3s from, vec3s direction)
{
    const struct ray ray = { from, direction, 0.0f, INFINITY };
    struct ray_hit hit;
    if (!embree_closest(scene->trace->embree, &ray, NULL, false, &hit)) return false;
    const struct trace_mesh *mesh = &scene->trace->meshes[hit.geometry];
    return !mesh->material->double_sided &&
           glms_vec3_dot(mesh->facets[hit.triangle].normal, direction) > 0.0f;
}

// Whether more than `most` of the rays from a point meet the back of single-sided surfaces.
static bool meets_backs(const struct radiosity_scene *scene, uint32_t texel, vec3s at, int most)
{
    const struct chart_texel *t = radiosity_chart_texel(&scene->map, texel);
    const struct chart_triangle *of = &scene->map.charts.triangles[t->triangle];
    const struct trace_mesh *mesh = &scene->trace->meshes[scene->mesh_of[of->instance]];
    const vec3s normal = scene->map.texels[texel].normal;
    const float reach = mesh->facets[of->triangle].reach;
    const vec3s from = glms_vec3_muladds(normal, reach, at);
    vec3s u, v;
    int behind = 0;
    basis_of(normal, &u, &v);
    for (uint32_t k = 0; k < PROBES && behind <= most; k++) {
        const vec3s local = sample_hemisphere_cosine(sobol_2d(k, 1));
        vec3s direction = glms_vec3_scale(normal, local.z);
        direction = glms_vec3_muladds(u, local.x, direction);
        direction = glms_vec3_muladds(v, local.y, direction);
        behind += meets_back(scene, from, direction);
    }
    return behind > most;
}

bool radiosity_is_inside(const struct radiosity_scene *scene, uint32_t texel, vec3s at)
{
    return meets_backs(scene, texel, at, PROBES / 2);
}

static vec3s point_of(const struct chart_triangle *t, float u, float v)
{
    vec3s p = glms_vec3_scale(t->corner[0], 1.0f - u - v);
    p = glms_vec3_muladds(t->corner[1], u, p);
    return glms_vec3_muladds(t->corner[2], v, p);
}

struct search {
    const struct radiosity_scene *scene;
    const struct chart_triangle *triangle;
    uint32_t texel;
    int most; // rays that may meet backs
    int tried, open;
    vec3s found[ACROSS * ACROSS]; // points that are open
};

static void try_point(struct search *s, float u, float v)
{
    const vec3s at = point_of(s->triangle, u, v);
    s->tried++;
    if (s->open < ACROSS * ACROSS && !meets_backs(s->scene, s->texel, at, s->most))
        s->found[s->open++] = at;
}

static void try_grid(struct search *s, const struct chart_texel *t, int across)
{
    s->tried = 1; // the middle
    for (int i = 0; i < across * across; i++) {
        const float x = (float)t->x + ((float)(i % across) + 0.5f) / (float)across;
        const float y = (float)t->y + ((float)(i / across) + 0.5f) / (float)across;
        float u, v;
        if (radiosity_weigh(s->triangle, x, y, &u, &v)) try_point(s, u, v);
    }
}

// A spot has no extent in the atlas: the middles of its triangles.
static void try_spot(struct search *s, const struct chart *chart)
{
    const uint32_t step = 1 + chart->triangle_count / (ACROSS * ACROSS);
    s->tried = 1;
    for (uint32_t i = 0; i < chart->triangle_count; i += step) {
        s->triangle = &s->scene->map.charts.triangles[chart->first_triangle + i];
        try_point(s, 1.0f / 3.0f, 1.0f / 3.0f);
    }
}

static void try_texel(struct search *s, const struct chart_texel *t, const struct chart *chart,
                      int across)
{
    if (chart->spot)
        try_spot(s, chart);
    else
        try_grid(s, t, across);
}

// The open point nearest to the middle of them all.
static struct radiosity_point middle_of(const struct search *s, float share)
{
    vec3s middle = vec3_of(0, 0, 0);
    struct radiosity_point point = { s->found[0], share };
    for (int i = 0; i < s->open; i++) middle = glms_vec3_add(middle, s->found[i]);
    middle = glms_vec3_divs(middle, (float)s->open);
    for (int i = 1; i < s->open; i++)
        if (glms_vec3_distance2(s->found[i], middle) < glms_vec3_distance2(point.position, middle))
            point.position = s->found[i];
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
// the open share of the texel.
static float try_edges(struct search *s, const struct chart_texel *t)
{
    static const float INSET[] = { 1.0f / 32, 1.0f / 128 };
    for (int i = 0; i < 2; i++) {
        s->tried = 0;
        for (int k = 0; k < 3; k++) try_edge(s, t, k, INSET[i]);
        if (s->open > 0) return 2.0f * INSET[i] * (float)s->open / (float)s->tried;
    }
    return 0.0f;
}

// Where solids overlap, rays from inside of one meet the front of the other: points that meet no
// back at all are preferred to those that meet some.
struct radiosity_point radiosity_find_point(const struct radiosity_scene *scene, uint32_t texel)
{
    const struct chart_texel *t = radiosity_chart_texel(&scene->map, texel);
    struct search s = { .scene = scene,
                        .triangle = &scene->map.charts.triangles[t->triangle],
                        .texel = texel };
    const struct chart *chart = &scene->map.charts.charts[s.triangle->chart];
    if (!meets_backs(scene, texel, t->position, 0))
        return (struct radiosity_point){ t->position, 1.0f };
    const bool inside = radiosity_is_inside(scene, texel, t->position);
    try_texel(&s, t, chart, inside ? ACROSS : ACROSS / 2);
    if (s.open == 0 && !inside) return (struct radiosity_point){ t->position, 1.0f };
    s.most = PROBES / 2;
    if (s.open == 0) try_texel(&s, t, chart, ACROSS);
    if (s.open > 0) return middle_of(&s, (float)s.open / (float)s.tried);
    const float share = chart->spot ? 0.0f : try_edges(&s, t);
    if (s.open > 0) return middle_of(&s, share);
    return (struct radiosity_point){ t->position, 0.0f };
}
