// The content of a bake. README.md has units and axes.
#pragma once

#include "bake/bake.h"

#include "techniques/common/light_map/tensors.h"
#include "techniques/ort/ort_map.h"
#include "techniques/ort/ort_shared.h"
#include "techniques/technique.h"

#define ORT_OFFSETS "offsets"               // I32 [offsets][2]
#define ORT_ENERGY  "energy"                // F32 [2][3], see ort_energy_ratio
#define ORT_LINKS   "links"                 // U8 [texels]: ORT_LINK_X | ORT_LINK_Y
#define ORT_NORMALS "texels/shading_normal" // F32 [texels][3], see texel_reflectance
#define ORT_MAPS    "maps"                  // F16 [texels][offsets][3], times ORT_MAP_SCALE

// The light of a texel may be averaged with that of the next one, to the right or below.
enum { ORT_LINK_X = 1, ORT_LINK_Y = 2 };

// Light that all texels get of uniform first-order light by the points of the offsets, over that
// they ought to get: rows of ORT_ENERGY, lumen. With `rows=exact` the maps have the latter.
static inline float ort_energy_ratio(const float energy[6])
{
    const float exact = energy[3] + energy[4] + energy[5];
    return exact > 0.0f ? (energy[0] + energy[1] + energy[2]) / exact : 1.0f;
}

// ---- bake/stages.c
bool ort_bake(struct bake_plan *plan, const struct technique_bake *how);
