// Light propagation volumes of two bands and six neighbours, and of higher order: three bands and
// 26 neighbours. One method, two sets of defaults.
#pragma once

#include "techniques/technique.h"

extern const struct technique technique_lpv;
extern const struct technique technique_holpv;
