// Published probes in host memory.
#pragma once

#include "techniques/common/probes/volume.h"

struct probe_copy {
    struct frame_probes grid;
    float *coefficients; // [probe][9][3]: irradiance, lux
    int visibility;      // PROBE_VISIBILITY_…
    // The data of lookup.glsl. NULL with another visibility.
    float *offsets; // [probe][4]
    float *depths;  // [probe][PROBE_DEPTH_TILE²][2]
    float *walls;   // [probe][axis][2]: covered share, place
};

// Waits for the GPU. scale: of the volume's light over lux.
bool probe_copy_create(struct host *host, struct gpu *gpu, const struct probe_volume *volume,
                       float scale, struct probe_copy *out);
void probe_copy_finish(struct host *host, struct probe_copy *copy); // accepts zero

// The C twin of probes_published_irradiance in lookup.glsl.
void probe_copy_irradiance(const struct probe_copy *copy, vec3s position, vec3s normal,
                           float out[3]);
