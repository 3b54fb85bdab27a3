// State of a bake, shared by bake.c and renderer/bakes.c.
#pragma once

#include "api/objects.h"

#include "bake/bake.h"
#include "lightmap/update/update.h"
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
    // The identity of a light map.
    int lightmap_version;
    uint64_t seed;
    bool updates; // an earlier light map
    struct lightmap_change change;
};

// The version of the library, as bake files state it.
const char *api_program(void);

// lightmap_update.c. Adds the stages of an update of the light map in a folder, at its density.
// options: of the bake's identity.
bool api_update_add_stages(struct ag_bake *b, struct bake_plan *plan, const char *folder,
                           const char *options);
// The record of a complete bake's light, for later updates.
bool api_update_record(const struct ag_bake *b, const struct charts *charts,
                       struct lightmap_record *out);
