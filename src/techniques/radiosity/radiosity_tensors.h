// The content of a bake: sparse form factors of texels and of clusters, and the light of the sky
// and of emissive surfaces. README.md has units and axes.
#pragma once

#include "bake/bake.h"

#include "techniques/common/light_map/tensors.h"
#include "techniques/radiosity/radiosity_map.h"
#include "techniques/technique.h"

#define RADIOSITY_BLOCK_START    "blocks/start"    // U8 [texels] 1: the first texel of a block
#define RADIOSITY_BLOCK_SOURCE   "blocks/source"   // U32 [texels][sources]: node, stratum
#define RADIOSITY_BLOCK_SHARE    "blocks/share"    // F16 [texels][sources]
#define RADIOSITY_FACTOR         "texels/factor"   // F16 [texels][sources][3]
#define RADIOSITY_NEARNESS       "texels/nearness" // F32 [texels][4]
#define RADIOSITY_SURFACE        "texels/surface"  // F32 [texels][10]: struct texel_factors
#define RADIOSITY_PART           "texels/part"     // U8 [texels]
#define RADIOSITY_CLUSTER_SOURCE "clusters/source" // U32 [clusters][2 · sources]
#define RADIOSITY_CLUSTER_FACTOR "clusters/factor" // F16 [clusters][2 · sources]
#define RADIOSITY_PROBE_SOURCE   "probes/source"   // U32 [probes][2 · sources]
#define RADIOSITY_PROBE_FACTOR   "probes/factor"   // F16 [probes][2 · sources][4]
#define RADIOSITY_PROBE_PLACE    "probes/place"    // F32 [probes][4]
#define RADIOSITY_PROBE_SKY      "probes/sky"      // F32 [probes][9]
#define RADIOSITY_PROBE_EMISSION "probes/emission" // F32 [probes][columns, at least 1][9]
#define RADIOSITY_PROBE_DEPTH    "probes/depth"    // F16 [probes][9 · 9][2]

// Rows allocated before clusters are subdivided: two for each, since walls may split it.
static inline uint64_t radiosity_cluster_rows(const struct radiosity_map *map)
{
    return light_map_rows(2 * map->cluster_count);
}

// ---- bake/stages.c
bool radiosity_bake(struct bake_plan *plan, const struct technique_bake *how);
