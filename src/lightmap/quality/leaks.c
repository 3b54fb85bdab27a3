// Neighbouring texels that a surface divides.
#include "lightmap/quality/measures.h"

#include "core/parallel.h"
#include "trace/embree.h"

#include <math.h>

static const float DEVIATIONS = 3.0f; // of noise that the light differs by
static const float ONE_PLANE = 0.9f;  // cosine between the normals of two texels, at least
static const float LIFT = 0.25f;      // of segments above the surface, texels
static const float APART = 16.0f;     // between leaks that are listed, texels
enum { SEGMENTS = 8, RIGHT = 0, DOWN, DIRECTIONS };

struct leaks {
    const struct lightmap_quality *q;
    const struct lightmap *map;
    const struct gather_scene *scene;
    uint32_t *source; // [side_texel_count]
    float *step;      // [side_texel_count][DIRECTIONS] to the neighbour; 0: no leak
};

// The texel beside it in its chart; CHART_NONE: none.
static uint32_t neighbour(const struct charts *charts, uint32_t texel, int direction)
{
    const struct chart_texel *t = chart_texel_of(charts, texel);
    const uint32_t x = t->x + (direction == RIGHT), y = t->y + (direction == DOWN);
    if (x >= charts->width || y >= charts->height) return CHART_NONE;
    const uint32_t row = (chart_is_back(charts, texel) ? charts->height : 0) + y;
    const uint32_t found = chart_texel_of_place(charts, (size_t)row * charts->width + x);
    if (found == CHART_NONE) return CHART_NONE;
    const struct chart_texel *own = chart_texel_of(charts, found);
    const bool same =
        chart_triangle_of(charts, found)->chart == chart_triangle_of(charts, texel)->chart;
    return same && own->x == x && own->y == y ? found : CHART_NONE; // else of a gutter
}

static float variance_of(const struct lightmap *map, uint32_t texel)
{
    const float variance = map->texels[texel].variance;
    return variance > 0.0f ? variance : 0.0f; // NaN: not by paths
}

// The step of light between two texels if it counts, else 0.
static float step_between(const struct leaks *l, uint32_t texel, uint32_t other)
{
    const struct charts *charts = &l->map->charts;
    const float a = quality_light(l->map, quality_place(charts, texel)),
                b = quality_light(l->map, quality_place(charts, other));
    const float step = quality_step_of(l->q, a, b);
    const float noise =
        sqrtf(variance_of(l->map, l->source[texel]) + variance_of(l->map, l->source[other]));
    return step >= QUALITY_LEAK_STEP && fabsf(a - b) > DEVIATIONS * noise ? step : 0.0f;
}

static vec3s above(const struct leaks *l, const struct gather_points *points, int k)
{
    const struct gather_point *point = &points->at[k % points->count];
    const struct surface surface = gather_surface(l->scene, point, points->back);
    return glms_vec3_muladds(surface.geometric, LIFT / l->map->charts.texels_per_m,
                             surface.position);
}

static bool is_divided(const struct leaks *l, uint32_t texel, uint32_t other)
{
    struct gather_points a, b;
    int divided = 0;
    gather_find_points(l->scene, texel, &a);
    gather_find_points(l->scene, other, &b);
    if (a.count == 0 || b.count == 0) return false;
    for (int k = 0; k < SEGMENTS; k++) {
        const vec3s from = above(l, &a, k), to = above(l, &b, k);
        divided += trace_occluded(l->scene->trace, from, glms_vec3_sub(to, from), 1.0f);
    }
    return 2 * divided >= SEGMENTS;
}

static float leak_between(const struct leaks *l, uint32_t texel, uint32_t other)
{
    const struct charts *charts = &l->map->charts;
    // Filled texels have the light of others.
    const uint32_t a = l->source[texel], b = l->source[other];
    const bool both_filled = a != texel && b != other;
    if (a == b || both_filled) return 0.0f;
    if (glms_vec3_dot(chart_texel_normal(charts, a), chart_texel_normal(charts, b)) < ONE_PLANE)
        return 0.0f;
    const float step = step_between(l, texel, other);
    return step > 0.0f && is_divided(l, a, b) ? step : 0.0f;
}

static void find_leaks(void *user, size_t i)
{
    const struct leaks *l = user;
    const unsigned before = embree_flush_denormals();
    for (int d = 0; d < DIRECTIONS; d++) {
        const uint32_t other = neighbour(&l->map->charts, (uint32_t)i, d);
        if (other != CHART_NONE)
            l->step[DIRECTIONS * i + (size_t)d] = leak_between(l, (uint32_t)i, other);
    }
    embree_restore_denormals(before);
}

static void add_leak(struct lightmap_quality *q, const struct lightmap *map, uint32_t texel,
                     uint32_t other, float step)
{
    const struct charts *charts = &map->charts;
    const uint32_t chart = chart_triangle_of(charts, texel)->chart;
    q->leaks.step[texel] = fmaxf(q->leaks.step[texel], step);
    q->leaks.step[other] = fmaxf(q->leaks.step[other], step);
    const struct quality_step leak = {
        .step = step,
        .before = step,
        .light = { quality_light(map, quality_place(charts, texel)),
                   quality_light(map, quality_place(charts, other)) },
        .position = glms_vec3_lerp(chart_texel_of(charts, texel)->position,
                                   chart_texel_of(charts, other)->position, 0.5f),
        .chart = { chart, chart },
        .back = chart_is_back(charts, texel)
    };
    quality_add(&q->leaks.worst, &leak, APART / charts->texels_per_m);
}

static void add_up(struct lightmap_quality *q, const struct leaks *l)
{
    const uint32_t count = l->map->charts.side_texel_count;
    for (uint32_t i = 0; i < count; i++)
        for (int d = 0; d < DIRECTIONS; d++) {
            const float step = l->step[DIRECTIONS * (size_t)i + (size_t)d];
            if (step > 0.0f) add_leak(q, l->map, i, neighbour(&l->map->charts, i, d), step);
        }
    for (uint32_t i = 0; i < count; i++) q->leaks.texels += q->leaks.step[i] > 0.0f;
}

bool quality_measure_leaks(struct lightmap_quality *q, const struct lightmap *map,
                           const struct gather_scene *scene)
{
    const size_t count = map->charts.side_texel_count;
    struct leaks l = { .q = q,
                       .map = map,
                       .scene = scene,
                       .source = lightmap_sources(map),
                       .step = host_alloc(q->host, DIRECTIONS * count, sizeof *l.step) };
    q->leaks.step = host_alloc(q->host, count, sizeof *q->leaks.step);
    const bool ok = l.source && l.step && q->leaks.step;
    if (ok) parallel_for(count, 64, find_leaks, &l);
    if (ok) add_up(q, &l);
    host_free(q->host, l.source);
    host_free(q->host, l.step);
    return ok;
}
