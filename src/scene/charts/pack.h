// Places charts in an atlas, turned by quarters.
#pragma once

#include "scene/charts/grow.h"

// Sets the rectangle and the quarter turns of charts, whose numbers of triangles are set, and the
// size of the atlas: at most max_texels and CHART_MAX_SIDE. Rounds the places of `grown` so that
// they are exact as floats anywhere in the atlas. *packed: they fit. False without memory.
bool pack_charts(struct charts *charts, struct grown *grown, uint32_t max_texels, bool *packed);
// A place of a chart's own frame, gutters included, in the atlas.
void pack_place(const struct chart *chart, const double place[2], double out[2]);

// The order of packing: group by group, in each the largest charts first.
struct pack_item {
    uint32_t group, longer, shorter, chart;
};
struct pack_item pack_item_of(const struct charts *charts, uint32_t chart, uint32_t group);
void pack_sort(struct pack_item *items, uint32_t count);
