// Radiance that receivers send, after a bake's earlier waves.
#pragma once

#include "techniques/prt/bake/scene.h"

struct prt_sent {
    const struct prt_scene *scene;
    size_t receivers, coefficients;
    const float *albedo, *emitted, *emitted_bounces;
    const uint16_t *direct, *bounce;
    uint32_t *nearest_valid; // [receivers] hidden ones send its light
};

// For a bake with bounces. False: a tensor is missing, or no memory. prt_sent_finish accepts zero.
bool prt_sent_init(struct prt_sent *out, const struct bake_task *task);
void prt_sent_finish(struct prt_sent *sent);

// The receiver that a ray meets, by `choice` in [0, 1) (prt_receiver_at); CHART_NONE: none that
// sends light.
uint32_t prt_sent_receiver(const struct prt_scene *scene, const struct ray_hit *hit,
                           const struct texel_hit *at_hit, float choice);
// For each coefficient of distant light the radiance that a receiver sends by colour, after one 0:
// [coefficients][4].
void prt_sent_radiance(const struct prt_sent *sent, uint32_t receiver, float *out);
// Radiance of the light of emissive surfaces that a receiver sends on, cd/m².
vec3s prt_sent_emission(const struct prt_sent *sent, uint32_t receiver);
