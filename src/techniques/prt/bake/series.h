// Bounces as a Neumann series (Sloan, Kautz & Snyder 2002; Hong 2015, section 2.5.1.2). Of
// irradiance T_0 surfaces of reflectance ρ send the radiance ρ T_0 / π, and
//
//     T_{b+1}(x) = ∫ (1 − V(ω)) ρ(y)/π T_b(y) (n·ω)₊ dω,
//
// where y is the receiver that the ray of x along ω meets. Rays of density (n·ω)/π make it the mean
// of ρ T_b over them, 0 where they meet the sky.
#pragma once

#include "techniques/prt/bake/scene.h"

struct prt_series {
    const struct prt_scene *scene;
    struct host *host;
    uint32_t texels;
    const float *albedo, *point; // of the first stage
    const uint32_t *hits;
    uint32_t *nearest_valid; // [texels] hidden ones send its light
    vec4s *term;             // [texels] by colour: at first T_0, then of the newest bounce
    vec4s *sent;             // [texels] reflected of it
    vec4s *sum;              // [texels] of all bounces
};

// False: a tensor is missing, or no memory. prt_series_finish accepts zero.
bool prt_series_init(struct prt_series *out, const struct bake_task *task);
void prt_series_finish(struct prt_series *series);
// From `term` to `sum`, until the largest value of a bounce is below `least`. sampled: the first
// bounce by samples too (samples.h), for light that may come from a small patch. False: cancelled,
// or no memory.
bool prt_series_sum(struct prt_series *series, const struct bake_task *task, float least,
                    bool sampled);
// Additions for each ray and bounce, in rays that take as long, measured.
#define PRT_SERIES_COST (1.0 / 250)
enum { PRT_SERIES_BYTES = 64 }; // of memory for each texel
