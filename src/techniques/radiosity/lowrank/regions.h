// Regions: texels that are near to each other and face one way, as many in each one. They see
// nearly the same sources, so that the rows of a region have a low rank (Sloan et al. 2003,
// "Clustered Principal Components for Precomputed Radiance Transfer", make clusters for that).
// A chart is a part of one region or has several.
#pragma once

#include "techniques/radiosity/lowrank/lowrank_shared.h"
#include "techniques/radiosity/radiosity_map.h"

static inline uint32_t radiosity_region_count(uint32_t texels)
{
    return (texels + RADIOSITY_REGION - 1) / RADIOSITY_REGION;
}

// Sources and modes of a region, at most.
uint32_t radiosity_lowrank_sources(const struct radiosity_options *options);
uint32_t radiosity_lowrank_modes(const struct radiosity_options *options);

// [texel_count] texels, region after region; all but the last have RADIOSITY_REGION. Owned by the
// caller; NULL: out of memory.
uint32_t *radiosity_regions(const struct radiosity_map *map);
