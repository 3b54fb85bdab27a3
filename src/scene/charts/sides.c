// Texels of both sides: numbers, lookups, and nearest valid texels.
#include "scene/charts/sides.h"

#include <string.h>

static bool number_backs(struct charts *charts, const struct scene *scene)
{
    uint64_t count = charts->texel_count;
    for (uint32_t c = 0; c < charts->count; c++) {
        struct chart *chart = &charts->charts[c];
        const int material = scene_mesh_of(scene, chart->instance)->material;
        chart->first_back = CHART_NONE;
        if (!scene->materials[material].double_sided) continue;
        chart->first_back = (uint32_t)count;
        count += chart->texel_count;
    }
    charts->side_texel_count = (uint32_t)count; // at most twice the atlas
    charts->front_of =
        host_alloc(charts->host, count - charts->texel_count, sizeof *charts->front_of);
    if (!charts->front_of) return false;
    uint32_t *front = charts->front_of;
    for (uint32_t c = 0; c < charts->count; c++) {
        const struct chart *chart = &charts->charts[c];
        for (uint32_t i = 0; chart->first_back != CHART_NONE && i < chart->texel_count; i++)
            *front++ = chart->first_texel + i;
    }
    return true;
}

static bool index_triangles(struct charts *charts, const struct scene *scene)
{
    const size_t count = scene_triangle_count(scene);
    charts->triangle_0 =
        host_alloc(charts->host, (size_t)scene->instance_count + 1, sizeof *charts->triangle_0);
    charts->chart_triangle = host_alloc(charts->host, count, sizeof *charts->chart_triangle);
    if (!charts->triangle_0 || !charts->chart_triangle) return false;
    for (int i = 0; i < scene->instance_count; i++)
        charts->triangle_0[i + 1] =
            charts->triangle_0[i] + scene_mesh_of(scene, i)->index_count / 3;
    memset(charts->chart_triangle, 0xff, count * sizeof *charts->chart_triangle);
    for (uint32_t t = 0; t < charts->triangle_count; t++) {
        const struct chart_triangle *of = &charts->triangles[t];
        charts->chart_triangle[charts->triangle_0[of->instance] + of->triangle] = t;
    }
    return true;
}

bool make_chart_sides(struct charts *charts, const struct scene *scene)
{
    return number_backs(charts, scene) && index_triangles(charts, scene);
}

// ---- lookup

// The back of a chart's texel; CHART_NONE: it has none.
static uint32_t back_of(const struct chart *chart, uint32_t texel)
{
    return chart->first_back == CHART_NONE ? CHART_NONE
                                           : chart->first_back + (texel - chart->first_texel);
}

static const struct chart *chart_of(const struct charts *charts, uint32_t texel)
{
    return &charts->charts[chart_triangle_of(charts, texel)->chart];
}

static uint32_t clamp_to(float at, uint32_t first, uint32_t count)
{
    const float last = (float)(first + count - 1);
    return (uint32_t)(at < (float)first ? (float)first : at > last ? last : at);
}

uint32_t chart_texel_at(const struct charts *charts, int instance, uint32_t triangle, float u,
                        float v, bool back)
{
    const uint32_t at = charts->chart_triangle[charts->triangle_0[instance] + triangle];
    if (at == CHART_NONE) return CHART_NONE;
    const struct chart_triangle *t = &charts->triangles[at];
    const struct chart *chart = &charts->charts[t->chart];
    const float w = 1.0f - u - v;
    const float x = w * t->place[0].x + u * t->place[1].x + v * t->place[2].x;
    const float y = w * t->place[0].y + u * t->place[1].y + v * t->place[2].y;
    const uint32_t column = clamp_to(x, chart->x, chart->width);
    const uint32_t row = clamp_to(y, chart->y, chart->height);
    const uint32_t texel = charts->owner[(size_t)row * charts->width + column];
    return texel == CHART_NONE || !back ? texel : back_of(chart, texel);
}

uint32_t chart_texel_of_place(const struct charts *charts, size_t place)
{
    const size_t side = (size_t)charts->width * charts->height;
    const uint32_t texel = charts->owner[place % side];
    if (texel == CHART_NONE || place < side) return texel;
    return back_of(chart_of(charts, texel), texel);
}

// ---- hidden texels

struct filling {
    const struct charts *charts;
    uint32_t *nearest_valid, *next; // CHART_NONE: not known yet
};

// A neighbour's value of the last sweep: the first of those along the edges, then of the corners.
static uint32_t neighbor_value(const struct filling *f, uint32_t texel)
{
    static const int step[8][2] = { { 0, -1 },  { -1, 0 }, { 1, 0 },  { 0, 1 },
                                    { -1, -1 }, { 1, -1 }, { -1, 1 }, { 1, 1 } };
    const struct charts *charts = f->charts;
    const struct chart_texel *t = chart_texel_of(charts, texel);
    for (int k = 0; k < 8; k++) {
        // Gutters are at least as wide as the step.
        const size_t at = (size_t)((int64_t)t->y + step[k][1]) * charts->width +
                          (size_t)((int64_t)t->x + step[k][0]);
        uint32_t neighbor = charts->owner[at];
        if (neighbor == CHART_NONE) continue;
        if (chart_is_back(charts, texel)) neighbor = back_of(chart_of(charts, texel), neighbor);
        if (f->nearest_valid[neighbor] != CHART_NONE) return f->nearest_valid[neighbor];
    }
    return CHART_NONE;
}

static bool sweep(const struct filling *f)
{
    bool changed = false;
    for (uint32_t i = 0; i < f->charts->side_texel_count; i++) {
        f->next[i] = f->nearest_valid[i] != CHART_NONE ? f->nearest_valid[i] : neighbor_value(f, i);
        changed |= f->next[i] != f->nearest_valid[i];
    }
    return changed;
}

uint32_t *charts_fill(const struct charts *charts, const bool *hidden)
{
    const size_t count = charts->side_texel_count;
    struct filling f = { .charts = charts,
                         .nearest_valid = host_alloc(charts->host, count, sizeof *f.nearest_valid),
                         .next = host_alloc(charts->host, count, sizeof *f.next) };
    const bool ok = f.nearest_valid && f.next;
    if (ok) {
        for (uint32_t i = 0; i < count; i++) f.nearest_valid[i] = hidden[i] ? CHART_NONE : i;
        while (sweep(&f)) memcpy(f.nearest_valid, f.next, count * sizeof *f.nearest_valid);
        for (uint32_t i = 0; i < count; i++)
            if (f.nearest_valid[i] == CHART_NONE) f.nearest_valid[i] = i;
    }
    host_free(charts->host, f.next);
    if (ok) return f.nearest_valid;
    host_free(charts->host, f.nearest_valid);
    return NULL;
}
