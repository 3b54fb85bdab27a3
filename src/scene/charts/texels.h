// The texels of packed charts.
#pragma once

#include "scene/charts/charts.h"

// Sets texels and owner of charts whose triangles have their places.
bool make_chart_texels(struct charts *charts);
