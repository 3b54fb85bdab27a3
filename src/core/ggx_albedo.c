// Table of the directional albedo of the GGX lobe.
#include "core/ggx_albedo.h"

const uint32_t ggx_albedo_table[GGX_ALBEDO_SIZE * GGX_ALBEDO_SIZE] = {
#include "core/ggx_albedo.inc"
};
