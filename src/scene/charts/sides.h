// Backs of packed charts, and the charts' triangles by those of the scene.
#pragma once

#include "scene/charts/charts.h"

// The charts must have their texels.
bool make_chart_sides(struct charts *charts, const struct scene *scene);
