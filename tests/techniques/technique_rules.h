// Rules for each entry of the registry.
#pragma once

#include "techniques/registry.h"

const struct technique *technique_find(const char *name); // NULL: unknown
// The required members are set and the name is [a-z0-9]+.
bool technique_is_sound(const struct technique *technique);

// A spec without a history: vct accumulates over frames, else each frame is the same.
const char *technique_of_one_frame(const struct technique *technique);
// A spec that adds lights up. The positive closures of lpv and holpv, the filter by variance of vct
// and the bright texels of mrt and drt are homogeneous in light, but lights do not add up.
const char *technique_additive(const struct technique *technique);
