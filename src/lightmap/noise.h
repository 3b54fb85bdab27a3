// Noise of light-map texels whose paths are counted by chart, and the paths that they need.
//
// The paths of a texel are in NOISE_GROUPS groups, each with a Sobol sequence of its own: their
// means are independent, so that these give the variance of the texel. The noise of a unit of
// texels is the root of the mean variance over the mean light, both of luminance.
#pragma once

#include "scene/charts/charts.h"

enum { NOISE_GROUPS = 8 };

// Texels that share paths at most: an aligned block of texels of one side of a chart, a tile. Their
// noise has much in common, so that a tile counts as one estimate of NOISE_GROUPS − 1 degrees of
// freedom.
enum { NOISE_TILE = 16 };

// Sums over the paths of a texel.
struct noise_sums {
    float light[3];            // lux
    float paths;               // 0: all of the texel is inside geometry
    float group[NOISE_GROUPS]; // luminance
};

// Texels that have one number of paths: a side of a chart, or of several small charts of an
// instance in a row, whose few tiles would give no estimate.
struct noise_unit {
    uint32_t first, count; // of the texels of both sides
    uint32_t tiles;
};
struct noise_units {
    struct noise_unit *at;
    uint32_t count;
};
// noise_units_finish accepts zero.
bool noise_units_init(struct noise_units *out, const struct charts *charts);
void noise_units_finish(struct noise_units *units, struct host *host);
// The unit of a texel.
uint32_t noise_unit_of(const struct noise_units *units, uint32_t texel);

// The variance of the mean of a texel's paths, of luminance, lux².
double noise_variance(const struct noise_sums *sums);
struct noise_state {
    float noise; // 0…; of the unit's mean light, or of the least light
    float paths; // per texel, so far
};
// least: luminance, lux, in place of the unit's mean where that is darker.
struct noise_state noise_of(const struct noise_unit *unit, const struct noise_sums *sums,
                            float least);
// The relative variance of one path: the median over units, as the prior of each. scratch: [units].
float noise_typical(const struct noise_units *units, const struct noise_sums *sums, float least,
                    float *scratch);
// The noise with that prior, which weighs as one degree of freedom: few paths of few tiles may all
// have missed the light, and would state no noise.
struct noise_state noise_with_prior(const struct noise_unit *unit, struct noise_state state,
                                    float typical);
// Mean luminance of all texels, lux.
float noise_mean_light(const struct noise_units *units, const struct noise_sums *sums);
// Paths per texel that lower the noise to `bound`, a multiple of NOISE_GROUPS, from `state.paths`
// to `most`: variance falls with their number.
uint32_t noise_paths_for(struct noise_state state, float bound, uint32_t most);
