// Charts that fit in one texel.
#pragma once

#include "scene/charts/grow.h"

// Makes single-texel charts of them, and one of those that are within a texel's length, have
// similar normals and are visible from each other. across: also of charts of different instances,
// of which all or none are double-sided.
bool join_small_charts(struct grown *grown, const struct surface *surface, double texels_per_m,
                       bool across);
