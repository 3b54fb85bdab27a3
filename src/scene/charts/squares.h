// Another order of a chart's texels: those of a square of 2, 4 or 8 texels follow each other.
#pragma once

#include "scene/charts/charts.h"

// Places along an edge of a square.
enum { CHART_SQUARE = 8 };

// Numbers the texels of each chart by squares of CHART_SQUARE × CHART_SQUARE places of the atlas,
// row by row; in a square in Morton order. False without memory.
bool charts_order_by_squares(struct charts *charts);
