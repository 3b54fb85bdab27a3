// Voxel cone tracing: surfaces as lit voxels, gathered along cones; and ambient occlusion by the
// same cones (README.md).
#pragma once

#include "techniques/technique.h"

extern const struct technique technique_vct, technique_vctao;
