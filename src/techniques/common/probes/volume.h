// Published probe volumes.
#pragma once

#include "core/host.h"
#include "frame/frame_shared.h"
#include "gpu/gpu.h"

#include "techniques/common/probes/depth_shared.h"

// Irradiance at the points of a grid, in the format of frame/probes.glsl. Each update fills it.
struct probe_volume {
    gpu_image image; // RGBA16F
    struct frame_probes grid;
    // Depths of the probes, RG16F, against leaks through walls; the image then has the slab that
    // common/probes/lookup.glsl needs. May be empty.
    gpu_image depth;
    bool walls; // the image has two slabs more, of the surfaces between probes
    // Coefficients of the radiance that arrives at probes, bands 0 to 4: RGBA16F, a table
    // (common/light_map/table.h) of [coefficient][probe]. May be empty.
    gpu_image radiance;
};

// PROBE_VISIBILITY_…
static inline int probe_volume_visibility(const struct probe_volume *volume)
{
    if (volume->depth.id) return PROBE_VISIBILITY_DEPTHS;
    return volume->walls ? PROBE_VISIBILITY_WALLS : PROBE_VISIBILITY_NONE;
}

// slabs: FRAME_PROBE_SLABS, one more with depths, PROBE_SLABS_WITH_WALLS with walls.
enum { PROBE_SLABS_WITH_WALLS = FRAME_PROBE_SLABS + 2 };
struct gpu_image_desc probe_volume_desc(const char *name, struct frame_probes grid, int slabs);

// The depth atlas of a grid's probes. depth: halves, [probes][PROBE_DEPTH_TILE²][2].
bool probe_depth_create(struct host *host, struct gpu *gpu, uint32_t probes, const uint16_t *depth,
                        gpu_image *out);

// Bytes of a probe's depths, and of a probe in a volume with depths.
enum {
    PROBE_DEPTH_BYTES = 4 * PROBE_DEPTH_TILE * PROBE_DEPTH_TILE,
    PROBE_VOLUME_BYTES = 8 * (FRAME_PROBE_SLABS + 1) + PROBE_DEPTH_BYTES,
};
