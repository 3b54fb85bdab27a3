// The content of a bake. README.md has units and axes.
#pragma once

#include "bake/bake.h"

#include "techniques/common/light_map/tensors.h"
#include "techniques/ort/ort_map.h"
#include "techniques/ort/ort_shared.h"
#include "techniques/technique.h"

#define ORT_OFFSETS "offsets" // I32 [offsets][2]
#define ORT_MAPS    "maps"    // F16 [texels][offsets][3], times ORT_MAP_SCALE

// ---- bake/stages.c
bool ort_bake(struct bake_plan *plan, const struct technique_bake *how);
