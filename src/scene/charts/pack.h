// Places the rectangles of charts in an atlas.
#pragma once

#include "scene/charts/charts.h"

// Sets x and y of charts, whose width and height are set, and the size of the atlas: at most
// max_texels and CHART_MAX_SIDE. *packed: they fit. False without memory.
bool pack_charts(struct charts *charts, uint32_t max_texels, bool *packed);
