// State of a bake, shared by bake.c, reference_bake.c, renderer/bakes.c and light maps.
#pragma once

#include "api/objects.h"

#include "bake/bake.h"
#include "lightmap/update/update.h"
#include "reference/stages.h"
#include "techniques/gi.h"

struct ag_bake {
    struct ag_context *context;
    struct ag_scene *scene;
    struct gi_spec spec;          // empty: of a reference
    int term;                     // of the spec
    int lightmap_samples;         // 0: the data of the technique
    float lightmap_noise;         // bound; 0: none
    struct reference_bake traced; // of a reference: its samples are not 0
    struct scene_pose pose;
    struct technique_bake how; // refers to spec and pose
    struct bake *bake;
    struct bake_run_options options;
    char *checkpoint;
    struct report *report;
    // The identity of a light map.
    int lightmap_version;
    uint64_t seed;
    const struct charts *charts; // of a light map; the bake owns them
    bool updates;                // an earlier light map
    struct lightmap_change change;
};

static inline bool api_bake_is_reference(const struct ag_bake *b)
{
    return b->traced.samples > 0;
}

// Checks of ag_bake_create and ag_bake_create_reference.
enum ag_result api_bake_check(const char *function, const struct ag_scene *scene,
                              const struct ag_bake_desc *desc);
struct bake_run_options api_bake_run_options(const struct ag_bake_desc *desc);

// The version of the library, as bake files state it.
const char *api_program(void);

// lightmap_update.c. Adds the stages of an update of the light map in a folder, at its density.
// options: of the bake's identity.
bool api_update_add_stages(struct ag_bake *b, struct bake_plan *plan, const char *folder,
                           const char *options);
// The record of a complete bake's light, for later updates.
bool api_update_record(const struct ag_bake *b, const struct charts *charts,
                       struct lightmap_record *out);
