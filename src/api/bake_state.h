// State of a bake, shared by bake.c and renderer_bakes.c.
#pragma once

#include "api/objects.h"

#include "bake/bake.h"
#include "techniques/gi.h"

struct ag_bake {
    struct ag_context *context;
    struct ag_scene *scene;
    struct gi_spec spec;
    int term;             // of the spec
    int lightmap_samples; // 0: the data of the technique
    float lightmap_noise; // bound; 0: none
    struct scene_pose pose;
    struct technique_bake how; // refers to spec and pose
    struct bake *bake;
    struct bake_run_options options;
    char *checkpoint;
    struct report *report;
};

// The version of the library, as bake files state it.
const char *api_program(void);
