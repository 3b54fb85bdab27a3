// Light that reaches a probe, by rays: form factors of the clusters, the sky, emissive surfaces,
// and how far it sees.
#pragma once

#include "techniques/common/probes/rays.h"
#include "techniques/radiosity/bake/row.h"
#include "techniques/radiosity/probes/grid.h"

enum { RADIOSITY_SH = 9 };

struct radiosity_probe {
    vec3s position;                 // moved out of geometry, within its cell
    float valid;                    // 1; 0: all of the cell is inside of something
    float sky[RADIOSITY_SH];        // irradiance of a sky of radiance 1, Σ c_i Y_i
    float emitted[RADIOSITY_SH][3]; // of emissive surfaces, lux
    uint16_t depth[PROBE_DEPTHS][2];
};

// Rays are in equal squares of the octahedral map, each with its solid angle: `gather` has the
// share of the sphere in which a cluster is seen, and its directions.
void radiosity_probe_gather(const struct radiosity_scene *scene, struct frame_probes grid,
                            uint32_t probe, uint64_t seed, struct radiosity_gather *gather,
                            struct radiosity_probe *out);
