// Specs of small bakes for trials of light.
#pragma once

#include "techniques/trials/light_trial.h"

// The default has four times the texels.
#define RADIOSITY "radiosity:texels=16384"
#define ORT       "ort:texels=4096,offsets=400,coordinates=charts"
#define ORT_FINE  "ort:texels=8192,offsets=400,coordinates=charts"
#define PRT       "prt:texels=16384,rays=256"
// Both have one dictionary.
#define DICTIONARY(texels) TRIAL_DICTIONARY(texels, 16, 12)
#define MRT                "mrt" DICTIONARY(8)
#define DRT                "drt" DICTIONARY(8)
