#include "cli/view/cheap_bakes.h"

#include <stddef.h>
#include <string.h>

#define LEVEL                                                                                      \
    "texels=4,rays=256,prior_modes=8,modes=4,enrich=false,block_probes=1,"                         \
    "lightfield_positions=4,lightfield_directions=6,lightfield_supersampling=1,"                   \
    "lightfield_modes=16,lightfield_rounds=0,response_modes=4"

static const char *const bakes[][2] = {
    { "mrt", LEVEL },
    { "drt", LEVEL ",delta_rays=64" },
    { "radiosity", "texels=2048,rays=16,sources=8" },
    { "ort", "texels=64,rays=16,offsets=50,local=1" },
    { "prt", "texels=64,rays=16,bounces=1" },
    { "dnrt", "rays=16,keys=1" },
};

const char *cheap_bake(const char *technique)
{
    for (size_t i = 0; i < sizeof bakes / sizeof *bakes; i++)
        if (strcmp(bakes[i][0], technique) == 0) return bakes[i][1];
    return NULL;
}
