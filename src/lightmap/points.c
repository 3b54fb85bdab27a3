// Sample points of a texel.
#include "lightmap/gather.h"

#include "core/rng.h"
#include "core/sampling.h"
#include "scene/charts/raster.h"
#include "trace/texels/inside.h"
#include "trace/texels/texels.h"

#include <math.h>

// ---- triangles of texels

static void range_of(const struct raster_polygon *polygon, int axis, uint32_t *low, uint32_t *high)
{
    double least = INFINITY, most = -INFINITY;
    for (int i = 0; i < polygon->count; i++) {
        least = fmin(least, polygon->at[i][axis]);
        most = fmax(most, polygon->at[i][axis]);
    }
    *low = (uint32_t)least; // places are inside of the atlas
    *high = (uint32_t)most + 1;
}

// Calls with `list` NULL count, later ones fill.
static void visit_triangle(const struct charts *charts, uint32_t triangle, uint32_t *first,
                           uint32_t *list)
{
    const struct raster_polygon whole = raster_polygon_of(charts->triangles[triangle].place);
    uint32_t top, bottom, left, right;
    range_of(&whole, 1, &top, &bottom);
    for (uint32_t y = top; y < bottom && y < charts->height; y++) {
        const struct raster_polygon row = raster_clip(&whole, 1, (double)y);
        if (row.count < 3) continue;
        range_of(&row, 0, &left, &right);
        for (uint32_t x = left; x < right && x < charts->width; x++) {
            const uint32_t texel = charts->owner[(size_t)y * charts->width + x];
            if (texel == CHART_NONE || charts->texels[texel].x != x || charts->texels[texel].y != y)
                continue; // a gutter
            if (list) list[first[texel]] = triangle;
            first[texel]++;
        }
    }
}

bool gather_list_triangles(struct gather_scene *s)
{
    const struct charts *charts = s->charts;
    const uint32_t count = charts->texel_count;
    s->first = host_alloc(s->host, (size_t)count + 2, sizeof *s->first);
    if (!s->first) return false;
    // Counted two places further, so that filling leaves the first index of each texel.
    for (uint32_t t = 0; t < charts->triangle_count; t++)
        visit_triangle(charts, t, s->first + 2, NULL);
    for (uint32_t i = 0; i < count; i++) s->first[i + 2] += s->first[i + 1];
    s->meeting = host_alloc(s->host, s->first[count + 1], sizeof *s->meeting);
    for (uint32_t t = 0; s->meeting && t < charts->triangle_count; t++)
        visit_triangle(charts, t, s->first + 1, s->meeting);
    return s->meeting;
}

// ---- points

static bool weigh(const struct chart_triangle *t, double x, double y, struct gather_point *out)
{
    double area[3], sum = 0.0;
    for (int k = 0; k < 3; k++) {
        struct raster_triangle part;
        for (int c = 0; c < 3; c++) {
            part.at[c][0] = c == k ? x : (double)t->place[c].x;
            part.at[c][1] = c == k ? y : (double)t->place[c].y;
        }
        area[k] = raster_area2(&part);
        sum += area[k];
    }
    for (int k = 0; k < 3; k++)
        if (!(area[k] / sum >= 0.0)) return false;
    out->u = (float)(area[1] / sum);
    out->v = (float)(area[2] / sum);
    return true;
}

static bool find_triangle(const struct gather_scene *s, uint32_t texel, double x, double y,
                          struct gather_point *out)
{
    for (uint32_t i = s->first[texel]; i < s->first[texel + 1]; i++) {
        out->triangle = s->meeting[i];
        if (weigh(&s->charts->triangles[out->triangle], x, y, out)) return true;
    }
    return false;
}

