// Visibility of probes from the places of a block past its clutter, for lookups between probes.
//
// A grid of voxels over the cell. A voxel has a bit for each of the eight probes around it, that of
// the corner x + 2 y + 4 z: all of the voxel sees the probe. Its part in a solid does not count.
// If no probe is visible, the light of all eight is scaled by the share of directions without
// clutter, in 1/255: it is 0 in a closed object.
#pragma once

#include "techniques/mrt/clutter/delta.h"

enum {
    MRT_SIGHT_VOXELS = 16,
    // Bits of a voxel; shaders have their own (mrt_shared.h).
    MRT_VOXEL_PROBES = 0xff,
    MRT_VOXEL_OPEN = 8, // from this bit on
    MRT_VOXEL_SOLID = 1 << 16,
};

// Voxels along an edge, at least MRT_SIGHT_VOXELS: the probes around all points of one are the
// same.
static inline int mrt_sight_edge(int p)
{
    return 2 * p * ((MRT_SIGHT_VOXELS + 2 * p - 1) / (2 * p));
}

// mrt_sight_edge³ voxels, x fastest. The same bits for any number of threads.
void mrt_probe_sight(const struct mrt_clutter_cell *cell, uint32_t *voxels);
