// A bounce by samples of the receivers that send most light, beside the rays of each receiver: rays
// alone find a small bright patch by chance, and walls around it would be mottled. Receiver i gets
// from receiver j the share
//
//     F_ij = cos θ_i cos θ_j A_j / (π r²)
//
// of its radiosity where it sees it. N rays meet j with this probability, K samples choose it with
// the probability p_j of its power; both are weighted by the balance heuristic (Veach 1997, section
// 9.2), so that each has the weight F_ij / (N F_ij + K p_j).
#pragma once

#include "techniques/prt/bake/scene.h"

struct prt_samples {
    const struct prt_scene *scene;
    struct host *host;
    const float *point; // LIGHT_MAP_POINT
    const vec4s *sent;  // [receivers] radiosity
    float *probability; // [receivers] p_j, K times; 0: none chooses it
    double *below;      // [receivers + 1] sum of those before
    int count;          // K
};

// Texels of a light map alone: vertices have no area. point, sent: stay where they are until
// prt_samples_finish, which accepts zero. False: no memory. Without light no receiver is chosen.
bool prt_samples_init(struct prt_samples *out, const struct bake_task *task, const float *point,
                      const vec4s *sent);
void prt_samples_finish(struct prt_samples *samples);
// Samples of a receiver for its number of rays.
int prt_sample_count(const struct prt_options *options);
enum { PRT_SAMPLES_BYTES = 12 }; // of memory for each receiver
// The irradiance of receiver i, lux. hits: what its rays meet, CHART_NONE after the last.
vec4s prt_samples_gather(const struct prt_samples *samples, uint32_t i, const uint32_t *hits);
