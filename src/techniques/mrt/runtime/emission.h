// Emissive surfaces as radiosity of the level's texels: each virtual point light of the frame adds
// its flux to the texel of the wall behind it. CPU only, deterministic.
#pragma once

#include "frame/frame.h"

#include "techniques/mrt/level/geometry.h"

struct mrt_emission {
    struct host *host;
    const struct mrt_block_map *map;
    const struct mrt_atlas *atlas;
    float *area_m2;   // of each texel
    vec3s *radiosity; // of each texel, lm/m²
    int texels;
    bool valid; // false: emissive surfaces have moved or changed
};

// `map` and `atlas` outlive this.
bool mrt_emission_init(struct mrt_emission *out, struct host *host, const struct mrt_block_map *map,
                       const struct mrt_atlas *atlas);
void mrt_emission_finish(struct mrt_emission *emission); // accepts zero
// Fills radiosity from the emitters of the frame.
void mrt_emission_update(struct mrt_emission *emission, const struct frame_view *view);
