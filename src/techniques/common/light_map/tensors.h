// Tensors that the bakes of light maps share, and the stage that writes those of seams.
#pragma once

#include "scene/charts/seams.h"

// Fluence, F32: [texels] of the sky, [texels][columns, at least 1] of emissive surfaces.
#define LIGHT_MAP_SKY_FLUENCE      "texels/sky_fluence"
#define LIGHT_MAP_EMISSION_FLUENCE "texels/emission_fluence"

#define LIGHT_MAP_ALBEDO      "texels/reflectance" // F32 [texels][4]
#define LIGHT_MAP_SKY         "texels/sky"         // F32 [texels][4]
#define LIGHT_MAP_SKY_SHARES  "texels/sky_shares"  // U8 [texels][ENVIRONMENT_PATCHES]
#define LIGHT_MAP_EMITTED     "texels/emitted"     // F32 [texels][3][4]
#define LIGHT_MAP_EMISSION    "texels/emission"    // F32 [texels][columns, at least 1][4]
#define LIGHT_MAP_POINT       "texels/point"       // F32 [texels][4]
#define LIGHT_MAP_WALL        "texels/wall"        // U32 [texels][2], map_shared.h
#define LIGHT_MAP_SEAM_TEXEL  "seams/texel"        // U32 [places][CHART_SEAM_ENTRIES]
#define LIGHT_MAP_SEAM_WEIGHT "seams/weight"       // F32 [places][CHART_SEAM_ENTRIES]

struct bake_plan;
struct seam_closing;

// Rows of a tensor: an empty scene has one, of zeros.
static inline uint64_t light_map_rows(uint32_t count)
{
    return count > 0 ? count : 1;
}

// ---- walls_bake.c

// Lookups beside walls. closing, charts: as below. LIGHT_MAP_POINT is of wave 0.
bool light_map_add_walls(struct bake_plan *plan, const struct seam_closing *closing,
                         const struct charts *charts);

// ---- seams_bake.c

// closing: made where the bake is prepared, of these charts. Outlives the bake.
bool light_map_add_seams(struct bake_plan *plan, const struct seam_closing *closing,
                         const struct charts *charts);