struct surface gather_surface(const struct gather_scene *s, const struct gather_point *point,
                              bool back)
{
    const struct chart_triangle *t = &s->charts->triangles[point->triangle];
    const struct trace_mesh *mesh = trace_mesh_of(s->trace, t->instance);
    struct surface surface;
    const vec3s front = mesh->facets[t->triangle].normal;
    texel_surface(s->trace, t, point->u, point->v, back ? glms_vec3_negate(front) : front,
                  &surface);
    uint32_t corner[3];
    trace_corners(mesh, t->triangle, corner);
    vec3s n = glms_vec3_scale(mesh->vertices[corner[0]].normal, 1.0f - point->u - point->v);
    n = glms_vec3_muladds(mesh->vertices[corner[1]].normal, point->u, n);
    n = vec3_unit(glms_vec3_muladds(mesh->vertices[corner[2]].normal, point->v, n));
    if (back) n = glms_vec3_negate(n);
    surface.normal = glms_vec3_dot(n, surface.geometric) > 0.0f ? n : surface.geometric;
    surface.material = (struct bsdf_material){ .albedo = vec3_of(1, 1, 1), .roughness = 1.0f };
    surface.emission = vec3_of(0, 0, 0);
    surface.unlit = false;
    return surface;
}

// Points whose first rays meet no back are not inside.
enum { FIRST_RAYS = 4 };

static bool is_point_inside(const struct gather_scene *s, const struct gather_point *point,
                            bool back)
{
    const struct surface surface = gather_surface(s, point, back);
    const vec3s normal = surface.geometric, from = surface_leave(&surface, normal);
    const int backs = inside_backs(s->trace, from, normal, 0, FIRST_RAYS);
    return backs > 0 &&
           is_inside(backs + inside_backs(s->trace, from, normal, FIRST_RAYS, INSIDE_RAYS),
                     INSIDE_RAYS);
}

static void add_point(const struct gather_scene *s, const struct gather_point *point, bool known,
                      struct gather_points *out)
{
    if (known || !is_point_inside(s, point, out->back)) out->at[out->count++] = *point;
}

// The triangle at a share of the chart's area.
static uint32_t triangle_at(const struct charts *charts, const struct chart *chart, float share)
{
    uint32_t t = chart->first_triangle;
    const uint32_t last = t + chart->triangle_count - 1;
    float rest = share * chart->area_m2;
    while (t < last && rest >= charts->triangles[t].area_m2) rest -= charts->triangles[t++].area_m2;
    return t;
}

// All corners of a single-texel chart are at one place: its points are spread over its surface.
static void find_scattered_points(const struct gather_scene *s, const struct chart *chart,
                                  bool known, struct gather_points *out)
{
    for (uint32_t k = 0; k < GATHER_POINTS; k++) {
        const vec2s at = sample_triangle(sobol_2d(k, pcg_hash(out->pixel) | 1u));
        const float share = ((float)k + 0.5f) / GATHER_POINTS;
        add_point(s, &(struct gather_point){ triangle_at(s->charts, chart, share), at.x, at.y },
                  known, out);
    }
}

// known: none is inside geometry.
static void find_points(const struct gather_scene *s, uint32_t texel, bool known,
                        struct gather_points *out)
{
    const struct chart_texel *t = chart_texel_of(s->charts, texel);
    const struct chart *chart = &s->charts->charts[s->charts->triangles[t->triangle].chart];
    bool covered = false;
    out->count = 0;
    out->pixel = chart_front(s->charts, texel);
    out->back = chart_is_back(s->charts, texel);
    if (chart->single_texel) {
        find_scattered_points(s, chart, known, out);
        return;
    }
    for (uint32_t k = 0; k < GATHER_POINTS; k++) {
        struct gather_point point;
        // The first 16 points of the sequence are one in each square of a 4 × 4 grid.
        const vec2s at = sobol_2d(k, pcg_hash(out->pixel) | 1u);
        if (!find_triangle(s, out->pixel, (double)t->x + (double)at.x, (double)t->y + (double)at.y,
                           &point))
            continue;
        covered = true;
        add_point(s, &point, known, out);
    }
    if (!covered) // a sliver
        add_point(s, &(struct gather_point){ t->triangle, t->u, t->v }, known, out);
}

void gather_find_points(const struct gather_scene *s, uint32_t texel, struct gather_points *out)
{
    find_points(s, texel, false, out);
}

void gather_find_open_points(const struct gather_scene *s, uint32_t texel,
                             struct gather_points *out)
{
    find_points(s, texel, true, out);
}
