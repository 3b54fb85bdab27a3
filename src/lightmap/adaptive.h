// The stages of a light map by paths until the noise of each chart is at a bound.
#pragma once

#include "lightmap/stages.h"

bool adaptive_add_stages(struct bake_plan *plan, const struct lightmap_job *job);
