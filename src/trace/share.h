// Paths shared by receivers close to each other (Bekaert, Sbert & Halton 2002, "Accelerating Path
// Tracing by Re-Using Paths"): each takes light from the ends of the first steps of all.
//
// The first steps of the receivers are one sample each of several strategies. They are combined by
// the balance heuristic, whose densities have the visibility between receiver and end, so that the
// estimates are without bias. The end reflects to each receiver by its diffuse lobe; other lobes,
// whose directions were sampled for one receiver, light that one alone.
#pragma once

#include "trace/path.h"

enum { PATH_SHARE = 16 };
// Adds to irradiance[0 … count) (lux) the light of a path that began at receivers[own], by the
// share of each receiver. receivers: white diffuse surfaces, at most PATH_SHARE.
void path_share(const struct path_settings *settings, const struct path_start *const *receivers,
                int count, int own, const struct path_end *end, vec3s *irradiance, uint64_t *rays);
