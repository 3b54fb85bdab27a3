// Light propagation volumes without the geometry volume.
#pragma once

#include "techniques/technique.h"

extern const struct technique technique_lpv;
