// Light propagation volumes (two bands, six neighbours) and higher order light propagation volumes
// (three bands, 26 neighbours): one method, two sets of defaults.
#pragma once

#include "techniques/technique.h"

extern const struct technique technique_lpv;
extern const struct technique technique_holpv;
