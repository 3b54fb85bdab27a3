// A trial of the light of a scene against the reference, for several techniques.
#pragma once

#include "techniques/trials/light_trial.h"

struct share_case {
    const char *gi;
    double least;
};

// Mean irradiance over that of the reference: at least the case's, at most `most`. Prints both.
void share_trial(struct gpu *gpu, trial_build build, const char *name, int bounces,
                 const struct share_case *cases, size_t count, double most);
