// Patches: groups of texels that are near to each other, face alike, and see each other. Light that
// has bounced more than once is smooth: it is computed between patches.
#pragma once

#include "techniques/ort/ort_map.h"

struct trace_scene;

// [texel_count] the patch of each texel, below ort_patch_count(texel_count): by halving along the
// longest axis of positions and normals, then in two where a wall stands on it. Deterministic.
// NULL: no memory; freed by host_free.
uint32_t *ort_make_patches(const struct ort_map *map, const struct trace_scene *trace);
