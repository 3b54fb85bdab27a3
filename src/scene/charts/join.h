// Charts that fit in one texel.
#pragma once

#include "scene/charts/grow.h"

// Makes each of them a spot, and one chart of spots that are within a texel's length, face one way
// and see each other. across: also of spots of different instances, of which all or none are
// double-sided.
bool join_spots(struct grown *grown, const struct surface *surface, double texels_per_m,
                bool across);
