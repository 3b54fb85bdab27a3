// Light of places, and the largest differences of it.
#include "lightmap/quality/measures.h"

#include <math.h>

float quality_light(const struct lightmap *map, uint32_t place)
{
    const size_t places = (size_t)map->charts.width * map->charts.height;
    const float *pixel = map->irradiance[place / places].pixels + 3 * (place % places);
    return luminance(vec3_of(pixel[0], pixel[1], pixel[2]));
}

uint32_t quality_place(const struct charts *charts, uint32_t texel)
{
    const struct chart_texel *t = chart_texel_of(charts, texel);
    const uint32_t row = (chart_is_back(charts, texel) ? charts->height : 0) + t->y;
    return row * charts->width + t->x;
}

float quality_step_of(const struct lightmap_quality *q, float a, float b)
{
    const float larger = fmaxf(fmaxf(a, b), q->least_light);
    return larger > 0.0f ? fabsf(a - b) / larger : 0.0f;
}

// ---- the largest steps

static bool is_same_place(const struct quality_step *a, const struct quality_step *b, float near)
{
    return a->chart[0] == b->chart[0] && a->chart[1] == b->chart[1] && a->back == b->back &&
           (a->chart[0] != a->chart[1] || glms_vec3_distance(a->position, b->position) < near);
}

void quality_add(struct quality_steps *steps, const struct quality_step *step, float near)
{
    int at = 0, end = steps->count;
    while (at < steps->count && steps->at[at].step >= step->step)
        if (is_same_place(&steps->at[at++], step, near)) return;
    if (at == QUALITY_WORST) return;
    // A smaller one of the same place goes.
    for (int i = at; i < steps->count && end == steps->count; i++)
        if (is_same_place(&steps->at[i], step, near)) end = i;
    if (end == QUALITY_WORST) end = QUALITY_WORST - 1;
    if (end == steps->count) steps->count++;
    for (int i = end; i > at; i--) steps->at[i] = steps->at[i - 1];
    steps->at[at] = *step;
}
