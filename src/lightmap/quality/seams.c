// Steps of light at edges that two charts share.
#include "lightmap/quality/measures.h"

#include <math.h>

// Texels along an edge. Shorter edges are of parts that share a texel.
static const float SHORT = 0.01f;
// A lookup with less weight of open texels is inside geometry, where nobody looks.
static const float HALF = 0.5f;

struct sides {
    float light[2]; // of the two charts' lookups
    float open[2];  // weight of texels that are not filled
};

static void add_to(struct sides *sides, float weight, float light, bool open)
{
    const int side = weight < 0.0f;
    sides->light[side] += fabsf(weight) * light;
    if (open) sides->open[side] += fabsf(weight);
}

static bool is_open(const struct lightmap *map, uint32_t place)
{
    const uint32_t texel = chart_texel_of_place(&map->charts, place);
    return texel != CHART_NONE && map->texels[texel].open > 0.0f;
}

static void add_state(const struct lightmap_quality *q, struct quality_seam_state *state,
                      const struct sides *sides, double length)
{
    const double step = (double)quality_step_of(q, sides->light[0], sides->light[1]);
    state->mean += step * length; // divided by the length of all later
    state->largest = fmax(state->largest, step);
    if (step > (double)QUALITY_SEAM_STEP) state->above += length;
}

static void divide(struct quality_seam_state *state, double length)
{
    state->mean /= length;
    state->above /= length;
}

static void add_point(struct lightmap_quality *q, const struct lightmap *map,
                      const struct seam_closing *closing, const struct chart_seam_point *point)
{
    const struct chart_triangle *triangles = map->charts.triangles;
    struct sides before = { 0 }, after = { 0 };
    if (point->length < SHORT) return;
    for (int k = 0; k < CHART_SEAM_PLACES; k++) {
        const uint32_t place = closing->seams.places[point->place[k]];
        const bool open = is_open(map, place);
        add_to(&before, point->weight[k], q->seams.before[point->place[k]], open);
        add_to(&after, point->weight[k], quality_light(map, place), open);
    }
    if (after.open[0] < HALF || after.open[1] < HALF) return; // inside geometry
    const uint32_t chart[2] = { triangles[point->triangle[0]].chart,
                                triangles[point->triangle[1]].chart };
    const int first = chart[0] > chart[1]; // a pair has one order
    add_state(q, &q->seams.unclosed, &before, (double)point->length);
    add_state(q, &q->seams.closed, &after, (double)point->length);
    q->seams.texels += (double)point->length;
    const struct quality_step step = { .step = quality_step_of(q, after.light[0], after.light[1]),
                                       .before =
                                           quality_step_of(q, before.light[0], before.light[1]),
                                       .light = { after.light[first], after.light[!first] },
                                       .position = point->position,
                                       .chart = { chart[first], chart[!first] },
                                       .back = point->back };
    quality_add(&q->seams.worst, &step, 0.0f);
}

void quality_measure_seams(struct lightmap_quality *q, const struct lightmap *map,
                           const struct seam_closing *closing)
{
    for (uint32_t i = 0; i < closing->seams.point_count; i++)
        add_point(q, map, closing, &closing->seams.points[i]);
    if (!(q->seams.texels > 0.0)) return;
    divide(&q->seams.unclosed, q->seams.texels);
    divide(&q->seams.closed, q->seams.texels);
}
