// Voxel cone tracing: surfaces as lit voxels, gathered along cones (README.md).
#pragma once

#include "techniques/technique.h"

extern const struct technique technique_vct;
